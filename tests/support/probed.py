"""Expressions with values of one's own at the probes, as coefficients of forms."""

from __future__ import annotations

import itertools
from collections.abc import Sequence

import numpy as np

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph

__all__ = ["given", "sign"]

_count = itertools.count()


def given(graph: ExpressionGraph, values: Sequence[float] | np.ndarray) -> Expr:
    """A new input with its values at the probes."""
    probe = np.asarray(values, dtype=float)
    return graph.atom("pose", f"given_{next(_count)}", probe, unknown=False)


def sign(graph: ExpressionGraph, value: float) -> Expr:
    """The sign that chooses a branch, with one value at all probes."""
    return given(graph, np.full(graph.probes, value))
