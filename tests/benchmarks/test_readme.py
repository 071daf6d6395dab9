"""The figures of the README are those that were recorded, and stand where they belong."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest
from benchmarks.readme import (
    BLOCKS,
    COMPARISON,
    HOME,
    PAGE,
    PAGES,
    PICTURE,
    MarkError,
    drawn,
    filled_in,
)
from benchmarks.results import Measured, read_result

from ikgen.cli.main import COMMANDS

TEXT = PAGE.read_text(encoding="utf-8")
START, END = "<!-- figures: corpus -->\n", "<!-- end of figures -->\n"


def test_figures_are_those_recorded() -> None:
    for page, names in PAGES.items():
        text = page.read_text(encoding="utf-8")
        assert filled_in(text, names) == text, "run python -m benchmarks.readme"
    assert drawn() == PICTURE.read_text(encoding="utf-8"), "run python -m benchmarks.readme"
    assert drawn(arm="UR5e") == HOME.read_text(encoding="utf-8"), "run python -m benchmarks.readme"


def block(page: Path, name: str) -> str:
    """What is between the marks of a block."""
    text = page.read_text(encoding="utf-8")
    return text.partition(f"<!-- figures: {name} -->\n")[2].partition(END)[0]


def test_the_comparison_shows_the_same_figures() -> None:
    assert block(COMPARISON, "peers") == block(PAGE, "peers")
    assert "| opw_kinematics, C++ (-O3) |" in block(PAGE, "peers")
    assert "| Pinocchio CLIK (one row) |" in block(COMPARISON, "answers")


def test_another_record_changes_its_block_alone() -> None:
    def later(name: str) -> Measured:
        measured = read_result(name)
        return replace(measured, date="2099-01-01") if name == "corpus" else measured

    new = filled_in(TEXT, PAGES[PAGE], later)
    assert new != TEXT
    before, _, rest = TEXT.partition(START)
    _, _, after = rest.partition(END)
    assert new.startswith(before + START) and new.endswith(END + after)


def test_what_is_not_recorded_is_replaced() -> None:
    assert filled_in(TEXT.replace("| SCARA | 3 | 3 |", "| SCARA | 4 | 4 |"), PAGES[PAGE]) == TEXT


@pytest.mark.parametrize(
    "broken",
    [
        TEXT.replace(END, "", 1),
        TEXT.replace(START, "", 1),
        TEXT.replace(START, START + START, 1),
        TEXT.replace(START, START.replace("corpus", "weather"), 1),
        TEXT.replace(START, END + START, 1).replace(END, "", 1) + END,
    ],
    ids=["no end", "no start", "twice", "unknown", "end of another"],
)
def test_marks_out_of_order_are_refused(broken: str) -> None:
    with pytest.raises(MarkError):
        filled_in(broken, PAGES[PAGE])


def test_every_block_says_commit_and_date() -> None:
    shown = [(page, name) for page, names in PAGES.items() for name in names]
    assert {name for _, name in shown} == set(BLOCKS)
    for page, name in shown:
        if name == "batch":  # a sentence that leads to where that stands
            continue
        assert re.search(r"Measured at `[0-9a-f]{7}\+?` on \d{4}-\d\d-\d\d", block(page, name))


def test_the_table_of_commands_has_a_row_for_each() -> None:
    section = TEXT.partition("## Commands\n")[2].partition("\n\nA 7-joint")[0]
    rows = re.findall(r"^\| `ikgen (\S+?)(?: [^`|]*(?:\\\|[^`|]*)*)?` \| (.+) \|$", section, re.M)
    assert [name for name, _ in rows] == list(COMMANDS)
    assert all("|" not in words for _, words in rows)
    assert len(rows) + 2 == section.count("\n")
