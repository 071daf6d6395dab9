"""Every routine that a Program calls exists in both languages."""

from __future__ import annotations

import pytest

from ikgen.emit.cpp.header_bundle import bundle
from ikgen.runtime.python.coupled_angle import CoupledAngle
from ikgen.runtime.python.general_6r import candidates
from ikgen.runtime.python.one_slide import one_slide_candidates
from ikgen.runtime.python.three_slides import three_slide_candidates
from ikgen.runtime.python.trig_quartic_roots import (
    trig_quartic_branches,
    trig_quartic_wide_branches,
)
from ikgen.runtime.python.two_slides import two_slide_candidates

ROUTINES = {
    "trig_quartic": (trig_quartic_branches, "trig_quartic.hpp", "int trig_quartic_branches("),
    "trig_quartic_wide": (
        trig_quartic_wide_branches,
        "trig_quartic_wide.hpp",
        "int trig_quartic_wide_branches(",
    ),
    "general_6r": (candidates, "general_6r_arm.hpp", "struct General6r"),
    "one_slide": (one_slide_candidates, "one_slide.hpp", "struct OneSlide"),
    "two_slides": (two_slide_candidates, "two_slides.hpp", "struct TwoSlides"),
    "coupled_6r": (CoupledAngle(()), "coupled_6r.hpp", "struct Coupled6r"),
    "three_slides": (three_slide_candidates, "three_slides.hpp", "struct ThreeSlides"),
}


@pytest.mark.parametrize("name", ROUTINES)
def test_every_routine_has_both_languages(name: str) -> None:
    function, header, definition = ROUTINES[name]
    assert callable(function)
    assert definition in bundle([header]).body
