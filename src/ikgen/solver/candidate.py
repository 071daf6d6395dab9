"""What a leaf proposes: the solution of one unknown in closed form, not yet chosen."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from ikgen.algebra.expression import Expr
from ikgen.equations.equation import Equation
from ikgen.equations.knowledge import Variable
from ikgen.forms.form import Form, scales
from ikgen.model.arrays import Array

__all__ = ["Candidate", "Judgement"]


@dataclass(frozen=True, slots=True)
class Judgement:
    """How a candidate did at the probes: `weak` if its divisor vanishes at regular configurations,
    `folds` if its branches meet at one, `margin` the smallest relative divisor there, `fragile` the share
    of singular configurations where it vanishes, `cost` of what has to be computed newly.
    `almost_tangent`: the constant side is there for rounded constants alone, so the branches lie half a
    turn apart but for rounding. `steepness`: how steep an equation that a routine solves usually is at its
    roots, little where they lie in pairs."""

    weak: bool
    folds: bool
    margin: float
    fragile: float
    cost: float
    almost_tangent: bool = False
    steepness: float = math.inf


@dataclass(frozen=True, slots=True)
class Candidate:
    """A solution form for an unknown, found by a leaf in equations of the chain."""

    unknown: Variable
    leaf: str
    form: Form
    sources: tuple[Equation, ...]
    note: str = ""
    judgement: Judgement | None = field(default=None, compare=False)

    @property
    def coefficients(self) -> tuple[Expr, ...]:
        """The form's coefficients."""
        return self.form.coefficients

    @property
    def branches(self) -> int:
        """Number of alternatives that the form gives."""
        return self.form.branches

    @property
    def is_weak(self) -> bool:
        """Whether it was judged to fail at some regular configuration."""
        return self.judgement is not None and self.judgement.weak

    @property
    def is_sound(self) -> bool:
        """Whether it was judged to hold at all regular configurations, its branches apart."""
        return self.judgement is None or not (self.judgement.weak or self.judgement.folds)

    def relative_divisor(self) -> Array:
        """The size (N,) of the divisor at the probes, in natural units."""
        parts = self.form.divisor(self.form.probe, scales(self.coefficients))
        return np.asarray(np.sqrt(np.sum(parts**2, axis=0)))

    def values(self) -> list[tuple[Array, ...]]:
        """Per branch, the unknown at the probes: (c, s) or (x,). NaN where the divisor vanishes."""
        with np.errstate(all="ignore"):
            return self.form.values(self.form.probe)
