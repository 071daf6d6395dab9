"""A solution form as it is lowered for every output language, with symbols for its coefficients."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from typing import Any

import numpy as np
import sympy

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.errors import IkgenError
from ikgen.forms.form import Form
from ikgen.forms.lowered_form import LoweredBranches, LoweredForm, LoweredRoutine, Tolerances
from ikgen.symbolic.exact_numbers import exact_number
from ikgen.symbolic.expression_view import ARITHMETIC

__all__ = ["Kind", "LoweredView", "NotAlgebraicError"]

Kind = str
"""What is known of a coefficient: "zero", a "constant" of the arm other than zero, or "variable"."""

_PROBES = 6


class NotAlgebraicError(IkgenError):
    """A form computes something that is no algebraic expression of its coefficients."""


class LoweredView:
    """A form class lowered once for each pattern of its coefficients' kinds.

    `coefficients` are the symbols, zero for those that vanish. Where the code guards against round-off
    (a square root's argument cut at zero, a ratio at one, a vanishing divisor replaced) the value
    inside is taken: that is what the guard lets pass.
    """

    def __init__(self, form: type[Form], kinds: Sequence[Kind]) -> None:
        self.graph = ExpressionGraph(_PROBES)
        names = [f.name for f in fields(form)]
        random = np.random.default_rng(len(names))
        self._nodes = [
            self._coefficient(name, kind, random.uniform(0.5, 1.5, _PROBES))
            for name, kind in zip(names, kinds, strict=True)
        ]
        self.form = form(*self._nodes)
        self.sigma = self.graph.atom("sigma", "0", np.ones(_PROBES), unknown=False)
        self._signs: dict[str, sympy.Expr] = {}
        lowered = self.form.lower(self.graph, self.sigma, Tolerances())
        if isinstance(lowered, LoweredRoutine):
            raise NotAlgebraicError(f"the routine {lowered.routine} of the emitted code solves it")
        if isinstance(lowered, LoweredBranches):
            raise NotAlgebraicError("it gives its branches one by one")
        self.lowered: LoweredForm = lowered

    def _coefficient(self, name: str, kind: Kind, values: Any) -> Expr:
        if kind == "zero":
            return self.graph.zero
        if kind == "constant":
            return self.graph.param(name, float(values[0]))
        return self.graph.atom("coefficient", name, values, unknown=False)

    @property
    def coefficients(self) -> tuple[sympy.Expr, ...]:
        """Their symbols in order."""
        return tuple(self.convert(node) for node in self._nodes)

    @property
    def divisor(self) -> sympy.Expr:
        """What must not vanish."""
        return self.convert(self.lowered.divisor.value)

    @property
    def radicand(self) -> sympy.Expr | None:
        """What must not be negative."""
        return None if self.lowered.under is None else self.convert(self.lowered.under[0])

    def values(self, sign: sympy.Expr) -> tuple[sympy.Expr, ...]:
        """(Cosine, sine) or (length,) of a branch."""
        return tuple(self.convert(v, sign) for v in self.lowered.values)

    def value(self, sign: sympy.Expr) -> sympy.Expr:
        """The angle or length of a branch."""
        values = self.values(sign)
        return sympy.atan2(values[1], values[0]) if len(values) == 2 else values[0]

    def convert(self, node: Expr, sign: sympy.Expr = sympy.S.One) -> sympy.Expr:
        """A node in SymPy. Raises `NotAlgebraicError`."""
        if node.is_const:
            return exact_number(node.value).sympy
        if node is self.sigma:
            return sympy.sympify(sign)
        if node.op == "param" or node.atom is not None:
            name = str(node.atom.key) if node.atom is not None else node.name
            return sympy.Symbol(name, real=True)
        inner = _guarded(node)
        if inner is not None:
            return self.convert(inner, sign)
        if node.op not in ARITHMETIC:
            raise NotAlgebraicError(f"it computes '{node.op}'")
        return ARITHMETIC[node.op](*(self.convert(a, sign) for a in node.args))


def _guarded(node: Expr) -> Expr | None:
    """The value inside a guard against round-off; None for other nodes."""
    if node.op == "select" and node.args[2].is_const:
        return node.args[1]
    if node.op in ("max", "min"):
        inside = [a for a in node.args if not a.is_const]
        return inside[0] if len(inside) == 1 else None
    return None
