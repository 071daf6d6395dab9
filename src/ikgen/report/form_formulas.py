"""A candidate's form as a textbook has it: its equations in the unknown, solution and guards."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.equations.knowledge import Variable
from ikgen.report import mathtext as m
from ikgen.report.mathtext import Math
from ikgen.report.naming import Abbreviations
from ikgen.report.normal_form import Normalizer, Sum
from ikgen.report.notation import angle, grouped, quotient, show
from ikgen.solver.candidate import Candidate

__all__ = ["Solved", "solve_form"]


@dataclass(frozen=True, slots=True)
class Solved:
    """`equations` in the unknown; per branch the right side of `theta = ...`; where real solutions
    exist (`reach`), and what must not vanish (`divisor`)."""

    equations: tuple[Math, ...]
    branches: tuple[Math, ...]
    reach: Math | None
    divisor: Math | None


class _Work:
    """The candidate's coefficients, normalized, with names in them."""

    def __init__(
        self, c: Candidate, g: ExpressionGraph, normal: Normalizer, names: Abbreviations
    ) -> None:
        self.c, self.g, self.normal, self.names = c, g, normal, names
        self.e = c.coefficients

    def sum(self, node: Expr) -> Sum:
        """An expression with names in it."""
        return self.names.short(self.normal(node))

    def coefficients(self) -> list[Sum]:
        """The coefficients, those named that the solution will repeat."""
        return [self.names.force(self.normal(e)) for e in self.e]

    def divisor(self, node: Expr) -> Math | None:
        """What must not vanish; None for what depends on the arm's constants alone."""
        return None if node.is_fixed else show(self.sum(node))

    def minor(self, i: int, j: int, k: int, n: int) -> Expr:
        """`e_i e_j - e_k e_n`"""
        return self.g.sub(self.g.mul(self.e[i], self.e[j]), self.g.mul(self.e[k], self.e[n]))


def solve_form(
    c: Candidate, g: ExpressionGraph, normal: Normalizer, names: Abbreviations
) -> Solved:
    """The candidate in textbook notation."""
    make = {
        "linear": _linear, "root": _root, "pair": _pair, "sincos": _sincos, "tangent": _tangent,
        "quartic": _quartic,
    }.get(c.form, _unknown)  # fmt: skip
    return make(_Work(c, g, normal, names))


def _cosine(v: Variable, kind: str = "cos") -> Math:
    if all(k in (0, 1) for k in v.key):
        places = "".join(str(j + 1) for j, k in enumerate(v.key) if k)
        return m.name(kind[0], places)
    return m.text(kind) + angle(v.key)


def _linear_form(parts: list[tuple[Sum, Math]]) -> Math:
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


def _equals(left: Math, right: Math) -> Math:
    return left + m.relation() + right


def _linear(w: _Work) -> Solved:
    a, b = (w.sum(e) for e in w.e)
    x = m.name("d", str(w.c.unknown.key.index(1) + 1))
    if w.c.unknown.kind == "angle":
        x = angle(w.c.unknown.key)
    equation = _equals(_linear_form([(a, x)]), show(-b))
    return Solved(
        () if a.value == 1.0 else (equation,), (quotient(-b, a),), None, w.divisor(w.e[0])
    )


def _root(w: _Work) -> Solved:
    a, b, c = (w.sum(e) for e in w.e)
    x = m.name("d", str(w.c.unknown.key.index(1) + 1))
    parts = [(a, m.power(x, 2)), (b, x)]
    equation = _equals(_linear_form(parts), show(-c))
    g = w.g
    under = g.sub(g.square(w.e[1]), g.mul(g.const(4.0), g.mul(w.e[0], w.e[2])))
    inside = w.sum(under)
    if b.is_zero:
        over = quotient(-c, a)
        both = (m.radical(over), m.minus(sign=True) + m.radical(over))
        return Solved((equation,), both, over, w.divisor(w.e[0]))
    if a.value is not None:
        half = w.sum(g.mul(g.const(-0.5 / a.value), w.e[1]))
        quarter = w.sum(g.mul(g.const(0.25 / a.value**2), under))
        start = Math(()) if half.is_zero else show(half)
        both = (
            start + m.plus() + m.radical(show(quarter)),
            start + m.minus() + m.radical(show(quarter)),
        )
        return Solved((equation,), both, show(quarter), None)
    signs = (m.plus(), m.minus())
    tops = [m.minus(sign=True) + grouped(b) + s + m.radical(show(inside)) for s in signs]
    both = tuple(m.fraction(top, m.number(2.0) + m.space() + grouped(a)) for top in tops)  # type: ignore[assignment]
    return Solved((equation,), both, show(inside), w.divisor(w.e[0]))


