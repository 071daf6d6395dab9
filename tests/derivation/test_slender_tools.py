"""Tools a fifth of a millimetre beside the last axis: what follows from that lever has lost digits."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.support.solving import import_text

from ikgen.derivation.derive import derive
from ikgen.emit.cpp.cpp_emitter import emit_header
from ikgen.emit.python.python_emitter import emit_module
from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

_SLENDER = (
    ("0 0 0.1", "0 0 0"),
    ("0.03 0 0", "1.5707963267948966 0 0"),
    ("0.116 0 0", "0 0 0"),
    ("0.135 0 0", "0 0 0"),
    ("0 0 0", "1.5707963267948966 0 0"),
    ("0.0079 0.000218121 -0.1592274", "0 0 0"),
)
_BENT = (
    ("0 0 0.0975", "0 0 0"),
    ("0 0 0", "1.5707963267948966 0 0"),
    ("0.120520423580404 0 0", "0 0 0"),
    ("0.162 0 0", "0 0 0"),
    ("0 0 0", "1.5707963267948966 0 0"),
    ("0 -0.0016 0.12063", "0 -1.5707963267948966 0"),
)


_POINTING = (
    ("0 0 0.115", "0 0 0"),
    ("0.033 0 0", "1.5707963267948966 0 0"),
    ("0.155 0 0", "0 0 0"),
    ("0.135 0 0", "0 0 0"),
    ("0 0 0", "1.5707963267948966 0 0"),
)
_ALONG = "0 -1.5707963267948966 3.141592653589793"
"""Turn of a tool whose z axis is along its own offset: axis 1's angle is a root of a square then."""

_ROUNDINGS = ("0 -1.570795 3.14159", "0 -1.5708 3.1416", "0 -1.57 3.14")


def _robot(frames: tuple[tuple[str, str], ...]) -> str:
    """An arm of revolute joints about z of the frames, the last of which is the tool's."""
    parts = ['<robot name="slender"><link name="link0"/>']
    for i, (xyz, rpy) in enumerate(frames, 1):
        kind = "fixed" if i == len(frames) else "revolute"
        parts += [
            f'<link name="link{i}"/><joint name="joint{i}" type="{kind}">',
            f'<parent link="link{i - 1}"/><child link="link{i}"/><origin xyz="{xyz}" rpy="{rpy}"/>',
            '<axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>',
        ]
    return "\n".join([*parts, "</robot>"])


def _solver(frames: tuple[tuple[str, str], ...], folder: Path, task: str | None = None) -> Any:
    robot = folder / "slender.urdf"
    robot.write_text(_robot(frames))
    module = derive(Request(robot, task=task)).module
    assert module.reads.name.startswith("position-direction")
    return import_text(emit_module(module), folder)


@pytest.mark.parametrize("decade", [4, 5, 6, 8, 10])
def test_poses_beside_a_stretched_elbow_have_all_digits(decade: int, tmp_path: Path) -> None:
    """But for what the root of a pose's round-off turns a stretched elbow by."""
    arm = _solver(_SLENDER, tmp_path)
    q = np.random.default_rng(decade).uniform(-1.5, 1.5, (25, 5))
    q[:, 2] = 10.0**-decade
    for row, found in zip(q, arm.solve_batch(arm.forward(q), limits=False)[0], strict=True):
        gap = np.abs(np.remainder(found - row + np.pi, 2 * np.pi) - np.pi).max(axis=1)
        assert np.nanmin(gap, initial=np.inf) < 1e-5


def test_poses_whose_continua_no_branch_comes_near_have_rows(tmp_path: Path) -> None:
    arm = _solver(_BENT, tmp_path)
    rng = np.random.default_rng(2)
    q = rng.uniform(-3.0, 3.0, (40, 5))
    q[:, 4] = -0.5 * np.pi + 10.0 ** rng.uniform(-9.0, -6.0, 40)
    assert (arm.solve_batch(arm.forward(q), limits=False)[1] > 0).all()


def _pointing(rpy: str, offset: float = 0.0027) -> tuple[tuple[str, str], ...]:
    return (*_POINTING, (f"{-offset} 0 0.13", rpy))


@pytest.mark.parametrize(
    ("rpy", "offset"),
    [
        *((rpy, 0.0027) for rpy in _ROUNDINGS),
        pytest.param("0 -1.57 3.14", 0.08, marks=pytest.mark.long),
    ],
)
def test_roots_that_rounding_alone_parts_lose_no_pose(
    rpy: str, offset: float, tmp_path: Path
) -> None:
    """Those of axis 1, which are nearly double ones: not taken, or known to have few digits in places."""
    arm = _solver(_pointing(rpy, offset), tmp_path, "position-direction")
    q = np.random.default_rng(4).uniform(-3.0, 3.0, (1500 if offset > 0.01 else 60, 5))
    rows, count, _ = arm.solve_batch(arm.forward(q), limits=False)
    gaps = np.abs(np.remainder(rows - q[:, None] + np.pi, 2 * np.pi) - np.pi).max(axis=2)
    assert (count > 0).all() and np.nanmax(np.nanmin(gaps, axis=1)) < 1e-5


def test_rounded_tools_are_solved_as_exact_ones(tmp_path: Path) -> None:
    robot = tmp_path / "pointing.urdf"
    solved = []
    for rpy in (_ALONG, *_ROUNDINGS):
        robot.write_text(_robot(_pointing(rpy)))
        derivation = derive(Request(robot, task="position-direction"))
        assert not derivation.module.rounded and derivation.graph.sound
        steps = derivation.graph.steps
        solved.append([(step.candidate.unknown, step.branches) for step in steps])
    assert solved[1:] == solved[:1] * len(_ROUNDINGS)


def test_its_rows_take_newton_steps_all_at_once(tmp_path: Path) -> None:
    """In the header; those of the same arm without the lever are right as they are."""
    robot = tmp_path / "slender.urdf"
    straight = tuple((xyz.replace("0.0079 0.000218121", "0 0"), rpy) for xyz, rpy in _SLENDER)
    assert straight != _SLENDER
    for frames, coarse in ((_SLENDER, True), (straight, False)):
        robot.write_text(_robot(frames))
        module = derive(Request(robot)).module
        assert not module.rounded and module.program.coarse == coarse
        assert f"kNewton = {str(coarse).lower()};" in emit_header(module)
