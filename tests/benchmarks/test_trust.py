"""The figures of the pages on trust and on tests are those that were recorded."""

from __future__ import annotations

from pathlib import Path

import pytest
from benchmarks.trust import PAGES, filled_in


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_figures_are_those_recorded(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert filled_in(page, text) == text, "run python -m benchmarks.trust --fill"
