"""The figures of the page on trust are those that were recorded."""

from __future__ import annotations

from benchmarks.trust import PAGE, filled_in


def test_figures_are_those_recorded() -> None:
    text = PAGE.read_text(encoding="utf-8")
    assert filled_in(text) == text, "run python -m benchmarks.trust --fill"
