"""Robots whose solvers are derived in a second: two or three revolute joints an arm."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

__all__ = ["PLANAR", "elbow_robot", "write_robot"]

PLANAR = """
<robot name="planar">
  <link name="base"/><link name="upper"/><link name="lower"/><link name="tip"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/>
    <axis xyz="0 0 1"/><limit lower="-2.5" upper="2.5" effort="1" velocity="1"/></joint>
  <joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/>
    <origin xyz="0.4 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-2.8" upper="2.8" effort="1" velocity="1"/></joint>
  <joint name="flange" type="fixed"><parent link="lower"/><child link="tip"/>
    <origin xyz="0.3 0 0"/></joint>
</robot>
"""
"""An arm of two joints in the plane."""

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
