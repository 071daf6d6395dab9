"""Configurations on a limit near a singularity: the pose does not tell their rows from such outside."""

from __future__ import annotations

from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.cpp_modules import solver_module
from tests.support.solving import import_text

from ikgen.emit.python.python_emitter import emit_module
from ikgen.runtime.python.singular.limit_rows import rows_inside

pytestmark = pytest.mark.usefixtures("solved_once")

Array = NDArray[np.float64]
SHOULDER, JOINT = 1, 2


@pytest.fixture(scope="module", params=["kuka_kr6r900sixx", "doosan_m1013"])
def arm(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    """Of exact and of rounded geometry."""
    text = emit_module(solver_module(request.param))
    return import_text(text, tmp_path_factory.mktemp("arm"))


def stretched(arm: ModuleType, start: Array) -> Array:
    """A configuration from start on along the elbow where two rows meet."""

    def orientation(x: float) -> float:
        return float(np.linalg.det(arm.jacobian(start + x * np.eye(6)[JOINT])))

    ways = np.linspace(0.0, 6.0, 120)
    signs = np.sign([orientation(x) for x in ways])
    k = int(np.flatnonzero(signs[1:] != signs[:-1])[0])
    low, high = ways[k], ways[k + 1]
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (
            (low, middle) if orientation(middle) * orientation(low) < 0.0 else (middle, high)
        )
    return np.asarray(start + low * np.eye(6)[JOINT])


def limited(arm: ModuleType, q: Array, side: int) -> None:
    """The arm with a limit of the elbow at q, half a radian wide; others wide."""
    lower, upper = np.full((2, 6), 4.0) * np.array([[-1.0], [1.0]])
    lower[JOINT], upper[JOINT] = (
        (q[JOINT] - 0.5, q[JOINT]) if side > 0 else (q[JOINT], q[JOINT] + 0.5)
    )
    limits = tuple(lower.tolist()), tuple(upper.tolist())
    arm._ARM = replace(arm._ARM, lower=limits[0], upper=limits[1])


@pytest.mark.parametrize("off", [1e-4, 1e-5, 1e-6, 1e-7])
def test_configurations_on_a_limit_near_a_fold_are_found(arm: ModuleType, off: float) -> None:
    rng = np.random.default_rng(3)
    for _ in range(4):
        q = rng.uniform(-1.0, 1.0, 6)
        q[4] = 0.8
        q = stretched(arm, q)
        for away in (off, -off):
            at = q + away * np.eye(6)[JOINT]
            for side in (1, -1):
                limited(arm, at, side)
                pose = arm.forward(at)
                batch, count, _ = arm.solve_batch(pose[None])
                for rows in (arm.solve(pose).q, batch[0, : count[0]]):
                    gap = np.abs(np.remainder(rows - at + np.pi, 2 * np.pi) - np.pi).max(axis=1)
                    assert gap.min() < 2e-6
                    assert np.abs(arm.forward(rows) - pose).max() < 2e-9
                    assert (rows <= arm._ARM.upper).all() and (rows >= arm._ARM.lower).all()


@pytest.mark.parametrize("room", [1e-9, 1e-8, 1e-7])
def test_of_several_joints_outside_one_alone_may_belong_on_its_limit(
    arm: ModuleType, room: float
) -> None:
    """Along the direction in which the pose hardly moves the elbow is on its limit, and the shoulder would
    be on its own a bit farther on: a row may be outside both."""
    rng = np.random.default_rng(5)
    for _ in range(6):
        q = rng.uniform(-1.0, 1.0, 6)
        q[4] = 0.8
        at = stretched(arm, q)
        still = np.linalg.svd(arm.jacobian(at))[2][-1]
        for way in (still, -still):
            lower, upper = np.full((2, 6), 4.0) * np.array([[-1.0], [1.0]])
            for joint, left in ((JOINT, 0.0), (SHOULDER, room)):
                end = at[joint] + left * np.sign(way[joint])
                (upper if way[joint] > 0.0 else lower)[joint] = end
            limits = tuple(lower.tolist()), tuple(upper.tolist())
            arm._ARM = replace(arm._ARM, lower=limits[0], upper=limits[1])
            for off in (0.0, 1e-8, 1e-7, 1e-6):
                start = at + off * way
                row = rows_inside(
                    arm._ARM, arm.forward(at)[None], [(tuple(start.tolist()), False)], None, True
                )
                assert row
                gap = np.remainder(np.array(row[0][0]) - at + np.pi, 2 * np.pi) - np.pi
                assert np.abs(gap).max() < 2e-6


def test_what_the_pose_tells_to_be_outside_stays_outside(arm: ModuleType) -> None:
    q = np.array([0.3, -0.6, 1.1, 0.4, 0.8, -0.2])
    limited(arm, q, 1)
    for beyond, found in ((0.0, True), (1e-7, False), (1e-6, False)):
        at = q + beyond * np.eye(6)[JOINT]
        aim = arm.forward(at)[None]
        assert bool(rows_inside(arm._ARM, aim, [(tuple(at.tolist()), False)], None, True)) is found
        off = np.abs(arm.solve(aim[0]).q - at).max(axis=1).min(initial=np.inf)
        assert bool(off < 1e-8) is found


def test_a_row_that_is_off_is_refined_before_limits_count(arm: ModuleType) -> None:
    q = np.array([0.3, -0.6, 1.1, 0.4, 0.8, -0.2])
    limited(arm, q, 1)
    near = q + 3e-7 * np.eye(6)[JOINT]
    ((row, flag),) = rows_inside(arm._ARM, arm.forward(q)[None], [(tuple(near), True)], None, True)
    assert flag and np.abs(np.array(row) - q).max() < 1e-9
