"""The suite's rows, and the paper's tables beside them."""

from __future__ import annotations

import pytest
from benchmarks.paper_tables import CHOSEN, RESULTS, comparison, listed
from benchmarks.suite import TABLES, main, try_robot


def test_the_papers_list_is_known() -> None:
    assert set(CHOSEN) <= listed() and len(listed()) == 21
    assert sum(robots for robots, _ in RESULTS.values()) == 19
    assert sum(solved for _, solved in RESULTS.values()) == 18


def test_robots_stand_beside_the_papers(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["--robot", "Olson13", "--poses", "20", "--searched", "1", "--starts", "40"]) == 0
    printed = capsys.readouterr().out
    assert "1 robots: 1 solved; 0 rows wrong, 0 missed" in printed
    row = next(line for line in printed.splitlines() if line.split()[:3] == ["6", "5", "4"])
    assert row.split()[3:5] == ["1", "1"]
    assert "paper: theta_3 (tangent), theta_4 (sine or cosine)" in printed
    assert "ikgen: theta_3 (tangent), " in printed


def test_arms_with_five_joints_take_a_pose_as_in_the_paper_or_what_they_can_do_everywhere() -> None:
    asked = try_robot(TABLES / "Chair_Helper.toml", 5, 1, 20)
    chosen = try_robot(TABLES / "Chair_Helper.toml", 5, 1, 20, None)
    assert asked.state == chosen.state == "solved"
    assert asked.most < chosen.most  # solutions of a position and a direction
    assert asked.leaves and not chosen.leaves  # the second by elimination


def test_what_is_not_solved_is_no_time() -> None:
    trial = try_robot(TABLES / "Olson13.toml", 5, 1, 20)
    lines = list(comparison([("Olson13", 6, None, ()), ("Minder13", 4, 0.5, trial.order)]))
    assert lines[2].split() == ["4", "4", "4", "1", "1", "0.50"]
    assert lines[4].split() == ["6", "5", "4", "1", "0", "-"]
    assert len(lines) == 5
