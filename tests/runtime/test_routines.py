"""Every routine that a Program calls exists in both languages."""

from __future__ import annotations

import pytest
from tests.support.routines import TEMPLATES

from ikgen.runtime.python.general_6r import general_6r
from ikgen.runtime.python.trig_quartic_roots import trig_quartic


@pytest.mark.parametrize("routine", [trig_quartic, general_6r])
def test_every_routine_has_both_languages(routine: object) -> None:
    name = getattr(routine, "__name__", "")
    assert name in (TEMPLATES / "cpp" / "routines" / f"{name}.hpp.jinja").read_text()
