"""What a solution form is: an equation pattern in one unknown that has a closed form.

A leaf finds equations of the pattern and fills in the coefficients; everything that depends on the form
alone is here: how many branches it has, where it degenerates and folds, its values, what it computes in a
Program, and how a textbook writes it. A package may bring a form of its own with its leaf.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import ClassVar

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.forms.formula import Formula, FormulaWriter, plain_formula
from ikgen.forms.lowered_form import LoweredBranches, LoweredForm, LoweredRoutine, Tolerances
from ikgen.formulas.mathtext import Math
from ikgen.model.arrays import Array

__all__ = ["Array", "Form", "scales"]


def scales(coefficients: Sequence[Expr]) -> list[float]:
    """The natural sizes of coefficients, never zero."""
    return [max(e.scale, 1e-300) for e in coefficients]


@dataclass(frozen=True, slots=True)
class Form(ABC):
    """A form with its coefficients: the fields of the class, known expressions, in order.

    `name` is the form's name in traces; `branches` how many alternatives it gives; `on_circle` whether
    cosine and sine add up to one by construction; `remark` what a report says below the solution.
    """

    name: ClassVar[str]
    branches: ClassVar[int]
    on_circle: ClassVar[bool] = True
    remark: ClassVar[tuple[str | Math, ...]] = ()

    @property
    def words(self) -> str:
        """What it is, for messages."""
        return f"the form '{self.name}' ({type(self).__module__}.{type(self).__qualname__})"

    @property
    def coefficients(self) -> tuple[Expr, ...]:
        """The coefficients in the order of the fields."""
        return tuple(getattr(self, f.name) for f in fields(self))

    @property
    def probe(self) -> list[Array]:
        """The coefficients at the probes."""
        return [e.probe for e in self.coefficients]

    @property
    def divisor_parts(self) -> tuple[Expr, ...]:
        """The coefficients that the divisor is made of."""
        return self.coefficients[:1]

    @property
    def is_determinant(self) -> bool:
        """Whether the divisor is a determinant, which vanishes on whole surfaces, where sums of squares do
        so only where several things vanish at once."""
        return False

    @property
    def tangent_without(self) -> Expr | None:
        """The coefficient without which the branches lie half a turn apart; None where there is none."""
        return None

    @abstractmethod
    def divisor(self, c: Sequence[Array], z: Sequence[float]) -> Array:
        """What must not vanish all at once, (m, N), in natural units; c: the coefficients (N,) each at
        some configurations, z: their natural sizes."""

    def fold(self, c: Sequence[Array], z: Sequence[float], unknown: Array) -> Array | None:
        """What vanishes where two branches meet, (1, N), in natural units, given the unknown's values
        (N,) there; None for forms whose branches never meet at a solution."""
        return None

    def discriminant(self) -> Array | None:
        """What is under the square root at the probes, relative to its natural size: two branches meet
        where it vanishes. None for forms without one."""
        return None

    def slope(self, g: ExpressionGraph, unknown: tuple[Expr, ...]) -> Expr | None:
        """What vanishes at a root (cosine, sine) that is a double one, of forms that a routine solves."""
        return None

    def steepness(self, unknown: tuple[Array, ...]) -> Array | None:
        """How steep the equation is at a root (cosine, sine) at the probes, relative to its coefficients:
        little where two roots are close. None for forms that no routine solves."""
        return None

    @abstractmethod
    def values(self, c: Sequence[Array]) -> list[tuple[Array, ...]]:
        """Per branch the unknown for coefficients c, (cosine, sine) or (length,), each (N,); NaN where
        the divisor vanishes."""

    def pattern(self, g: ExpressionGraph, unknown: tuple[Expr, ...]) -> tuple[Expr, ...]:
        """What vanishes where the unknown has the value (cosine, sine) or (length,): the equations that the
        form solves. Empty for a form that does not say; such a one cannot be proved."""
        return ()

    @abstractmethod
    def lower(
        self, g: ExpressionGraph, sigma: Expr, tolerances: Tolerances
    ) -> LoweredForm | LoweredBranches | LoweredRoutine:
        """The form over the graph; `sigma` (1 or -1) chooses the branch of forms with two. Those with more
        give each branch by itself, or are solved by a routine."""

    def instead(self, g: ExpressionGraph, seed: tuple[Expr, ...]) -> tuple[Expr, ...]:
        """Coefficients of the same form whose solution is the seed's value, for a form solved by a
        routine: they are its arguments where the unknown is free."""
        raise NotImplementedError(f"the form '{self.name}' is not solved by a routine")

    def formula(self, w: FormulaWriter) -> Formula:
        """The form in textbook notation: here its coefficients alone."""
        return plain_formula(w, self.name, self.branches)
