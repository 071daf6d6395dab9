"""Joints that move and carry other arms of the robot too."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

from ikgen.derivation.closed_forms import _shared
from ikgen.derivation.read import read
from ikgen.records.request import Request

SIDES = ("left", "right")


def joint(name: str, parent: str, child: str, axis: str = "0 0 1") -> str:
    return (
        f'<joint name="{name}" type="revolute"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="0.1 0 0.2"/><axis xyz="{axis}"/><limit lower="-2" upper="2" effort="1" '
        f'velocity="1"/></joint><link name="{child}"/>'
    )


def robot(folder: Path) -> Path:
    """A torso of two joints with two arms of three."""
    parts = [joint("yaw", "base", "waist"), joint("pitch", "waist", "chest", "0 1 0")]
    for side in SIDES:
        links = ["chest", *(f"{side}_{k}" for k in range(1, 4))]
        for k, axis in enumerate(("0 1 0", "1 0 0", "0 1 0")):
            parts.append(joint(f"{side}_joint_{k + 1}", links[k], links[k + 1], axis))
    path = folder / "torso.urdf"
    path.write_text(f'<robot name="torso"><link name="base"/>{"".join(parts)}</robot>')
    return path


def test_those_of_a_torso_are_told_but_where_they_are_held(tmp_path: Path) -> None:
    reading = read(Request(robot(tmp_path), base="base", tip="left_3"))
    held: Any = SimpleNamespace(held=())
    assert _shared(reading, held) == ("yaw", "pitch")
    held.held = ("yaw", "left_joint_2")
    assert _shared(reading, held) == ("pitch",)


def test_an_arm_alone_has_none(tmp_path: Path) -> None:
    reading = read(Request(robot(tmp_path), base="chest", tip="left_3"))
    held: Any = SimpleNamespace(held=())
    assert _shared(reading, held) == ()
