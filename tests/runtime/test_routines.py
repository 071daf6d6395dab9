"""Every routine that a Program calls exists in both languages."""

from __future__ import annotations

import pytest

from ikgen.emit.cpp.header_bundle import bundle
from ikgen.runtime.python.elimination_rows import elimination_branches
from ikgen.runtime.python.trig_quartic_roots import trig_quartic_branches

ROUTINES = {
    "trig_quartic": (trig_quartic_branches, "trig_quartic.hpp", "int trig_quartic_branches("),
    "general_6r": (elimination_branches, "general_6r_arm.hpp", "struct General6r"),
}


@pytest.mark.parametrize("name", ROUTINES)
def test_every_routine_has_both_languages(name: str) -> None:
    function, header, definition = ROUTINES[name]
    assert callable(function)
    assert definition in bundle([header]).body
