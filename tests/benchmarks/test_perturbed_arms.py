"""Robots whose files have other numbers."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
from benchmarks.perturbed_arms import CHANGES, Change, changed_arm, drawn, perturbed
from tests.support.solving import FIXTURES

TEXT = (FIXTURES / "ur5e.urdf").read_text()


def numbers(text: str, name: str) -> list[float]:
    return [float(x) for group in re.findall(rf'{name}="([^"]*)"', text) for x in group.split()]


def changed(change: Change) -> str:
    return perturbed(TEXT, "tool0", change, np.random.default_rng(1))


def test_a_change_of_nothing_leaves_the_numbers() -> None:
    assert numbers(changed(Change()), "rpy") == numbers(TEXT, "rpy")
    assert numbers(changed(Change()), "xyz") == numbers(TEXT, "xyz")


def test_turns_are_rounded_and_origins_moved_by_no_more() -> None:
    rounded = numbers(changed(CHANGES["2 digits"]), "rpy")
    assert {1.57, 1.570796327} & set(rounded) == {1.57}
    moved = np.subtract(numbers(changed(CHANGES["moved 1e-04 m"]), "xyz"), numbers(TEXT, "xyz"))
    assert 5e-5 < np.abs(moved).max() <= 1e-4
    one = np.subtract(
        numbers(changed(CHANGES["one turned 1e-03 rad"]), "rpy"), numbers(TEXT, "rpy")
    )
    assert np.count_nonzero(np.abs(one) > 1e-12) == 3


def test_axes_are_turned_round() -> None:
    axes = re.findall(r'<axis xyz="([^"]*)"', changed(CHANGES["axes turned round"]))
    assert {x for axis in axes for x in map(float, axis.split())} == {-1.0, 0.0, 1.0}


def test_the_same_seed_draws_the_same() -> None:
    (arm, name, random), (again, other, same) = drawn(3, 4), drawn(3, 4)
    assert (arm, name) == (again, other)
    assert random.random() == same.random()
    assert len({drawn(3, n)[1] for n in range(30)}) > 5


def test_a_changed_arm_is_a_file_of_its_own(tmp_path: Path) -> None:
    arm, name = changed_arm(4, tmp_path, 3, "")
    assert (name, arm.links) == (drawn(3, 4)[1], drawn(3, 4)[0].links)
    assert arm.file is not None and arm.file.parent == tmp_path and arm.file.is_file()
