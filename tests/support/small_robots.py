"""Robots whose solvers are derived in a second: three revolute joints an arm, for the task `position`."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

__all__ = ["elbow_robot", "write_robot"]

_JOINTS = (("waist", "0 0 1", 0.2), ("shoulder", "0 1 0", 0.1), ("elbow", "0 1 0", 0.35))


def _joint(name: str, kind: str, parent: str, child: str, xyz: str, axis: str = "0 0 1") -> str:
    limit = '<limit lower="-2.5" upper="2.5" effort="1" velocity="1"/>' if kind != "fixed" else ""
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{xyz}" rpy="0 0 0"/><axis xyz="{axis}"/>{limit}</joint>\n'
        f'<link name="{child}"/>\n'
    )


def elbow_robot(name: str = "elbow", sides: Sequence[str] = ("",), reach: float = 0.3) -> str:
    """URDF of a robot with an arm a side: joints `<side>waist`, `<side>shoulder`, `<side>elbow`, tip
    `<side>tool0` `reach` (m) beyond the elbow, all on the link `base_link`."""
    text = '<link name="base_link"/>\n'
    for i, side in enumerate(sides):
        parent = "base_link"
        for joint, axis, height in _JOINTS:
            child = f"{side}{joint}_link"
            y = 0.4 * i if parent == "base_link" else 0.0
            text += _joint(f"{side}{joint}", "revolute", parent, child, f"0 {y} {height}", axis)
            parent = child
        text += _joint(f"{side}flange", "fixed", parent, f"{side}tool0", f"{reach} 0 0")
    return f'<robot name="{name}">\n{text}</robot>\n'


def write_robot(path: Path, *, sides: Sequence[str] = ("",), reach: float = 0.3) -> Path:
    """`elbow_robot` in a file of its name."""
    path.write_text(elbow_robot(path.stem, sides, reach))
    return path
