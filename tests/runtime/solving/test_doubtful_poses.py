"""Poses near singularities: many at once give what each gives alone."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.cpp_modules import solver_module
from tests.support.rounded_arms import (
    WRIST_BESIDE_THE_FIRST_AXIS,
    beside_the_wrist,
    of_two_decimals,
    three_parallel,
)
from tests.support.solving import emitted, import_text

from ikgen.emit.python.python_emitter import emit_module
from ikgen.kinematics.modified_dh import to_dh

Array = NDArray[np.float64]


@pytest.fixture(scope="module", params=["far", "near", "exact"])
def arm(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    """By how far its file is off what was solved: poses beside count always, near singularities, never."""
    name = "kuka_kr6r900sixx" if request.param == "exact" else "doosan_m1013"
    module = import_text(emit_module(solver_module(name)), tmp_path_factory.mktemp("arm"))
    if request.param == "near":
        policy = replace(module._ARM.policy, beside_reach=module._ARM.policy.fold_reach)
        module._ARM = replace(module._ARM, policy=policy)
    return module


def beside(arm: ModuleType, count: int) -> Array:
    """Configurations a hundredth to a millionth of a radian from right angles of one joint."""
    rng = np.random.default_rng(4)
    q = rng.uniform(np.maximum(arm.LOWER, -3), np.minimum(arm.UPPER, 3), (count, 6))
    joint, off = rng.integers(1, 5, count), 10.0 ** -rng.integers(2, 7, count)
    at = np.arange(count), joint
    q[at] = np.round(q[at] / (math.pi / 2)) * (math.pi / 2) + off
    return np.clip(q, arm.LOWER, arm.UPPER)


def apart(a: Array, b: Array) -> Array:
    return np.abs(np.remainder(a - b + math.pi, 2 * math.pi) - math.pi).max(axis=-1)


def test_which_leave_a_joint_free_is_told_as_on_floats(arm: ModuleType) -> None:
    q = np.concatenate([beside(arm, 60), np.zeros((1, 6))])
    poses, start = arm.forward(q), np.full((len(q), 6), 0.1)
    _, _, singular, _, doubt = arm._ARM.branches_batch(poses, start, np.empty((len(q), 0)))
    hits = [arm._ARM.branches(T, (0.1,) * 6, ())[1] for T in poses.tolist()]
    assert ((singular | doubt).any(axis=1) == hits).all()
    assert any(hits) and not all(hits)


@pytest.mark.parametrize("seeded", [False, True])
@pytest.mark.parametrize("limits", [False, True])
def test_a_batch_gives_what_each_pose_gives(arm: ModuleType, seeded: bool, limits: bool) -> None:
    q = beside(arm, 40)
    poses, seeds = arm.forward(q), q + 0.2 if seeded else None
    rows, count, status = arm.solve_batch(poses, seed=seeds, limits=limits)
    for i, T in enumerate(poses):
        seed = None if seeds is None else seeds[i]
        alone = arm.solve(T, seed=seed, limits=limits)
        assert (count[i], status[i]) == (len(alone), alone.status)
        assert np.abs(rows[i, : count[i]] - alone.q).max(initial=0.0) < 1e-7
        assert np.isnan(rows[i, count[i] :]).all()
        assert np.abs(arm.forward(alone.q) - T).max(initial=0.0) < 2e-9
        assert apart(alone.q, q[i]).min() < 1e-4


@pytest.mark.long
def test_behind_a_direction_that_rounding_turns_rows_are_found(tmp_path: Path) -> None:
    q = beside_the_wrist(300)
    module = emitted(to_dh(three_parallel()), tmp_path)
    rows, count, _ = module.solve_batch(module.forward(q), limits=False)
    for k, at in enumerate(q):
        assert apart(rows[k, : count[k]], at).min(initial=9.0) < 1e-6


def test_a_direction_that_the_one_before_leaves_nothing_of_tells_of_no_row(tmp_path: Path) -> None:
    module = emitted(to_dh(of_two_decimals()), tmp_path)
    for q in WRIST_BESIDE_THE_FIRST_AXIS:
        found = module.solve(module.forward(q), limits=False)
        assert apart(found.q, np.array(q)).min(initial=9.0) < 1e-6


def test_poses_out_of_reach_have_no_rows(arm: ModuleType) -> None:
    far = np.tile(np.eye(4), (3, 1, 1))
    far[:, 0, 3] = 1.0, 9.0, 99.0
    for seed in (None, np.full(6, 0.1)):
        _, count, status = arm.solve_batch(far[1:], seed=seed)
        assert not count.any() and set(status) == {"UNREACHABLE"}


def test_that_no_row_takes_a_pose_is_told_of_many_at_once(
    arm: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Steps of one run, which end long before they stand still; rows that take a pose are not left."""
    q, steps, step = beside(arm, 12), [], arm._clipped_step
    poses = arm.forward(q)
    poses[:6, 0, 3] += 9.0

    def counted(q: Array, *given: Array) -> tuple[Array, Array]:
        steps.append(len(q))
        return step(q, *given)

    monkeypatch.setattr(arm, "_clipped_step", counted)
    rows = arm._nearest_rows(arm._ARM, poses, np.zeros((12, 6)), True, False)
    assert len(steps) <= 84 and sum(steps) < 10 * steps[0]
    off = np.abs(arm.forward(rows) - poses).max(axis=(1, 2))
    assert (off[:6] > 1.0).all() and (off[6:] < 1e-3).all()
    for k in range(0, 12, 4):
        alone = arm._nearest_rows(arm._ARM, poses[k : k + 1], np.zeros((1, 6)), True, False)
        np.testing.assert_allclose(rows[k], alone[0], atol=1e-9)
