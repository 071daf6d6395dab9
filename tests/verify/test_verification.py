"""A right module passes every check; each wrong one is caught by the check made for it."""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.support.fake_arms import DEFECTS, JOINTS, six_axis_module, six_axis_oracle
from tests.support.sampled import sampled

from ikgen.errors import BadDescriptionError, UnknownNameError
from ikgen.verify.runners.python_module import PythonModule
from ikgen.verify.search import find_solutions
from ikgen.verify.shared_work import SharedWork
from ikgen.verify.verification import verify


def test_right_module_passes(tmp_path: Path) -> None:
    runner, oracle = six_axis_module(tmp_path), six_axis_oracle()
    report = verify(runner, oracle, samples=300)
    assert report.passed, report.worst_case
    assert max(report.worst_closure) < 1e-9
    assert report.solutions[2] == 8
    idle = {check.name for check in report.checks if check.count == 0}
    assert idle == {"free joints"}
    assert report.check("exhaustive search").count >= 16 * 4
    json.dumps(report.to_dict(), allow_nan=False)


def test_equal_runs_give_equal_reports(tmp_path: Path) -> None:
    runner, oracle = six_axis_module(tmp_path), six_axis_oracle()
    first, second = (verify(runner, oracle, samples=60, seed=5).to_dict() for _ in range(2))
    assert first == second
    assert verify(runner, oracle, samples=60, seed=6).to_dict() != first


def test_languages_share_what_is_none_of_theirs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    runner, oracle = six_axis_module(tmp_path), six_axis_oracle()
    searches: list[int] = []

    def counted(*arguments: Any) -> Any:
        searches.append(1)
        return find_solutions(*arguments)

    monkeypatch.setattr("ikgen.verify.coverage.find_solutions", counted)
    alone = verify(runner, oracle, samples=60).to_dict()
    shared = SharedWork()
    both = [verify(runner, oracle, samples=60, shared=shared).to_dict() for _ in range(2)]
    assert both == [alone, alone] and len(searches) == 2


@pytest.fixture(scope="module")
def of_the_arm() -> SharedWork:
    """What verifications of the arm with 60 samples have in common, whatever is wrong with the module."""
    return SharedWork()


@pytest.mark.parametrize("defect", DEFECTS)
def test_defect_is_caught_by_its_check(tmp_path: Path, defect: str, of_the_arm: SharedWork) -> None:
    runner = six_axis_module(tmp_path, defect)
    report = verify(runner, six_axis_oracle(), samples=60, shared=of_the_arm)
    assert not report.passed
    assert not report.check(DEFECTS[defect][0]).passed, [c.name for c in report.failed]
    assert report.worst_case


def test_other_geometry_says_by_how_much(tmp_path: Path) -> None:
    report = verify(six_axis_module(tmp_path, "forward off"), six_axis_oracle(), samples=50)
    assert report.worst_closure[0] == pytest.approx(1e-4, rel=0.01)


def test_module_of_another_chain(tmp_path: Path) -> None:
    oracle = six_axis_oracle()
    oracle.joint_names = JOINTS[:5]
    report = verify(six_axis_module(tmp_path), oracle)
    assert [check.name for check in report.failed] == ["constants"]


def test_progress_and_unknown_task(tmp_path: Path) -> None:
    seen: list[tuple[str, int, int]] = []
    runner, oracle = six_axis_module(tmp_path), six_axis_oracle()
    verify(runner, oracle, samples=20, progress=lambda *step: seen.append(step))
    assert seen[0][0] == "solving"
    assert [done for _, done, _ in seen] == list(range(len(seen)))
    assert {total for _, _, total in seen[1:]} == {len(seen)}
    with pytest.raises(UnknownNameError):
        verify(runner, oracle, task="posture")


@pytest.mark.long
def test_checks_take_little_time(tmp_path: Path) -> None:
    runner, oracle = six_axis_module(tmp_path), six_axis_oracle()
    start = time.process_time()
    runner.solve_many(oracle.forward(np.zeros((100, 6))))
    per_pose = (time.process_time() - start) / 100
    start = time.process_time()
    verify(runner, oracle, samples=1000)
    assert time.process_time() - start - 6000 * per_pose < 4.0


def test_bad_module_files(tmp_path: Path) -> None:
    with pytest.raises(BadDescriptionError, match="no such"):
        PythonModule(tmp_path / "absent_ik.py")
    path = tmp_path / "broken_ik.py"
    path.write_text("x = 1 / 0")
    with pytest.raises(BadDescriptionError, match="ZeroDivisionError"):
        PythonModule(path)
    path.write_text("DOF = 6")
    with pytest.raises(BadDescriptionError, match="JOINT_NAMES"):
        PythonModule(path)


def test_languages_that_agree(tmp_path: Path) -> None:
    runner, other = six_axis_module(tmp_path), six_axis_module(tmp_path)
    report = verify(runner, six_axis_oracle(), samples=60, peer=other)
    assert report.passed and report.checks[-1].name == "agreement with python"
    assert report.checks[-1].count > 50


def test_what_a_language_answered_when_it_was_verified_is_not_asked_again(tmp_path: Path) -> None:
    first, second = six_axis_module(tmp_path), six_axis_module(tmp_path)
    shared, oracle = SharedWork(), six_axis_oracle()
    verify(first, oracle, samples=60, shared=shared)
    first.solve_many = first.solve_batch = None  # type: ignore[assignment]
    assert verify(second, oracle, samples=60, peer=first, shared=shared).passed


@pytest.mark.parametrize(
    "defect", sampled(["missing branch", "duplicate row", "swapped joints"], ["swapped joints"])
)
def test_languages_that_do_not_agree(tmp_path: Path, defect: str) -> None:
    (tmp_path / "other").mkdir()
    runner, other = six_axis_module(tmp_path), six_axis_module(tmp_path / "other", defect)
    report = verify(runner, six_axis_oracle(), samples=60, peer=other)
    assert [check.name for check in report.failed] == ["agreement with python"]
    assert report.worst_case
