"""Which poses are put to emitted code, how, and what of the answers each check is handed."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.fake_arms import JOINTS, six_axis_oracle
from tests.support.task_spaces import TASK_SPACES

from ikgen.model.dh import ARM_ANGLE_IDENTIFIER
from ikgen.verify import verification
from ikgen.verify.answers import collect_answers
from ikgen.verify.arm import ArmUnderTest, arm_under_test
from ikgen.verify.runners.runner import Rows
from ikgen.verify.verification import _mismatch, _run_checks
from ikgen.verify.verification_report import CheckResult

Array = NDArray[np.float64]


class Asked:
    """A runner that answers with nothing and keeps what it was asked."""

    def __init__(self, batch: str = "plain") -> None:
        self.calls: list[tuple[int, bool, bool, bool]] = []
        self.batches: list[tuple[int, bool]] = []
        self.batch = batch

    def rows(self, count: int, mark: float) -> Rows:
        q = np.full((count, 2, 6), np.nan)
        q[::2, 0] = mark
        number = (np.arange(count) + 1) % 2
        return Rows(q, number, ("OK",) * count, np.zeros((count, 2), bool))

    def solve_many(self, poses: Array, *, free=None, seeds=None, limits: bool = True) -> Rows:
        self.calls.append((len(poses), free is not None, seeds is not None, limits))
        return self.rows(len(poses), 0.25)

    def solve_batch(self, poses: Array, limits: bool = True, free=None) -> Rows | None:
        self.batches.append((len(poses), limits))
        if self.batch == "raises":
            raise ArithmeticError
        return None if self.batch == "none" else self.rows(len(poses), 0.5)


def arm(held: tuple[str, ...] = ()) -> ArmUnderTest:
    oracle = six_axis_oracle()
    return arm_under_test(oracle, TASK_SPACES["pose"], (oracle.lower, oracle.upper), held)


def test_each_set_is_asked_as_its_checks_need() -> None:
    runner = Asked()
    found = collect_answers(runner, arm(), 40, 0)
    assert (found.limited.limits, found.limited.seeded) == (True, False)
    assert (found.unlimited.limits, found.unlimited.seeded) == (False, False)
    assert [(t.limits, t.seeded) for t in found.inside] == [(True, False)] * 2
    assert [(t.limits, t.seeded) for t in found.outside] == [(True, False), (False, False)]
    limits = {t.sample.label: t.limits for t in found.seeded}
    assert limits == {"singular": True, "special": True, "near singular": False, "boundary": False}
    assert all(t.seeded for t in found.seeded)
    assert (found.ordered.limits, found.ordered.seeded, len(found.seeds)) == (True, True, 40)
    assert [(t.limits, t.seeded) for t in found.repeated] == [(True, False)] * 2
    assert [len(t.rows) for t in found.repeated] == [20, 20] and len(found.searched.rows) == 16
    assert [(t.limits, t.seeded, len(t.rows)) for t in found.unreachable] == [(True, False, 12)] * 2
    asked = {(seeded, limits) for _, _, seeded, limits in runner.calls}
    assert asked == {(False, True), (False, False), (True, True), (True, False)}
    assert runner.calls.count((20, False, False, True)) == 2  # the same, and both are asked
    assert runner.batches == [(40, False)] and not any(free for _, free, *_ in runner.calls)
    assert len(found.reachable) == 11 and len(found.standing) == 9
    standing = [any(t is one for t in found.standing) for one in found.outside]
    assert standing == [False, True]


def test_poses_with_rows_are_solved_in_a_batch_where_there_is_one() -> None:
    values = collect_answers(Asked(), arm(), 40, 0).unlimited.rows.q[:, 0, 0]
    assert set(values[::2]) == {0.5} and set(values[1::4]) == {0.25}  # of those alone every other
    assert np.isnan(values[3::4]).all()
    for batch in ("none", "raises"):
        runner = Asked(batch)
        values = collect_answers(runner, arm(), 40, 0).unlimited.rows.q[:, 0, 0]
        assert set(values[::2]) == {0.25} and (40, False, False, False) in runner.calls


@pytest.mark.parametrize("task", ["direction", "rotation"])
def test_tasks_that_reach_everywhere_have_no_poses_out_of_reach(task: str) -> None:
    oracle = six_axis_oracle()
    bounds = oracle.lower, oracle.upper
    found = collect_answers(Asked(), arm_under_test(oracle, TASK_SPACES[task], bounds, ()), 40, 0)
    assert not found.unreachable and len(found.limited.rows) == 40


def test_what_is_held_is_handed_over() -> None:
    runner = Asked()
    collect_answers(runner, arm(("j3",)), 20, 0)
    assert all(free for _, free, *_ in runner.calls)


@pytest.mark.parametrize(
    ("free", "angle", "fits"),
    [
        ((), None, True), (("j1",), None, True), (JOINTS, None, True), (("other",), None, False),
        ((ARM_ANGLE_IDENTIFIER,), None, False), ((ARM_ANGLE_IDENTIFIER,), object(), True),
        ((*JOINTS, ARM_ANGLE_IDENTIFIER), object(), True),
    ],
)  # fmt: skip
def test_a_module_fits_the_chain_if_it_holds_what_there_is(
    free: tuple[str, ...], angle: object, fits: bool
) -> None:
    def told(**other: object) -> tuple[CheckResult, ...]:
        values = {
            "joint_names": JOINTS,
            "lower": np.zeros(6),
            "upper": np.ones(6),
            "free_joints": free,
        }
        runner = SimpleNamespace(constants=SimpleNamespace(**values | other))
        return _mismatch(runner, SimpleNamespace(joint_names=JOINTS), angle)

    found = told()
    assert (found == ()) == fits
    if not fits:
        assert found[0].detail == "limits of a wrong shape, or free joints that are no joints"
    for wrong in ({"lower": np.zeros(5)}, {"upper": np.zeros(5)}, {"lower": 0.0 * np.eye(6)}):
        assert [(one.name, one.passed) for one in told(**wrong)] == [("constants", False)]
    (short,) = told(joint_names=JOINTS[:5])
    assert short.detail.startswith("joints j1, j2, j3, j4, j5 instead of j1, ")


def test_progress_is_told_before_each_check(monkeypatch: pytest.MonkeyPatch) -> None:
    told: list[tuple[str, int, int]] = []
    trial = SimpleNamespace(rows=SimpleNamespace(count=np.array([4, 8, 8, 2])))
    answers = SimpleNamespace(unlimited=trial, standing=())
    arm = SimpleNamespace(held=("one",))
    default = SimpleNamespace(count=np.array([0, 1, 2, 0, 4]))

    def fails() -> CheckResult:
        raise ArithmeticError("no")

    plan = {"one": lambda: CheckResult("one", True, 3), "two": fails}
    monkeypatch.setattr(verification, "collect_answers", lambda *_: answers)
    monkeypatch.setattr(
        verification.completeness, "survey", lambda *_: SimpleNamespace(bands=("band",))
    )
    monkeypatch.setattr(verification, "_plan", lambda *_: plan)
    monkeypatch.setattr(verification, "_by_default", lambda *_: default)
    found = _run_checks(None, arm, 4, 0, None, lambda *step: told.append(step))
    assert told == [("solving", 0, 1), ("one", 1, 3), ("two", 2, 3)]
    assert [(r.name, r.passed, r.count, r.detail) for r in found.results] == [
        ("one", True, 3, ""), ("two", False, 1, "ArithmeticError: no")
    ]  # fmt: skip
    assert found.histogram == ((2, 1), (4, 1), (8, 2)) and found.bands == ("band",)
    assert found.by_default == (3, 5)
    monkeypatch.setattr(verification, "collect_answers", lambda *_: fails())
    (only,) = _run_checks(None, arm, 4, 0, None, None).results
    assert (only.name, only.passed) == ("runs", False)
    assert only.detail == "solve raises ArithmeticError: no"
