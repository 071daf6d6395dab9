"""Checks of constants, kinematics, batches and refusals, on code that is right but for one thing."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.fake_arms import six_axis_oracle
from tests.support.task_spaces import TASK_SPACES

from ikgen.verify.arm import ArmUnderTest, arm_under_test
from ikgen.verify.interface_checks import (
    check_batch,
    check_constants,
    check_determinism,
    check_forward,
    check_invalid,
    check_jacobian,
    check_shapes,
)
from ikgen.verify.runners.runner import ArmConstants, Rows
from ikgen.verify.sampling import SampleSet
from ikgen.verify.trials import Trial
from ikgen.verify.verification_report import CheckResult

Array = NDArray[np.float64]
ORACLE = six_axis_oracle()
Q = np.random.default_rng(3).uniform(-1.5, 1.5, (4, 6))


def arm(task: str = "pose", free: tuple[str, ...] = ()) -> ArmUnderTest:
    return arm_under_test(ORACLE, TASK_SPACES[task], (ORACLE.lower, ORACLE.upper), free)


def sample() -> SampleSet:
    return SampleSet("made", Q, ORACLE.forward(Q), np.ones(len(Q)))


def rows(q: Array | None = None) -> Rows:
    """One row a pose, and none at the last."""
    q = (Q if q is None else q)[:, None].copy()
    q[-1] = np.nan
    count = np.array([1] * (len(q) - 1) + [0])
    status = ("OK",) * (len(q) - 1) + ("UNREACHABLE",)
    return Rows(q, count, status, np.zeros((len(q), 1), dtype=bool))


class Code:
    """What is emitted, in memory. `asked`: shapes of what was handed over."""

    label, dynamic_shapes = "code", True

    def __init__(self, **constants: Any) -> None:
        names = ORACLE.joint_names
        right = ArmConstants(
            names, ORACLE.lower.copy(), ORACLE.upper.copy(), ORACLE.base_link, ORACLE.tip_link, 8
        )
        self.constants = replace(right, **constants)
        self.asked: list[tuple[int, ...]] = []
        self.many, self.batch = rows(), rows()
        self.off = np.zeros((4, 4))

    def forward(self, q: Array) -> Array:
        self._take(q, (6,))
        T = ORACLE.forward(q).copy()
        T[2] += self.off
        return T

    def jacobian(self, q: Array) -> Array:
        return ORACLE.jacobian(q) + self.off[0, 0]

    def solve(self, pose: Array, free: Any = None, seed: Any = None, limits: bool = True) -> Any:
        self._take(pose, (4, 4))
        if seed is not None:
            self._take(seed, (6,))
        R = pose[:3, :3]
        good = np.isfinite(pose).all() and np.abs(R @ R.T - np.eye(3)).max() < 1e-6
        good = good and np.linalg.det(R) > 0.0
        status = "UNREACHABLE" if good else "INVALID"
        return np.empty((0, 6)), status, np.empty(0, dtype=bool)

    def solve_many(self, poses: Array, **_: Any) -> Rows:
        return self.many

    def solve_batch(self, poses: Array, **_: Any) -> Rows | None:
        return self.batch

    def _take(self, value: Array, shape: tuple[int, ...]) -> None:
        self.asked.append(value.shape)
        if value.shape[-len(shape) :] != shape:
            raise ValueError("shape")


def constants(free: tuple[str, ...] = (), **wrong: Any) -> str:
    """What is wrong with constants."""
    found = check_constants(arm(free=free), Code(**wrong), rows())  # type: ignore[arg-type]
    assert found.passed == (found.failures == 0) == (not found.detail) and found.count == 9
    return found.detail


def test_limits_are_those_that_were_asked_for_and_the_file_s() -> None:
    asked = arm_under_test(ORACLE, TASK_SPACES["pose"], (0.5 * ORACLE.lower, ORACLE.upper), ())
    found = check_constants(asked, Code(), rows())  # type: ignore[arg-type]
    assert found.detail.startswith("lower limits: ")
    found = check_constants(asked, Code(lower=0.5 * ORACLE.lower), rows())  # type: ignore[arg-type]
    assert found.detail.startswith("lower limits: ")


def test_right_constants_pass_and_each_wrong_one_is_named() -> None:
    assert constants() == ""
    assert constants(joint_names=tuple("abcdef")) == "joint names"
    assert constants(base_link="l1") == "links"
    assert constants(tip_link="l1") == "links"
    assert constants(task="position") == "task"
    assert constants(max_solutions=0) == "most solutions"
    assert constants(max_solutions=1) == ""
    for name in ("lower", "upper"):
        files = getattr(ORACLE, name)
        limits, j = files.copy(), int(np.isfinite(files).argmax())
        limits[j] = files[j] + 1e-6
        words = f"{name} limits: {ORACLE.joint_names[j]} has {limits[j]:.9g}, not {files[j]:.9g}"
        assert constants(**{name: limits}) == words
        limits[j] = files[j] + 1e-12
        assert constants(**{name: limits}) == ""


@pytest.mark.parametrize(
    ("value", "right"),
    [
        (0.0, True),
        ("lower", True),
        ("upper", True),
        (math.nan, False),
        ("beyond", False),
        ("below", False),
    ],
)
def test_defaults_of_free_joints_are_inside_their_limits(value: float | str, right: bool) -> None:
    low, high = float(ORACLE.lower[2]), float(ORACLE.upper[2])
    values = {"lower": low, "upper": high, "beyond": high + 1e-3, "below": low - 1e-3}
    default = values[value] if isinstance(value, str) else value
    name = ORACLE.joint_names[2]
    told = constants((name,), free_joints=(name,), free_defaults=(default,))
    assert told == ("" if right else "defaults of free joints")
    assert constants((name,), free_joints=(name,), free_defaults=None) == ""
    assert constants((name,), free_joints=(name,), free_defaults=()) == "defaults of free joints"
    assert constants((name,)) == "free joints"


@pytest.mark.parametrize("check", [check_forward, partial(check_jacobian, arm())])
def test_kinematics_are_compared_entry_by_entry(check: Callable[..., CheckResult]) -> None:
    code = Code()
    right = check(code, sample())
    assert right.passed and right.count == 4 and right.worst[0][1] < 1e-12
    code.off[0, 0] = 3e-5
    wrong = check(code, sample())
    assert not wrong.passed and wrong.worst == (("largest entry", pytest.approx(3e-5)),)
    assert wrong.failures == (1 if check is check_forward else 4)
    assert wrong.worst_case.startswith("made #2: q" if check is check_forward else "made #")
    code.off[0, 0] = math.nan
    assert check(code, sample()).worst[0][1] == math.inf


def batch(change: Callable[[Rows], Rows | None]) -> tuple[bool, int, str]:
    code = Code()
    code.batch = change(code.batch)  # type: ignore[assignment]
    found = check_batch(arm(), code, sample(), code.solve_many(sample().poses))  # type: ignore[arg-type]
    return found.passed, found.failures, found.detail


def moved(by: float, at: int = 1) -> Callable[[Rows], Rows]:
    def change(r: Rows) -> Rows:
        q = r.q.copy()
        q[at, 0, 4] += by
        return replace(r, q=q)

    return change


def test_a_batch_has_the_rows_and_the_status_of_single_answers() -> None:
    assert batch(lambda r: r) == (True, 0, "")
    assert batch(moved(1e-9))[0]
    assert batch(moved(2.0 * math.pi))[0]
    assert batch(moved(1e-3)) == (False, 1, "")
    assert batch(lambda r: replace(r, status=("OK", "OK", "LIMITS", "UNREACHABLE"))) == (
        False,
        1,
        "",
    )
    assert batch(lambda r: replace(r, q=np.where(np.isnan(r.q), 0.0, r.q))) == (False, 1, "")
    assert batch(lambda r: replace(r, q=r.q[:, :, :5])) == (False, 4, "shape of q (4, 1, 5)")
    assert batch(lambda r: None) == (True, 0, "code has none")


@pytest.mark.parametrize(("by", "same"), [(3e-8, True), (1e-5, False)])
def test_a_batch_may_end_elsewhere_by_what_steps_leave(by: float, same: bool) -> None:
    """Beside a singularity an error of 1e-13 moves a row by more than 1e-9 rad."""
    under_test, code = arm(), Code()
    q = Q.copy()
    q[1, 4] = 1e-5  # the wrist is all but straight
    code.many, code.batch = rows(q), rows(q)
    null = np.linalg.svd(under_test.scaled_jacobian(q[1:2])[1][0])[2][-1]
    code.batch.q[1, 0] += by * null
    assert code.batch.q[1, 0, 3] != q[1, 3]
    found = check_batch(under_test, code, sample(), code.many)  # type: ignore[arg-type]
    assert found.passed is same


@pytest.mark.parametrize("count", [1, 3, 5])
def test_a_batch_with_another_number_of_statuses_is_no_answer(count: int) -> None:
    with pytest.raises(ValueError, match="zip"):
        batch(lambda one: replace(one, status=("OK",) * count))


def test_a_batch_has_no_fewer_and_no_other_rows() -> None:
    """Of two rows, one twice is not both."""
    code = Code()
    both = np.stack([Q, Q + 0.5], axis=1)
    two = Rows(both, np.full(4, 2), ("OK",) * 4, np.zeros((4, 2), dtype=bool))
    twice = both.copy()
    twice[3, 1] = twice[3, 0]
    for single, many in ((both, twice), (twice, both)):
        code.many, code.batch = replace(two, q=single), replace(two, q=many)
        found = check_batch(arm(), code, sample(), code.solve_many(sample().poses))  # type: ignore[arg-type]
        assert (found.passed, found.failures, found.count) == (False, 1, 4)
        assert "batch" in found.worst_case and "single" in found.worst_case


def test_the_same_poses_give_the_same_bits() -> None:
    some = Rows(Q[:2, None], np.ones(2, int), ("OK", "OK"), np.zeros((2, 1), dtype=bool))
    first = again = Trial(sample(), some, True, False)
    assert check_determinism(first, again).count == 2 and check_determinism(first, again).passed
    late = Q[:2, None].copy()
    late[1, 0, 0] = np.nextafter(late[1, 0, 0], 9.0)
    other = check_determinism(first, replace(again, rows=replace(some, q=late)))
    assert not other.passed and other.failures == 1


def test_what_is_no_pose_is_refused() -> None:
    pose = ORACLE.forward(Q)[0]
    right = check_invalid(arm(), Code(), pose)  # type: ignore[arg-type]
    assert right.passed and right.count == 9

    class Careless(Code):
        def solve(
            self, pose: Array, free: Any = None, seed: Any = None, limits: bool = True
        ) -> Any:
            if np.isinf(pose).any():
                raise FloatingPointError
            q, status, flags = super().solve(pose, free, seed, limits)
            return (
                (np.zeros((1, 6)), status, flags) if not pose[:3, :3].any() else (q, status, flags)
            )

    wrong = check_invalid(arm(), Careless(), pose)  # type: ignore[arg-type]
    assert wrong.failures == 3 and "zero rotation: INVALID, 1 rows" in wrong.detail
    assert "all infinite: raises FloatingPointError" in wrong.detail


@pytest.mark.parametrize(("task", "size"), [("pose", 3), ("position", 3), ("rotation", 2)])
def test_inputs_of_a_wrong_shape_are_handed_over(task: str, size: int) -> None:
    code, pose = Code(), ORACLE.forward(Q)[0]
    found = check_shapes(arm(task), code, pose)  # type: ignore[arg-type]
    assert found.passed and found.count == 4
    assert code.asked == [(size, size), (16,), (4, 4), (7,), (1, 7)]

    class Careless(Code):
        def solve(self, pose: Array, *_: Any, **__: Any) -> Any:
            if pose.shape == (16,):
                raise TypeError

        def forward(self, q: Array) -> Array:
            return np.eye(4)[None]

    wrong = check_shapes(arm(task), Careless(), pose)  # type: ignore[arg-type]
    assert wrong.failures == 4 and "pose (16,): TypeError" in wrong.detail
    code.dynamic_shapes = False
    excluded = check_shapes(arm(task), code, pose)  # type: ignore[arg-type]
    assert (excluded.count, excluded.passed) == (0, True)


def test_a_joint_that_others_follow_fast_is_compared_relative_to_its_column() -> None:
    """Where one turns 1e4 times as far as its driver, rounding alone moves entries by 1e-8."""
    fast, code = arm(), Code()
    true = fast.oracle.jacobian(sample().q)
    scaled = true * np.array([1e4, 1.0, 1.0, 1.0, 1.0, 1.0])
    for column, by, failures in ((0, 1e-6, 0), (0, 1e-4, 4), (1, 1e-8, 4)):
        off = np.zeros((6, 6))
        off[0, column] = by
        made = replace(
            fast,
            oracle=SimpleNamespace(jacobian=lambda q: scaled),  # type: ignore[arg-type]
        )
        code = SimpleNamespace(jacobian=lambda q, off=off: scaled + off)  # type: ignore[assignment]
        found = check_jacobian(made, code, sample())  # type: ignore[arg-type]
        assert found.failures == failures
