"""The arguments `free` and `seed` as joint values: what does, and what is said of what does not."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from ikgen.runtime.python.arguments.joint_arguments import held_rows, held_values, seed_rows
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.angles import WHOLE_TURN


def arm(*held: str) -> Arm:
    """Three joints, of which some are held."""
    names = ("a", "b", "c")
    free = tuple(names.index(name) for name in held)
    parts: dict[str, Any] = {"free": free, "free_joints": held, "free_defaults": (0.5,) * len(held)}
    parts["angle"] = None
    return cast(Arm, SimpleNamespace(**parts, placing=(WHOLE_TURN,) * 3, lower=(0.0,) * 3))


@pytest.mark.parametrize("free", [0.25, [0.25], (0.25,), np.array([0.25]), {"b": 0.25}])
def test_the_value_of_one_held_joint(free: Any) -> None:
    assert held_values(arm("b"), free, None) == (0.25,)


def test_defaults_and_seeds() -> None:
    assert held_values(arm("b"), None, None) == (0.5,)
    assert held_values(arm("b"), None, (1.0, 2.0, 3.0)) == (2.0,)
    assert held_values(arm("a", "b"), {"a": 7.0}, (1.0, 2.0, 3.0)) == (7.0, 2.0)


@pytest.mark.parametrize(
    ("free", "words"),
    [
        (0.25, "1 value, expected 2"),
        ([[0.1, 0.2]], r"shape \(1, 2\), expected \(2,\)"),
        ([0.1, np.nan], "not finite"),
        ({"z": 1.0}, "no free joint named"),
        ([1j, 0.0], "complex"),
    ],
)
def test_what_is_no_value(free: Any, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        held_values(arm("a", "b"), free, None)


def test_values_for_many_poses() -> None:
    one, each = held_rows(arm("b"), 0.1, None, 3), held_rows(arm("b"), [0.1, 0.2, 0.3], None, 3)
    assert one.tolist() == [[0.1]] * 3 and each.tolist() == [[0.1], [0.2], [0.3]]
    assert held_rows(arm("a", "b"), [0.1, 0.2], None, 2).tolist() == [[0.1, 0.2]] * 2


def test_the_seed_has_the_name_of_the_argument() -> None:
    with pytest.raises(ValueError, match=r"start has shape \(2,\), expected \(3,\)"):
        seed_rows(arm(), [1.0, 2.0], (3,), name="start")


def test_turns_that_doubles_cannot_tell_are_left_out_of_seeds() -> None:
    """By whole ones, where a joint turns and its value is more than a million."""
    turn = 2.0 * np.pi
    seed = [1e6 - 1.0, 0.25 + turn * 2.0**20, -0.25 - turn * 2.0**20]
    found = seed_rows(arm(), seed, (3,))
    assert found[0] == seed[0]
    np.testing.assert_allclose(found[1:], [0.25, -0.25], atol=1e-8)
    slides = cast(Arm, SimpleNamespace(placing=(0.0,) * 3, lower=(0.0,) * 3))
    np.testing.assert_array_equal(seed_rows(slides, seed, (3,)), seed)
