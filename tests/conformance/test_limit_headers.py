"""Headers beside singularities on a limit: the pose does not tell their rows from such outside."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from benchmarks.agreement import arm_of, runner_of
from tests.support.sampled import sampled
from tests.support.solving import FIXTURES, NO_COMPILER

from ikgen.derivation.derive import derive
from ikgen.emit.derivation import Derivation
from ikgen.emit.solver_module import CLOSE
from ikgen.records.request import Request

JOINT = 3

_WRIST = (
    ("0 0 0.3", "0 0 0"),
    ("0.05 0 0", "1.570796327 0 0"),
    ("0.4 0 0", "0 0 0"),
    ("0 -0.35 0", "1.570796327 0 0"),
    ("2e-10 0 0", "-1.570796327 0 0"),
    ("0 0 0", "1.570796327 0 0"),
)
_RIGHT = "1.5707963267948966 0 0"
_SRS = (
    ("0 0 0.34", "0 0 0"),
    ("0 0 0", f"-{_RIGHT}"),
    ("0 -0.4 0", _RIGHT),
    ("0 0 0", _RIGHT),
    ("0 0.4 0", f"-{_RIGHT}"),
    ("0 0 0", f"-{_RIGHT}"),
    ("0 -0.126 0", _RIGHT),
)


def urdf_of(axes: tuple[tuple[str, str], ...]) -> str:
    """Of joints about z, each at its origin in the link before."""
    joints = (
        f'<link name="link{i}"/><joint name="joint{i}" type="revolute">'
        f'<parent link="link{i - 1}"/><child link="link{i}"/><origin xyz="{xyz}" rpy="{rpy}"/>'
        '<axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>'
        for i, (xyz, rpy) in enumerate(axes, 1)
    )
    return "\n".join(['<robot name="nine"><link name="link0"/>', *joints, "</robot>"])


WRIST = urdf_of(_WRIST)
"""Right angles in nine digits, and a wrist whose axes meet to as many."""

LEG = """<robot name="leg"><link name="base"/><link name="hip"/><link name="thigh"/><link name="toe"/>
<joint name="1" type="revolute"><parent link="base"/><child link="hip"/>
  <axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
<joint name="2" type="revolute"><parent link="hip"/><child link="thigh"/><origin xyz="0.05 0.014 0"/>
  <axis xyz="0 1 0"/><limit lower="0" upper="1.57" effort="1" velocity="1"/></joint>
<joint name="3" type="revolute"><parent link="thigh"/><child link="toe"/><origin xyz="0 0.04 -0.16"/>
  <axis xyz="0 1 0"/><limit lower="-2.7" upper="0" effort="1" velocity="1"/></joint>
<link name="end"/>
<joint name="foot" type="fixed"><parent link="toe"/><child link="end"/><origin xyz="0 0 -0.17"/></joint>
</robot>"""
"""One of its knee's limits is where it is straight."""

pytestmark = [
    pytest.mark.usefixtures("solved_once"),
    pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or ""),
]


@pytest.mark.long
@pytest.mark.parametrize(("name", "side"), [("kuka_kr6r900sixx", 1.0), ("doosan_m1013", -1.0)])
def test_configurations_on_a_limit_beside_a_singularity_are_found(
    name: str, side: float, tmp_path: Path
) -> None:
    derivation = derive(Request(FIXTURES / f"{name}.urdf"))
    found_on_limit(derivation, side, (5.0, 7.5), 1e-3, tmp_path)


@pytest.mark.parametrize("side", sampled([1.0, -1.0], [1.0]))
def test_configurations_on_a_limit_of_an_arm_that_is_off_by_little_are_found(
    side: float, tmp_path: Path
) -> None:
    # rows are right to 1e-9 without Newton steps; joints are off by that over the smallest singular value
    robot = tmp_path / "nine.urdf"
    robot.write_text(WRIST)
    derivation = derive(Request(robot))
    assert 1e-11 < max(derivation.module.dh.deviation) < CLOSE
    found_on_limit(derivation, side, (1.0, 3.0), 1e-6, tmp_path)


@pytest.mark.long
def test_configurations_on_a_limit_beside_a_straight_elbow_are_found(tmp_path: Path) -> None:
    # the axes of joints 3 and 5 nearly align: their values are off by round-off over the elbow's square
    robot = tmp_path / "seven.urdf"
    robot.write_text(urdf_of(_SRS))
    derivation = derive(Request(robot, free={"joint7": None}))
    rng = np.random.default_rng(3)
    at = rng.uniform(0.3, 0.9, (400, 7))
    at[:, 3] = 10.0 ** -rng.uniform(3.0, 4.0, 400)
    at[:, 4] = rng.choice([-3.0, 3.0], 400)
    arm = arm_of(derivation)
    poses = arm.oracle.forward(at)
    rows = runner_of(derivation, "cpp", tmp_path).solve_many(poses, seeds=at, limits=True)
    gap = np.where(rows.mask, arm.distance(rows.q, at[:, None]), np.inf).min(axis=1)
    assert (gap < 1e-6).all()


@pytest.mark.long
def test_configurations_on_the_limits_of_two_joints_where_rows_meet_are_found(
    tmp_path: Path,
) -> None:
    robot = tmp_path / "leg.urdf"
    robot.write_text(LEG)
    derivation = derive(Request(robot))
    at = np.random.default_rng(3).uniform(-3.0, 3.0, (400, 3))
    at[:, 1:] = 1.57, 0.0
    arm = arm_of(derivation)
    rows = runner_of(derivation, "cpp", tmp_path).solve_many(arm.oracle.forward(at), limits=True)
    gap = np.where(rows.mask, arm.distance(rows.q, at[:, None]), np.inf).min(axis=1)
    assert (gap < 1e-6).all()


def found_on_limit(
    derivation: Derivation, side: float, decades: tuple[float, float], near: float, folder: Path
) -> None:
    """Joint 4 on the limit on that side, joint 5 some decades below 1: rows come as near as `near`."""
    arm, rng = arm_of(derivation), np.random.default_rng(3)
    at = rng.uniform(0.2, 0.6, (400, 6))
    at[:, 4] = 10.0 ** -rng.uniform(*decades, 400)
    at[:, JOINT] = limit = 0.5
    dh = derivation.module.dh
    joints = list(dh.joints)
    ends = sorted((limit, limit - side * 0.5))
    joints[JOINT] = replace(
        joints[JOINT], limits=replace(joints[JOINT].limits, lower=ends[0], upper=ends[1])
    )
    limited = replace(dh, joints=tuple(joints))
    derivation = replace(derivation, module=replace(derivation.module, dh=limited))
    poses = arm.oracle.forward(at)
    runner = runner_of(derivation, "cpp", folder)
    for seeds in (None, at):
        rows = runner.solve_many(poses, seeds=seeds, limits=True)
        gap = np.where(rows.mask, arm.distance(rows.q, at[:, None]), np.inf).min(axis=1)
        assert (gap < near).all()
        assert (rows.q[rows.mask][:, JOINT] >= ends[0]).all()
        assert (rows.q[rows.mask][:, JOINT] <= ends[1]).all()
        index, q, _ = rows.flat()
        assert np.abs(arm.oracle.forward(q) - poses[index]).max() < 2e-9
