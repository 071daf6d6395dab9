"""Rows from compensated poses: as many as there are, or none is claimed."""

from __future__ import annotations

import math
from types import ModuleType

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.both_languages import Both, in_both
from tests.support.cpp_modules import solver_module

from ikgen.runtime.python.solving.closed_form_rows import certain_rows
from ikgen.runtime.python.solving.compensated_rows import compensated_rows
from ikgen.runtime.python.solving.doubtful_rows import unplaced_rows

pytestmark = pytest.mark.usefixtures("solved_once")

Array = NDArray[np.float64]


@pytest.fixture(scope="module")
def doosan(tmp_path_factory: pytest.TempPathFactory) -> Both:
    return in_both(solver_module("doosan_m1013"), tmp_path_factory.mktemp("doosan"), "5")


def configurations(count: int, **near: float) -> Array:
    """Random ones; joints (`q3`, `q5`) up to that far from 0."""
    rng = np.random.default_rng(20260101)
    q = rng.uniform(-2.6, 2.6, (count, 6))
    for name, far in near.items():
        q[:, int(name[1]) - 1] = rng.uniform(-far, far, count)
    return q


def held(T: Array) -> Array:
    return np.zeros((len(T), 0))


def doubtful(arm: ModuleType, q: Array) -> Array:
    """The poses of which rows refined together leave a doubt."""
    T = arm.forward(q)
    return np.asarray(T[certain_rows(arm._ARM, arm._ARM.together, T, held(T), None)[2]])


def gap(a: Array, b: Array) -> Array:
    return np.abs(np.remainder(a - b + math.pi, 2 * math.pi) - math.pi).max(axis=-1)


@pytest.mark.parametrize(
    ("q", "least"),
    [
        pytest.param(configurations(6000), 0.3, marks=pytest.mark.long),
        (configurations(200, q3=0.01), 0.1),
        (configurations(200, q5=0.01), 0.0),
        (configurations(100, q3=1e-4, q5=1e-4), 0.0),
        (configurations(100, q5=1e-7), 0.0),
    ],
    ids=["random", "elbow", "wrist", "both", "on a continuum that rounding breaks"],
)
def test_what_is_sure_is_all_that_careful_steps_find(doosan: Both, q: Array, least: float) -> None:
    arm = doosan.arm
    T = doubtful(arm, q)
    rows, found, sure = compensated_rows(arm._ARM, T, held(T))
    assert len(T) > 10 and sure.mean() >= least
    careful = unplaced_rows(arm._ARM, T[sure], held(T[sure])) if sure.any() else []
    own = [q[there] for q, there in zip(rows[sure], found[sure], strict=True)]
    for pose, some, others in zip(T[sure], own, careful, strict=True):
        assert np.abs(arm.forward(some) - pose).max() < 1e-9
        assert len(some) == len(others)
        assert all(gap(some, np.array(row)).min() < 1e-5 for row, _ in others)


def test_a_pose_that_the_arm_cannot_take_is_never_sure(doosan: Both) -> None:
    T = doosan.arm.forward(configurations(20))
    T[:, :3, 3] += 5.0
    assert not compensated_rows(doosan.arm._ARM, T, held(T))[2].any()


def test_both_languages_answer_alike_there(doosan: Both) -> None:
    q = np.concatenate([configurations(40, q3=0.02), configurations(40, q5=0.02)])
    for row, pose in zip(q, doosan.arm.forward(q), strict=True):
        here = doosan.arm.solve(pose, seed=row).q
        status, numbers = doosan.run(5, row, pose[None])
        there = numbers.reshape(-1, 6)
        assert status == "OK" and len(here) == len(there)
        assert all(gap(there, one).min() < 1e-6 for one in here)
        assert gap(there, row).min() < 1e-6


def next_to_folds(arm: ModuleType, off: float) -> Array:
    """Configurations with the elbow as far (rad) from where two solutions meet."""

    def sense(q: Array) -> float:
        return float(np.linalg.det(arm.jacobian(q)))

    out = []
    for q in configurations(40):
        low, high = q.copy(), q.copy()
        low[2], high[2] = -0.1, 0.1
        if sense(low) * sense(high) > 0:
            continue
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if sense(low) * sense(middle) > 0 else (low, middle)
        low[2] += off
        out.append(low)
    assert len(out) > 20
    return np.array(out)


@pytest.mark.parametrize("off", [1e-3, 1e-4, 2e-5])
def test_both_solutions_next_to_a_fold_are_found(doosan: Both, off: float) -> None:
    """In both languages: one is where the pose is from, the other as far behind the fold."""
    q = next_to_folds(doosan.arm, off)
    for row, pose in zip(q, doosan.arm.forward(q), strict=True):
        _, numbers = doosan.run(5, row, pose[None])
        for rows in (numbers.reshape(-1, 6), doosan.arm.solve(pose, seed=row).q):
            near = np.sort(gap(rows, row))
            assert near[0] < 1e-5 and near[1] < 50.0 * off
