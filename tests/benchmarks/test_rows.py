"""Two records of emitted modules: what counts as the same, and what does not."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from benchmarks.row_comparison import compare, same_to
from benchmarks.row_record import ArmRecord, load, save

from benchmarks import rows

Q = np.array([[0.1, 0.2, 1.0], [0.4, -3.1, 2.0], [1.0, 1.1, 4.0]])


@pytest.fixture(scope="module")
def puma(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A record of one table."""
    path = tmp_path_factory.mktemp("rows") / "puma.npz"
    wanted = ["record", str(path), "--collection", "suite", "--arm", "Puma", "--poses", "12"]
    assert rows.main(wanted) == 0
    return path


def record(
    q: np.ndarray = Q, sigma: float = 0.1, flagged: bool = False, **facts: object
) -> ArmRecord:
    """Two poses, the first with two rows; two joints turn, the third slides."""
    data = {
        "q": np.zeros((2, 3)), "poses": np.stack([np.eye(4)] * 2), "rows": q,
        "count": np.array([len(q) - 1, 1]), "status": np.zeros(2, int), "inside": np.ones(2, int),
        "inside_status": np.zeros(2, int), "singular": np.full(len(q), flagged),
        "sigma": np.full(len(q), sigma), "turning": np.array([True, True, False]),
    }  # fmt: skip
    return ArmRecord("corpus/some", "some", {"code": 0, **facts}, data)


def test_order_and_whole_turns_do_not_count() -> None:
    turned = Q[[1, 0, 2]] + np.array([2 * np.pi, -2 * np.pi, 0.0])
    assert compare(record(), record(turned)).same


def test_a_slide_has_no_turns() -> None:
    assert compare(record(), record(Q + np.array([0.0, 0.0, 2 * np.pi]))).lost == 3


def test_rows_are_taken_as_the_same_once_each() -> None:
    found = compare(record(), record(Q[[0, 0, 2]]))
    assert (found.lost, found.gained, found.poses, found.regular) == (1, 1, 1, 1)


def test_a_row_more_or_less_is_seen() -> None:
    found = compare(record(), record(Q[1:]))
    assert (found.lost, found.gained, found.poses) == (1, 0, 1)
    assert compare(record(Q[1:]), record()).gained == 1


@pytest.mark.parametrize(("sigma", "shift", "same"), [
    (0.1, 5e-10, True), (0.1, 1e-8, False), (1e-7, 5e-8, True), (1e-7, 1e-6, False), (0.0, 1e-6, False),
])  # fmt: skip
def test_the_tolerance_follows_the_singular_value(sigma: float, shift: float, same: bool) -> None:
    assert compare(record(sigma=sigma), record(Q + shift, sigma=sigma)).same is same


def test_the_tolerance_is_bounded() -> None:
    assert same_to(np.array([0.0]))[0] < 1e-6


def test_flagged_rows_count_by_their_number() -> None:
    assert compare(record(flagged=True), record(Q + 0.5, flagged=True)).same
    assert not compare(record(flagged=True), record(Q[1:], flagged=True)).same


def test_statuses_count() -> None:
    other = record()
    other.data["inside_status"][1] = 2
    assert compare(record(), other).statuses == 1


def test_an_arm_that_is_no_longer_solved_is_a_difference() -> None:
    gone = ArmRecord("corpus/some", "some", {"code": 3})
    assert not compare(record(), gone).same
    assert compare(gone, replace(gone)).same
    assert compare(gone, record()).same and compare(gone, record()).note


def test_recorded_and_compared(
    puma: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    one = load(puma)["suite/Puma"]
    assert one.data["poses"].shape == (12, 4, 4)
    assert one.data["count"].sum() == len(one.data["rows"]) >= 12
    assert one.facts["closure"] < 1e-9
    again = tmp_path / "again.npz"
    assert rows.main(["record", str(again), "--poses-of", str(puma)]) == 0
    capsys.readouterr()
    assert rows.main(["compare", str(puma), str(again)]) == 0
    assert "1 of 1 arms the same" in capsys.readouterr().out


def test_the_command_ends_with_1_where_rows_differ(
    puma: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    one = load(puma)["suite/Puma"]
    one.data["rows"][3, 2] += 1e-6
    save(tmp_path / "other.npz", [one], {})
    assert rows.main(["compare", str(puma), str(tmp_path / "other.npz")]) == 1
    assert "suite/Puma" in capsys.readouterr().out
