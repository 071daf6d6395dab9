"""Every routine that a Program calls exists in both languages."""

from __future__ import annotations

import pytest

from ikgen.emit.cpp.header_bundle import bundle
from ikgen.runtime.python.elimination.coupled_angle import CoupledAngle
from ikgen.runtime.python.elimination.coupled_both import CoupledBothAngle
from ikgen.runtime.python.elimination.coupled_shared import CoupledSharedAngle
from ikgen.runtime.python.elimination.general_6r import candidates
from ikgen.runtime.python.elimination.one_slide import one_slide_candidates
from ikgen.runtime.python.elimination.three_slides import three_slide_candidates
from ikgen.runtime.python.elimination.two_slides import two_slide_candidates
from ikgen.runtime.python.roots.trig_quartic_roots import (
    trig_quartic_branches,
    trig_quartic_wide_branches,
)

ROUTINES = {
    "trig_quartic": (trig_quartic_branches, "roots/trig_quartic.hpp", "int trig_quartic_branches("),
    "trig_quartic_wide": (
        trig_quartic_wide_branches,
        "roots/trig_quartic_wide.hpp",
        "int trig_quartic_wide_branches(",
    ),
    "general_6r": (candidates, "elimination/general_6r_arm.hpp", "struct General6r"),
    "one_slide": (one_slide_candidates, "elimination/one_slide.hpp", "struct OneSlide"),
    "two_slides": (two_slide_candidates, "elimination/two_slides.hpp", "struct TwoSlides"),
    "coupled_6r": (CoupledAngle(()), "elimination/coupled_6r.hpp", "struct Coupled6r"),
    "coupled_both": (CoupledBothAngle(()), "elimination/coupled_both.hpp", "struct CoupledBoth"),
    "coupled_shared": (
        CoupledSharedAngle(()),
        "elimination/coupled_shared.hpp",
        "struct CoupledShared",
    ),
    "three_slides": (three_slide_candidates, "elimination/three_slides.hpp", "struct ThreeSlides"),
}


@pytest.mark.parametrize("name", ROUTINES)
def test_every_routine_has_both_languages(name: str) -> None:
    function, header, definition = ROUTINES[name]
    assert callable(function)
    assert definition in bundle([header]).body
