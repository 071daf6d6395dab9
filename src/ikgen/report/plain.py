"""Sums as plain text for a terminal: p_x*c_1 + p_y*s_1 - a_2*c_2."""

from __future__ import annotations

from ikgen.equations.knowledge import Variable
from ikgen.formulas.normal_form import Factor, Named, Radical, Sum, Symbol, Term

__all__ = ["plain"]


def plain(s: Sum) -> str:
    """A sum, written out."""
    out = ""
    for term in s.terms:
        sign = "-" if term.coefficient < 0 else "+"
        if out:
            out += f" {sign} "
        elif sign == "-":
            out = "-"
        out += _term(term)
    return out or "0"


def _term(term: Term) -> str:
    size = abs(term.coefficient)
    above = [_power(f, p) for f, p in term.factors if p > 0]
    below = [_power(f, -p) for f, p in term.factors if p < 0]
    if abs(size - 1.0) > 1e-14 or not above:
        above.insert(0, f"{size:.6g}")
    text = "*".join(above)
    return f"{text}/({'*'.join(below)})" if below else text


def _power(factor: Factor, power: int) -> str:
    if isinstance(factor, Symbol):
        base = _symbol(factor)
    elif isinstance(factor, Named):
        base = f"u_{factor.index}"
    elif isinstance(factor, Radical):
        base = f"sqrt({plain(factor.inside)})"
    else:
        base = f"({plain(factor)})"
    return base if power == 1 else f"{base}^{power}"


def _symbol(s: Symbol) -> str:
    if isinstance(s.key, str):
        return f"{s.key[0]}_{s.key[1:]}" if s.kind == "pose" else s.key
    if s.kind == "prismatic":
        return Variable("prismatic", s.key).text
    text = Variable("angle", s.key).text
    return text.replace("theta", s.kind[0]) if text.startswith("theta") else f"{s.kind}{text}"
