"""The benchmark of intervals and searches tells what failed."""

from __future__ import annotations

from dataclasses import replace

from benchmarks.held_values import figures, form_of, line, parsed

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
    assert " rules " in line("arm", form_of({"chosen": {"held": ["a"]}}), found)
    answer: dict[str, object] = {"chosen": {"held": ["a"], "why": "the general 6R elimination"}}
    assert " elimination " in line("arm", form_of(answer), found)


def test_figures_are_summed_by_closed_form() -> None:
    arms = [replace(parsed(text), form="rules") for text in (RIGHT, WRONG)]
    (row,) = figures(arms)
    counts = [row[key] for key in ("arms", "intervals", "missed", "off", "searches", "worse")]
    assert counts == [2, 80, 1, 2, 120, 3]
    assert (row["motion"], row["motion_most"], row["search"], row["search_most"]) == (
        90.5, 140.0, 300.0, 900.0,
    )  # fmt: skip
