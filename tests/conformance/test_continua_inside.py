"""Continua whose first row is outside the limits, where they go on inside."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from benchmarks.agreement import arm_of, runner_of
from tests.support.solving import FIXTURES, NO_COMPILER

from ikgen.generation.derive import derive
from ikgen.generation.request import Request

LOWER, UPPER = 0.5, 0.7
"""Of joint 4: neither 0 nor a multiple of the step between the values that are tried lies inside."""

pytestmark = pytest.mark.usefixtures("solved_once")


@pytest.mark.parametrize(
    "language",
    [
        "python",
        pytest.param("cpp", marks=pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "")),
    ],
)
def test_a_stretched_wrist_is_answered_inside_the_limits(language: str, tmp_path: Path) -> None:
    derivation = derive(Request(FIXTURES / "kuka_kr6r900sixx.urdf"))
    arm, rng = arm_of(derivation), np.random.default_rng(4)
    at = rng.uniform(0.2, 0.6, (20, 6))
    at[:, 3], at[:, 4] = rng.uniform(LOWER, UPPER, 20), 0.0
    dh = derivation.module.dh
    joints = list(dh.joints)
    joints[3] = replace(joints[3], limits=replace(joints[3].limits, lower=LOWER, upper=UPPER))
    limited = replace(dh, joints=tuple(joints))
    derivation = replace(derivation, module=replace(derivation.module, dh=limited))
    poses = arm.oracle.forward(at)
    rows = runner_of(derivation, language, tmp_path).solve_many(poses, seeds=None, limits=True)
    assert rows.mask.any(axis=1).all()
    index, q, _ = rows.flat()
    assert (q[:, 3] >= LOWER).all()
    assert (q[:, 3] <= UPPER).all()
    assert np.abs(arm.oracle.forward(q) - poses[index]).max() < 2e-9
