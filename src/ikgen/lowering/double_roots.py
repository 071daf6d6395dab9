"""Where solved unknowns are nearly double roots, so that what follows from them has half the digits."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from functools import partial, reduce

from ikgen.algebra.dependencies import dependencies
from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph

__all__ = ["DoubleRoots", "either"]


def either(graph: ExpressionGraph, flags: Iterable[Expr]) -> Expr | None:
    """Condition that one of these holds; None where there is none."""
    some = tuple(flags)
    return reduce(partial(graph.binary, "or"), some) if some else None


class DoubleRoots:
    """Conditions under which unknowns are nearly double roots. `definition`: what solved atoms are."""

    def __init__(self, graph: ExpressionGraph, definition: dict[int, Expr]) -> None:
        self._graph, self._definition = graph, definition
        self._own: list[Expr] = []
        self._of: dict[int, Expr] = {}

    def note(self, flag: Expr) -> None:
        """The unknown that is being solved is nearly a double root where this holds."""
        self._own.append(flag)

    def settle(self, atoms: Sequence[Expr]) -> None:
        """The unknown of these atoms is solved."""
        own = either(self._graph, self._own)
        if own is not None:
            self._of |= dict.fromkeys((a.id for a in atoms), own)
        self._own.clear()

    def behind(self, value: Expr) -> Expr | None:
        """Condition that an unknown which a value follows from is; None where there is no such unknown."""
        before = dependencies([value], self._definition)
        flags = dict.fromkeys(self._of[node.id] for node in before if node.id in self._of)
        return either(self._graph, flags)
