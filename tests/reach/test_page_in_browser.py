"""The page of a map fits a phone, is quiet, and has nothing that axe-core calls serious."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.reach.test_stored_map import small
from tests.support.browser import browser, look_at

from ikgen.reach.slices_page import slices_page


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_the_page_of_a_map(scheme: str, tmp_path: Path) -> None:
    page = tmp_path / "reach.html"
    page.write_text(slices_page(small(), "ikgen reach scara.toml --cells 6"), encoding="utf-8")
    with browser() as opened:
        for width in (390, 1250):
            seen = look_at(opened, page.as_uri(), width, scheme)
            assert seen.seconds < 1.0
            assert (seen.sticks_out, seen.messages, seen.faults) == ((), (), ())
