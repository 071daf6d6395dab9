"""The eliminations there are: what a Program calls, emitted code embeds, and people read of each."""

from __future__ import annotations

from dataclasses import dataclass

from ikgen.program import routines
from ikgen.program.routines import Routine
from ikgen.runtime.python.elimination.coupled_angle import CoupledAngle
from ikgen.runtime.python.elimination.coupled_both import CoupledBothAngle
from ikgen.runtime.python.elimination.coupled_shared import CoupledSharedAngle
from ikgen.runtime.python.elimination.general_6r import Finder, candidates
from ikgen.runtime.python.elimination.one_slide import (
    one_slide_both_candidates,
    one_slide_candidates,
)
from ikgen.runtime.python.elimination.three_slides import three_slide_candidates
from ikgen.runtime.python.elimination.two_slides import two_slide_candidates
from ikgen.runtime.python.rows.solution_rows import Turning

__all__ = ["ELIMINATIONS", "EliminationRoutine", "elimination_routine", "finder"]


@dataclass(frozen=True, slots=True)
class EliminationRoutine:
    """One elimination of six joints. `called`: the routine that a Program calls; `words`: how many of the
    joints turn and slide; `find`: what finds candidates in Python, or what makes that of the chain's axes;
    `most`: solutions at most (Raghavan and Roth 1993), None where they depend on the chain. `both`: by half
    angles of both angles beside the hidden one; `coupled`: one joint moves several axes."""

    called: Routine
    words: str
    slides: int
    find: Finder | type[CoupledAngle]
    most: int | None = None
    both: bool = False
    coupled: bool = False
    shared: bool = False


ELIMINATIONS = (
    EliminationRoutine(routines.GENERAL_6R, "6R", 0, candidates, 16),
    EliminationRoutine(routines.ONE_SLIDE, "5R1P", 1, one_slide_candidates, 16),
    EliminationRoutine(
        routines.ONE_SLIDE_BOTH, "5R1P", 1, one_slide_both_candidates, 16, both=True
    ),
    EliminationRoutine(routines.TWO_SLIDES, "4R2P", 2, two_slide_candidates, 8),
    EliminationRoutine(routines.THREE_SLIDES, "3R3P", 3, three_slide_candidates, 2),
    EliminationRoutine(routines.COUPLED_6R, "coupled 6R", 0, CoupledAngle, coupled=True),
    EliminationRoutine(
        routines.COUPLED_BOTH, "coupled 6R", 0, CoupledBothAngle, both=True, coupled=True
    ),
    EliminationRoutine(
        routines.COUPLED_SHARED, "coupled 6R", 0, CoupledSharedAngle, coupled=True, shared=True
    ),
)


def elimination_routine(
    slides: int, *, both: bool = False, coupled: bool = False, shared: bool = False
) -> EliminationRoutine:
    """The elimination of six joints of which so many slide."""
    asked = (slides, both, coupled, shared)
    return next(r for r in ELIMINATIONS if (r.slides, r.both, r.coupled, r.shared) == asked)


def finder(turning: Turning, *, both: bool = False) -> Finder:
    """The function that finds candidates of six joints of which some slide; of one slide by half angles of
    `both` angles beside the hidden one, or of either."""
    find = elimination_routine(turning.count(False), both=both).find
    assert not isinstance(find, type)
    return find
