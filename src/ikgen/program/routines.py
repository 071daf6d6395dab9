"""The routines that Programs call: what each takes and gives, and where each language has it."""

from __future__ import annotations

from dataclasses import dataclass

__all__ = [
    "COUPLED_6R",
    "COUPLED_BOTH",
    "COUPLED_SHARED",
    "GENERAL_6R",
    "ONE_SLIDE",
    "ONE_SLIDE_BOTH",
    "ROUTINES",
    "THREE_SLIDES",
    "TRIG_POLYNOMIAL",
    "TRIG_QUARTIC",
    "TRIG_QUARTIC_WIDE",
    "TWO_SLIDES",
    "Routine",
]  # fmt: skip


@dataclass(frozen=True, slots=True)
class Routine:
    """A routine that gives the branches of a level.

    `takes` and `gives` are its arguments and what it sets for each of its roots, in words. C++ includes
    `cpp_header`, a path in its runtime, for it. What finds roots of one unknown is `<name>_branches` there,
    and in Python that and `<name>_lanes` of `python_module`, a path in its runtime; an elimination, which
    finds all joints at once, is the class `cpp_class`, and in Python what its plan names.
    """

    name: str
    takes: str
    gives: str
    cpp_header: str
    cpp_class: str = ""
    python_module: str = ""

    @property
    def finds_roots(self) -> bool:
        """Whether it finds roots of one unknown."""
        return bool(self.python_module)


_ROOT = "cosine and sine of a root"
_TAKEN = "pose, held joints"

TRIG_QUARTIC = Routine(
    "trig_quartic", "a2, b2, a1, b1, a0", _ROOT, "roots/trig_quartic.hpp",
    python_module="roots.trig_quartic_roots",
)  # fmt: skip
"""Roots of `a2 cos 2u + b2 sin 2u + a1 cos u + b1 sin u + a0`."""

TRIG_QUARTIC_WIDE = Routine(
    "trig_quartic_wide",
    f"{TRIG_QUARTIC.takes}, the largest imaginary part (rad) of roots that count", _ROOT,
    "roots/trig_quartic_wide.hpp", python_module="roots.trig_quartic_roots",
)  # fmt: skip

TRIG_POLYNOMIAL = Routine(
    "trig_polynomial", "see `TrigPolynomial.lower`", _ROOT, "roots/trig_polynomial.hpp",
    python_module="roots.trig_polynomial_roots",
)  # fmt: skip

GENERAL_6R = Routine(
    "general_6r", _TAKEN, "six revolute joints",
    "elimination/general_6r_arm.hpp", "General6r",
)  # fmt: skip
ONE_SLIDE = Routine(
    "one_slide", _TAKEN, "five revolute joints and a slide",
    "elimination/one_slide.hpp", "OneSlide",
)  # fmt: skip
ONE_SLIDE_BOTH = Routine(
    "one_slide_both", _TAKEN, "the same where half angles of one angle leave no rank",
    "elimination/one_slide_both.hpp", "OneSlideBoth",
)  # fmt: skip
TWO_SLIDES = Routine(
    "two_slides", _TAKEN, "four revolute joints and two slides",
    "elimination/two_slides.hpp", "TwoSlides",
)  # fmt: skip
THREE_SLIDES = Routine(
    "three_slides", _TAKEN, "three revolute joints and three slides",
    "elimination/three_slides.hpp", "ThreeSlides",
)  # fmt: skip
COUPLED_6R = Routine(
    "coupled_6r", _TAKEN, "six revolute joints, of which one moves several axes",
    "elimination/coupled_6r.hpp", "Coupled6r",
)  # fmt: skip
COUPLED_BOTH = Routine(
    "coupled_both", _TAKEN, "the same where half angles of one angle leave no rank",
    "elimination/coupled_both.hpp", "CoupledBoth",
)  # fmt: skip
COUPLED_SHARED = Routine(
    "coupled_shared", _TAKEN, "the same where several solutions share an angle of that joint",
    "elimination/coupled_shared.hpp", "CoupledShared",
)  # fmt: skip

ROUTINES = {
    one.name: one
    for one in (
        TRIG_QUARTIC, TRIG_QUARTIC_WIDE, TRIG_POLYNOMIAL, GENERAL_6R, ONE_SLIDE, ONE_SLIDE_BOTH,
        TWO_SLIDES, THREE_SLIDES, COUPLED_6R, COUPLED_BOTH, COUPLED_SHARED,
    )
}  # fmt: skip
"""By name. Pose: the entries r11, r12, r13, px, r21, ... of its upper three rows. Joints, base to tip:
cosine and sine of the DH variable of each that turns, the variable of each slide; last the turn about the
tool's axis where the task leaves that open. What eliminations have to know of the arm besides is
`SolverModule.plan`."""
