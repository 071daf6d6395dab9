"""Every routine that a Program calls exists in both languages."""

from __future__ import annotations

import pytest
from tests.support.routines import TEMPLATES, python_routine


@pytest.mark.parametrize("name", ["trig_quartic", "general_6r"])
def test_every_routine_has_both_languages(name: str) -> None:
    assert callable(getattr(python_routine(name), name))
    assert name in (TEMPLATES / "cpp" / "routines" / f"{name}.hpp.jinja").read_text()
