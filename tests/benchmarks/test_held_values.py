"""The benchmark of intervals and searches tells what failed."""

from __future__ import annotations

from benchmarks.held_values import line, parsed

RIGHT = "90.5 140.0 80.0 95.5 81.0 96.5 300.0 900.0\n40 0 0\n60 0\n"
WRONG = "90.5 140.0 80.0 95.5 81.0 96.5 300.0 900.0\n40 1 2\n60 3\n0 4 0.25\n1 5 0.5\n"


def test_failures_are_counted_and_shown() -> None:
    right, wrong = parsed(RIGHT), parsed(WRONG)
    assert right.failures == 0 and right.cases == ()
    assert wrong.failures == 6 and wrong.cases == ("0 4 0.25", "1 5 0.5")
    assert (wrong.intervals, wrong.missed, wrong.off, wrong.searches, wrong.worse) == (
        40,
        1,
        2,
        60,
        3,
    )


def test_lines_say_which_closed_form_it_is() -> None:
    found = parsed(RIGHT)
    assert " rules " in line("arm", {"chosen": {"held": ["a"]}}, found)
    answer = {"chosen": {"held": ["a"], "why": "the general 6R elimination"}}
    assert " elimination " in line("arm", answer, found)