def _pair(w: _Work) -> Solved:
    v = w.c.unknown
    cosine, sine = _cosine(v), _cosine(v, "sin")
    det = w.minor(0, 4, 3, 1)
    plain = det.is_const
    a1, b1, c1, a2, b2, c2 = (w.sum(e) for e in w.e) if plain else w.coefficients()
    equations = tuple(
        _equals(_linear_form([(a, cosine), (b, sine)]), show(c))
        for a, b, c in ((a1, b1, c1), (a2, b2, c2))
    )
    up, across = w.minor(0, 5, 3, 2), w.minor(2, 4, 5, 1)
    if np.all(det.probe <= 1e-12 * det.scale):
        det, up, across = w.g.neg(det), w.g.neg(up), w.g.neg(across)
    below = w.sum(det)
    positive = bool(np.all(det.probe >= -1e-12 * det.scale))
    y, x = w.sum(up), w.sum(across)
    if positive or below.value is not None:
        arguments = (show(y), show(x))
    else:
        arguments = (quotient(y, below), quotient(x, below))
    return Solved(equations, (m.function("atan2", *arguments),), None, w.divisor(det))


def _sincos(w: _Work) -> Solved:
    v, g = w.c.unknown, w.g
    a, b, c = w.coefficients()
    equation = _equals(_linear_form([(a, _cosine(v)), (b, _cosine(v, "sin"))]), show(c))
    if a.is_zero:
        ratio = m.function("asin", quotient(c, b))
        return Solved(
            (equation,), (ratio, m.name("pi") + m.minus() + ratio), _bound(c, b), w.divisor(w.e[1])
        )
    if b.is_zero:
        ratio = m.function("acos", quotient(c, a))
        return Solved(
            (equation,), (ratio, m.minus(sign=True) + ratio), _bound(c, a), w.divisor(w.e[0])
        )
    inside = w.sum(g.sub(g.add(g.square(w.e[0]), g.square(w.e[1])), g.square(w.e[2])))
    swing = m.function("atan2", m.radical(show(inside)), show(c))
    middle = m.function("atan2", show(b), show(a))
    both = (middle + m.plus() + swing, middle + m.minus() + swing)
    squares = g.add(g.square(w.e[0]), g.square(w.e[1]))
    reach = show(inside) + m.relation("\\ge ", "≥") + m.name("0")
    return Solved((equation,), both, reach, w.divisor(squares))


def _bound(above: Sum, below: Sum) -> Math:
    """`|C| <= |A|`, where a sine or cosine is C / A."""
    value = below.value
    one = m.number(abs(value)) if value is not None else m.group(show(below), "||")
    if all(t.coefficient < 0 for t in above.terms):
        above = -above
    return m.group(show(above), "||") + m.relation("\\le ", "≤") + one


def _tangent(w: _Work) -> Solved:
    v = w.c.unknown
    x, y = (w.sum(e) for e in w.e)
    k = m.name("K") + m.space()
    equations = (_equals(k + _cosine(v), show(x)), _equals(k + _cosine(v, "sin"), show(y)))
    both = (m.function("atan2", show(y), show(x)), m.function("atan2", show(-y), show(-x)))
    either = w.g.add(w.g.square(w.e[0]), w.g.square(w.e[1]))
    return Solved(equations, both, None, w.divisor(either))


def _quartic(w: _Work) -> Solved:
    theta = angle(w.c.unknown.key)
    letters = [
        m.name("a", "2"),
        m.name("b", "2"),
        m.name("a", "1"),
        m.name("b", "1"),
        m.name("a", "0"),
    ]
    twice = m.number(2.0) + m.space() + theta
    marks = [
        m.function("cos", twice), m.function("sin", twice), m.function("cos", theta),
        m.function("sin", theta), Math(()),
    ]  # fmt: skip
    terms = [a + m.space() + t for a, t in zip(letters, marks, strict=True)]
    equation = _equals(m.join(terms, m.plus()), m.name("0"))
    values = [_equals(a, show(w.sum(e))) for a, e in zip(letters, w.e, strict=True)]
    roots = tuple(m.function("arg", m.name("z", str(i + 1))) for i in range(4))
    return Solved((equation, *values, _self_inversive(letters)), roots, None, None)


def _self_inversive(letters: list[Math]) -> Math:
    """The polynomial in z = exp(i theta) whose roots on the unit circle are the solutions."""
    a2, b2, a1, b1, a0 = letters
    i = m.name("i")
    z = m.name("z")
    low, high = m.minus(), m.plus()
    parts = [
        m.group(a2 + low + i + m.space() + b2) + m.power(z, 4),
        m.group(a1 + low + i + m.space() + b1) + m.power(z, 3),
        m.number(2.0) + m.space() + a0 + m.space() + m.power(z, 2),
        m.group(a1 + high + i + m.space() + b1) + z,
        m.group(a2 + high + i + m.space() + b2),
    ]
    return _equals(m.join(parts, m.plus()), m.name("0"))


def _unknown(w: _Work) -> Solved:
    """A form of another package: its coefficients only."""
    lines = tuple(_equals(m.name("A", str(i)), show(w.sum(e))) for i, e in enumerate(w.e, start=1))
    branches = tuple(m.text(f"branch {i + 1} of {w.c.form}") for i in range(w.c.branches))
    return Solved(lines, branches, None, None)
