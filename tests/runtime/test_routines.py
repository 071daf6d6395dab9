"""Every routine that a Program calls exists in both languages."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from ikgen.emit.cpp.header_bundle import RUNTIME
from ikgen.runtime.python.general_6r import general_6r
from ikgen.runtime.python.trig_quartic_roots import trig_quartic


@pytest.mark.parametrize("routine", [trig_quartic, general_6r])
def test_every_routine_has_both_languages(routine: Callable[..., object]) -> None:
    name = routine.__name__
    assert f" {name}(" in (RUNTIME / f"{name}.hpp").read_text()
