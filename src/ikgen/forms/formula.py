"""A solution form as a textbook has it: its equations in the unknown, solution and guards."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.equations.knowledge import Variable
from ikgen.formulas import mathtext as m
from ikgen.formulas.mathtext import Math
from ikgen.formulas.naming import Abbreviations
from ikgen.formulas.normal_form import Sum
from ikgen.formulas.normalizer import Normalizer
from ikgen.formulas.notation import angle, grouped, show

__all__ = ["Formula", "FormulaWriter", "equals", "linear_combination", "plain_formula"]


@dataclass(frozen=True, slots=True)
class Formula:
    """`equations` in the unknown; per branch the right side of `theta = ...`; where real solutions
    exist (`reach`), and what must not vanish (`divisor`)."""

    equations: tuple[Math, ...]
    branches: tuple[Math, ...]
    reach: Math | None = None
    divisor: Math | None = None


class FormulaWriter:
    """A form's unknown and coefficients `e`, normalized, with abbreviations in them. The graph is one
    that may grow."""

    def __init__(
        self,
        unknown: Variable,
        coefficients: Sequence[Expr],
        g: ExpressionGraph,
        normal: Normalizer,
        names: Abbreviations,
    ) -> None:
        self.unknown, self.e, self.g = unknown, coefficients, g
        self.normal, self.names = normal, names

    def sum(self, node: Expr) -> Sum:
        """An expression with abbreviations in it."""
        return self.names.short(self.normal(node))

    def radicand(self, node: Expr) -> Sum:
        """What is under a root, where no line can break: a name unless it is short."""
        return self.names.unbroken(self.normal(node))

    def coefficients(self) -> list[Sum]:
        """The coefficients, those named that the solution will repeat."""
        return [self.names.force(self.normal(e)) for e in self.e]

    def divisor(self, node: Expr) -> Math | None:
        """What must not vanish; None for what depends on the arm's constants alone."""
        return None if node.is_fixed else show(self.sum(node))

    def minor(self, i: int, j: int, k: int, n: int) -> Expr:
        """`e_i e_j - e_k e_n`"""
        return self.g.sub(self.g.mul(self.e[i], self.e[j]), self.g.mul(self.e[k], self.e[n]))

    def length(self) -> Math:
        """The unknown itself."""
        if self.unknown.kind == "angle":
            return angle(self.unknown.combination)
        return m.name("d", str(self.unknown.combination.index(1) + 1))

    def cosine(self, kind: str = "cos") -> Math:
        """Its cosine, or with "sin" its sine."""
        v = self.unknown
        if all(k in (0, 1) for k in v.combination):
            places = "".join(str(j + 1) for j, k in enumerate(v.combination) if k)
            return m.name(kind[0], places)
        return m.text(kind) + angle(v.combination)


def equals(left: Math, right: Math) -> Math:
    """`left = right`"""
    return left + m.relation() + right


def linear_combination(parts: Sequence[tuple[Sum, Math]]) -> Math:
    """`sum(coefficient * unknown)` without zero terms."""
    out = Math(())
    for coefficient, unknown in parts:
        if coefficient.is_zero:
            continue
        value, s = coefficient.value, coefficient
        negative = len(s.terms) == 1 and s.terms[0].coefficient < 0
        if out.tokens:
            out = out + (m.minus() if negative else m.plus())
        elif negative:
            out = out + m.minus(sign=True)
        s = -s if negative else s
        if value is None or abs(value) != 1.0:
            out = out + grouped(s) + m.space()
        out = out + unknown
    return out if out.tokens else m.name("0")


def plain_formula(w: FormulaWriter, name: str, branches: int) -> Formula:
    """A form that has no notation of its own: its coefficients only."""
    lines = tuple(equals(m.name("A", str(i)), show(w.sum(e))) for i, e in enumerate(w.e, start=1))
    return Formula(lines, tuple(m.text(f"branch {i + 1} of {name}") for i in range(branches)))
