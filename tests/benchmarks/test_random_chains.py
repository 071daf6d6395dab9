"""The benchmark of random chains goes on where it was stopped, and counts what it did."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from benchmarks.drawn_chains import ELIMINATION, NEITHER, RULES, Outcome, _checked
from benchmarks.random_chains import Log, drawn_class, main, tables, totals
from benchmarks.random_tables import Drawn, pattern
from numpy.typing import NDArray
from tests.support.tables import table

from ikgen.equations.probes import dh_pose

FEW = ("--done", "--class", "3-6", "--count", "6")
GOOD = Outcome("R|aR|aR", 3, RULES, "", False, 0, 0, 0, 0, 1.5, "abc1234")
BY_SEARCH = replace(GOOD, way=ELIMINATION, searched=20, equal=20, seconds=0.5)


def test_a_class_is_told_by_its_name() -> None:
    assert drawn_class("3-6") == Drawn(3, 6)
    assert drawn_class("6R") == Drawn(6, 6, 0, any_angle=True)
    assert drawn_class("4R2P") == Drawn(6, 6, 2, any_angle=True)
    with pytest.raises(ValueError, match="3-6 or 5R1P"):
        drawn_class("sixR")
    with pytest.raises(SystemExit):
        main(["--class", "sixR"])


def test_later_tables_are_those_of_one_drawing() -> None:
    every = [(number, pattern(dh)) for number, dh in tables(drawn_class("3-6"), 0, 0, 6)]
    assert [(number, pattern(dh)) for number, dh in tables(drawn_class("3-6"), 0, 4, 2)] == every[
        4:
    ]


def test_a_log_has_the_last_outcome_of_each_table(tmp_path: Path) -> None:
    path = tmp_path / "random.log"
    log = Log(path)
    log.add(("3-6", 0, 7), replace(GOOD, way=NEITHER))
    log.add(("6R", 0, 7), BY_SEARCH)
    log.add(("3-6", 0, 7), GOOD)
    assert Log(path).found == {("3-6", 0, 7): GOOD, ("6R", 0, 7): BY_SEARCH}


@pytest.mark.parametrize(
    "bad",
    [
        replace(GOOD, way=NEITHER),
        replace(GOOD, refused=True),
        replace(GOOD, wrong=1),
        replace(GOOD, missed=1),
        replace(BY_SEARCH, equal=19),
    ],
)
def test_what_failed_is_told_and_counted(bad: Outcome, tmp_path: Path) -> None:
    path = tmp_path / "random.log"
    log = Log(path)
    log.add(("3-6", 0, 3), GOOD)
    assert GOOD.good and BY_SEARCH.good and not bad.good
    assert main([*FEW, "--log", str(path)]) == 0
    log.add(("3-6", 0, 5), bad)
    assert main([*FEW, "--log", str(path)]) == 1


def test_figures_of_a_class() -> None:
    row = totals("6R", [GOOD, BY_SEARCH, replace(GOOD, refused=True, missed=2)])
    assert (row["tables"], row["solved"], row["by_rules"], row["by_elimination"]) == (3, 2, 2, 1)
    assert (row["missed"], row["searched"], row["equal"], row["median"]) == (2, 20, 20, 1.5)


def test_joints_are_held_where_the_configuration_has_them() -> None:
    """What answers a position alone with a joint held has those rows that the held value leaves."""
    dh = table(
        ("R", "0", 0.0, 0.3), ("R", "1", 0.4, 0.0), ("R", "0", 0.3, 0.1), ("P", "1", 0.2, 0.0)
    )
    asked: list[float] = []

    def solve(pose: NDArray[Any], *, free: NDArray[Any] | None, limits: bool) -> SimpleNamespace:
        assert free is not None and not limits
        asked.append(float(free[0]))
        near = next(q for q in known if np.allclose(dh_pose(dh, q[None])[0], pose))
        assert near[3] == free[0]
        return SimpleNamespace(q=near[None])

    known = np.random.default_rng(3).uniform(-2.5, 2.5, (20, 4))
    module: Any = SimpleNamespace(
        TASK="position", TOOL_AXIS=None, FREE_JOINTS=("slide",), solve=solve,
        JOINT_NAMES=("one", "two", "three", "slide"), LOWER=np.zeros(4), UPPER=np.zeros(4),
        forward=lambda rows: dh_pose(dh, rows), jacobian=lambda q: np.diag([0, 0, 0, 1, 1, 1])[:, 2:],
    )  # fmt: skip
    assert _checked(dh, module, 20, np.random.default_rng(3)) == (0, 0)
    assert len(set(asked)) == len(asked) > 10
