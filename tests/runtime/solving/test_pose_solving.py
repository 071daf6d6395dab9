"""What becomes of a pose: its status with and without limits, and the seed's own row at a continuum."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from tests.support.cpp_modules import robot_file, solver_module
from tests.support.solving import import_text

from ikgen.derivation.derive import derive
from ikgen.emit.python.python_emitter import emit_module
from ikgen.records.request import Request
from ikgen.runtime.python.solving import pose_solving
from ikgen.runtime.python.solving.doubtful_poses import placed_rows
from ikgen.runtime.python.solving.pose_solving import solve_pose

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


def test_answers_are_compared_as_objects(arm: ModuleType) -> None:
    """Their arrays have no single truth: answers can be looked for in lists and be keys."""
    pose = arm.forward([0.3, -0.9, 1.1, 0.4, 0.7, -0.2])
    one, other = arm.solve(pose), arm.solve(pose)
    assert one == one and one != other and other in [one, other] and len({one, other}) == 2
    path = arm.follow([pose], start=one.q[0])
    assert path == path and path != arm.follow([pose], start=one.q[0])


@pytest.mark.parametrize("name", ["kuka_kr6r900sixx", "doosan_m1013", "fanuc_crx10ia"])
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


def test_rough_rows_are_refined_where_they_are_regular(
    arm: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As in arrays: what is for rows near singularities is for those alone."""
    careful: list[object] = []

    def placed(*given: object) -> object:
        careful.append(given)
        return placed_rows(*given)  # type: ignore[arg-type]

    def branches(*given: Any) -> Any:
        rows, doubt = arm._ARM.branches(*given)
        return [(tuple(x + 1e-6 for x in row), k != 1) for k, (row, _) in enumerate(rows)], doubt

    monkeypatch.setattr(pose_solving, "placed_rows", placed)
    rough = replace(arm._ARM, branches=branches)
    regular = arm.forward([0.3, -0.9, 1.1, 0.4, 0.7, -0.2])
    found, exact = (solve_pose(one, regular, None, None, False).q for one in (rough, arm._ARM))
    far = np.abs(found - exact).max(axis=1)
    assert not careful and far[1] > 1e-7 and np.delete(far, 1).max() < 1e-8
    solve_pose(rough, arm.forward([0.3, -0.9, 1.1, 0.4, 1e-5, -0.2]), None, None, False)
    assert len(careful) == 1


def test_an_elimination_takes_care_of_no_regular_pose(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    crx = import_text(emit_module(derive(Request(robot_file("fanuc_crx10ia"))).module), tmp_path)
    poses = crx.forward(np.random.default_rng(2).uniform(-2.0, 2.0, (8, 6)))
    rows, count, _ = crx.solve_batch(poses, limits=False)
    monkeypatch.setattr(crx, "_placed_rows", None)  # cannot be called
    for pose, q, n in zip(poses, rows, count, strict=True):
        found = crx.solve(pose, limits=False)
        np.testing.assert_allclose(found.q, q[:n], atol=1e-12)
        assert n and not found.singular.any()


def test_an_elimination_settles_doubts_from_the_rows_that_it_has(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Alone and in a stack: of a pose near a singularity it is asked once."""
    crx = import_text(emit_module(derive(Request(robot_file("fanuc_crx10ia"))).module), tmp_path)
    asked: list[int] = []

    def branches(T: Any, *given: Any) -> Any:
        asked.append(len(T))
        return crx._branches_batch(T, *given)

    arm = replace(crx._ARM, branches_batch=branches)
    q = np.array([[0.3, -0.9, 1.1, 0.4, 0.7, -0.2], [0.3, -0.9, 1.1, 0.4, 1e-9, -0.2]])
    found = crx._solve_each(arm, crx.forward(q), None, None, False)
    assert asked == [2]
    alone = crx._solve_pose(arm, crx.forward(q[1]), None, None, False)
    assert asked == [2, 1]
    np.testing.assert_allclose(alone.q, found[1].q, atol=1e-6)
    for row, answer in zip(q, found, strict=True):
        assert np.abs(answer.q - row).max(axis=1).min() < 1e-6
