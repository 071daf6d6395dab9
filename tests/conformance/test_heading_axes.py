"""SCARA arms whose tool's x axis is vertical are solved for the heading of another, in both languages."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.sampled import in_languages
from tests.support.solving import import_text

from ikgen.generation.generate import generate
from ikgen.records.request import Outputs, Request

pytestmark = pytest.mark.usefixtures("solved_once")

JOINTS = (
    ("0 0 0.3", "revolute", 2.5),
    ("0.3 0 0", "revolute", 2.5),
    ("0.25 0 0", "prismatic", 0.1),
)


def scara(folder: Path, rpy: str) -> Path:
    text = '<robot name="scara"><link name="l0"/>'
    for i, (xyz, kind, half) in enumerate([*JOINTS, ("0 0 0", "revolute", 3.0)], 1):
        text += (
            f'<link name="l{i}"/><joint name="j{i}" type="{kind}"><parent link="l{i - 1}"/>'
            f'<child link="l{i}"/><origin xyz="{xyz}"/><axis xyz="0 0 1"/>'
            f'<limit lower="{-half}" upper="{half}"/></joint>'
        )
    text += '<link name="tool0"/><joint name="tool" type="fixed"><parent link="l4"/><child link="tool0"/>'
    path = folder / "scara.urdf"
    path.write_text(f'{text}<origin xyz="0.02 0 -0.1" rpy="{rpy}"/></joint></robot>')
    return path


TOOLS = {
    "y": ("0 1.5707963267948966 0", None, "y"),
    "z is asked for": ("0 1.5707963267948966 0", "z", "z"),
    "y, rounded": ("0 1.57079 0", None, "y"),
    "x": ("0 0 0", None, "x"),
}
"""How the tool is turned; the axis that is asked for, and the one that is taken."""


@pytest.mark.parametrize(("tool", "language"), in_languages(TOOLS, []))
def test_the_heading_of_a_level_axis(tmp_path: Path, tool: str, language: str) -> None:
    rpy, asked, axis = TOOLS[tool]
    request = Request(scara(tmp_path, rpy), tool_axis=asked)
    emit = dict.fromkeys(("python", language))
    made = generate(request, Outputs(tuple(emit), tmp_path / "out", samples=300))
    assert all(made.reports[name].passed for name in emit)
    task = made.derivation.task
    assert (task.stem, task.axis) == ("position-yaw", axis)
    arm = import_text((tmp_path / "out" / "scara_ik.py").read_text(), tmp_path)
    assert arm.TASK == "position-yaw" and axis == arm.TOOL_AXIS
    pose = arm.forward([0.4, -0.7, 0.05, 1.1])
    column = "xyz".index(axis)
    for row in arm.solve(pose).q:
        there = arm.forward(row)
        np.testing.assert_allclose(there[:2, column], pose[:2, column], atol=1e-9)
        np.testing.assert_allclose(there[:3, 3], pose[:3, 3], atol=1e-9)
