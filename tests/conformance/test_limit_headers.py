"""Headers beside singularities on a limit: the pose does not tell their rows from such outside."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from benchmarks.agreement import arm_of, runner_of
from tests.support.solving import FIXTURES, NO_COMPILER

from ikgen.generation.derive import derive
from ikgen.generation.request import Request

JOINT = 3

pytestmark = [
    pytest.mark.usefixtures("solved_once"),
    pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or ""),
]


@pytest.mark.parametrize(("name", "side"), [("kuka_kr6r900sixx", 1.0), ("doosan_m1013", -1.0)])
def test_configurations_on_a_limit_beside_a_singularity_are_found(
    name: str, side: float, tmp_path: Path
) -> None:
    derivation = derive(Request(FIXTURES / f"{name}.urdf"))
    arm, rng = arm_of(derivation), np.random.default_rng(3)
    at = rng.uniform(0.2, 0.6, (400, 6))
    at[:, 4] = 10.0 ** -rng.uniform(5.0, 7.5, 400)
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
    runner = runner_of(derivation, "cpp", tmp_path)
    for seeds in (None, at):
        rows = runner.solve_many(poses, seeds=seeds, limits=True)
        gap = np.where(rows.mask, arm.distance(rows.q, at[:, None]), np.inf).min(axis=1)
        assert (gap < 1e-3).all()
        assert (rows.q[rows.mask][:, JOINT] >= ends[0]).all()
        assert (rows.q[rows.mask][:, JOINT] <= ends[1]).all()
        index, q, _ = rows.flat()
        assert np.abs(arm.oracle.forward(q) - poses[index]).max() < 2e-9
