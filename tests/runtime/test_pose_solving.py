"""What becomes of a pose: its status with and without limits, and the seed's own row at a continuum."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from tests.support.cpp_modules import robot_file, solver_module
from tests.support.solving import import_text

from ikgen.emit.python.python_emitter import emit_module
from ikgen.generation.derive import derive
from ikgen.generation.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")


@pytest.fixture(scope="module", params=["kuka_kr6r900sixx", "ur5e"])
def arm(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    text = emit_module(solver_module(request.param))
    return import_text(text, tmp_path_factory.mktemp("arm"))


def test_the_status_tells_limits_from_reach(arm: ModuleType) -> None:
    pose = arm.forward([0.3, -0.9, 1.1, 0.4, 0.7, -0.2])
    narrow = replace(arm._ARM, lower=(3.1,) * 6, upper=(3.14,) * 6)
    found = {limits: arm._solve_pose(narrow, pose, None, None, limits) for limits in (True, False)}
    assert found[True].status is arm.Status.LIMITS and len(found[True]) == 0
    assert found[False].status is arm.Status.OK and len(found[False]) == 8
    beyond = pose.copy()
    beyond[:3, 3] *= 9.0
    for limits in (True, False):
        assert arm.solve(beyond, limits=limits).status is arm.Status.UNREACHABLE
        assert arm.solve(np.full((4, 4), np.nan), limits=limits).status is arm.Status.INVALID


def test_the_seed_is_among_the_rows_of_a_continuum(arm: ModuleType) -> None:
    """Axes 4 and 6, or 4 and 2, in line: without the seed another row of the continuum stands for it."""
    seed = np.array([0.3, -0.9, 1.1, 0.4, 0.0, -0.2])
    pose = arm.forward(seed)
    found = arm.solve(pose, seed=seed, limits=False)
    assert found.singular[0] and np.abs(found.q[0] - seed).max() < 1e-9
    assert np.abs(arm.forward(found.q) - pose).max() < 1e-9
    assert np.abs(arm.solve(pose, limits=False).q - seed).max(axis=1).min() > 0.1


@pytest.mark.parametrize("name", ["doosan_m1013", "fanuc_crx10ia"])
@pytest.mark.parametrize("seeded", [False, True])
def test_poses_in_a_stack_are_solved_as_each_is_alone(
    name: str, seeded: bool, tmp_path: Path
) -> None:
    module = derive(Request(robot_file(name))).module
    arm = import_text(emit_module(module), tmp_path)
    rng = np.random.default_rng(3)
    q = rng.uniform(-3.0, 3.0, (12, 6))
    q[4:, 4] = 0.0  # wrists held straight
    poses = arm.forward(q)
    poses[2] = np.nan
    free = np.zeros((len(q), 0))
    found = arm._solve_each(arm._ARM, poses, free, q if seeded else None, True)
    assert found[2].status is arm.Status.INVALID
    for k, one in enumerate(found):
        alone = arm.solve(poses[k], seed=q[k] if seeded else None)
        assert one.status is alone.status and len(one) == len(alone)
        np.testing.assert_allclose(one.q, alone.q, atol=1e-7)
        np.testing.assert_array_equal(one.singular, alone.singular)
