"""Sums in textbook notation: c_1, s_23, a_2, p_x, r_13, with as few parentheses as it takes."""

from __future__ import annotations

from ikgen.equations.knowledge import Variable
from ikgen.formulas import mathtext as m
from ikgen.formulas.mathtext import Math
from ikgen.formulas.normal_form import Factor, Named, Radical, Sum, Symbol, Term
from ikgen.model.angle_function import AngleFunction

__all__ = ["angle", "quotient", "show", "symbol", "variable"]

_INLINE_FRACTION = 26


def _index(combination: tuple[int, ...]) -> str | None:
    """23 for theta_2 + theta_3; None for a combination that is no plain sum."""
    if any(k not in (0, 1) for k in combination):
        return None
    places = [str(j + 1) for j, k in enumerate(combination) if k]
    return ("," if len(combination) > 9 else "").join(places)


def angle(combination: tuple[int, ...], version: str = "") -> Math:
    """theta_2, theta_23, or a combination such as theta_2 - theta_4 in parentheses."""
    index = _index(combination)
    if index is not None:
        return m.name("theta", index + version)
    parts = Math(())
    for j, k in enumerate(combination):
        if not k:
            continue
        sign = m.plus() if k > 0 else m.minus(sign=not parts.tokens)
        parts = parts + (sign if parts.tokens or k < 0 else Math(()))
        parts = (
            parts + (m.number(abs(k)) if abs(k) != 1 else Math(())) + m.name("theta", str(j + 1))
        )
    return m.group(parts)


def variable(v: Variable, version: str = "") -> Math:
    """An unknown, with the number of its version: theta_{3s1}, d_{2s4}."""
    if v.kind == "angle":
        return angle(v.combination, version)
    return m.name("d", f"{v.combination.index(1) + 1}{version}")


def symbol(s: Symbol) -> Math:
    """One symbol."""
    if isinstance(s.key, str):
        if s.kind == "pose":
            return m.name(s.key[0], s.key[1:])
        return _parameter(s.key) if s.function is None else _function(s.function)
    if s.kind == "prismatic":
        return m.name("d", str(s.key.index(1) + 1))
    index = _index(s.key)
    if index is not None:
        return m.name(s.kind[0], index)
    return m.join([m.text(s.kind), angle(s.key)])


def _function(f: AngleFunction) -> Math:
    return m.text(f"{f.function} ") + _parameter(f.angle)


def _parameter(name: str) -> Math:
    base, _, index = name.rstrip("_").partition("_")
    return m.name(base, index.replace("_", ""))


def show(s: Sum) -> Math:
    """A sum, written out."""
    if not s.terms:
        return m.name("0")
    out = Math(())
    for term in s.terms:
        negative = term.coefficient < 0
        if negative:
            out = out + m.minus(sign=not out.tokens)
        elif out.tokens:
            out = out + m.plus()
        out = out + _term(term)
    return out


def _term(term: Term) -> Math:
    above = [(f, p) for f, p in term.factors if p > 0]
    below = [(f, -p) for f, p in term.factors if p < 0]
    size = abs(term.coefficient)
    head = [m.number(size)] if abs(size - 1.0) > 1e-14 or not above else []
    top = m.join([*head, *(_power(f, p, alone=False) for f, p in above)], m.space())
    if not below:
        return top
    alone = len(below) == 1 and below[0][1] == 1
    return m.fraction(top, m.join([_power(f, p, alone=alone) for f, p in below], m.space()))


def _power(factor: Factor, power: int, *, alone: bool) -> Math:
    if isinstance(factor, Symbol):
        base = symbol(factor)
    elif isinstance(factor, Named):
        base = m.name("u", str(factor.index))
    elif isinstance(factor, Radical):
        base = m.radical(show(factor.inside))
    else:
        base = show(factor) if alone else m.group(show(factor))
    return m.power(base, power)


def grouped(s: Sum) -> Math:
    """A sum as a factor: in parentheses unless it is one positive term."""
    plain = len(s.terms) == 1 and s.terms[0].coefficient > 0
    return show(s) if plain else m.group(show(s))


def quotient(above: Sum, below: Sum) -> Math:
    """above / below: signs and numbers pulled out, long ones with a solidus."""
    value = below.value
    if value is not None:
        scaled = Sum(tuple(Term(t.coefficient / value, t.factors) for t in above.terms))
        return show(scaled)
    if below.terms[0].coefficient < 0:
        above, below = -above, -below
    if above.weight + below.weight <= _INLINE_FRACTION:
        if above.terms and all(t.coefficient < 0 for t in above.terms):
            return m.minus(sign=True) + m.fraction(show(-above), show(below))
        return m.fraction(show(above), show(below))
    factored = len(below.terms) == 1 and len(below.terms[0].factors) == 1
    bottom = show(below) if factored else m.group(show(below))
    return m.group(show(above)) + m.operator("/", "/") + bottom
