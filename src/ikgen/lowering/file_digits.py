"""What solved unknowns leave of the file's digits, where its geometry is a little off the solved one."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial, reduce

from ikgen.algebra.dependencies import dependencies
from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.forms.lowered_form import at_least

__all__ = ["FileDigits"]


class FileDigits:
    """Per unknown a square `m`, relative to natural sizes: what follows from it is off by the error of the
    geometry over the root of `m`.

    A square root of `x`, or a divisor of that square, enlarges what its argument is off by one over the
    root of `x`. A divisor and the square root beside it are two views of one: `C / h` with `h^2 - C^2`
    under the root; the smaller counts. But what an unknown is off enlarges what those solved from it are:
    of these `m` is the product. `definition`: what solved atoms stand for; `least` is as small as any
    single one is taken for.
    """

    def __init__(self, graph: ExpressionGraph, definition: dict[int, Expr], least: float) -> None:
        self._graph, self._definition = graph, definition
        self._least = least
        self._own: list[Expr] = []
        self._of: dict[int, Expr] = {}

    def note(self, square: Expr) -> None:
        """The unknown that is being solved has a square root of this, or a divisor of this square."""
        self._own.append(square)

    def settle(self, atoms: Sequence[Expr], values: Sequence[Expr]) -> None:
        """The unknown of these atoms is solved, from these values."""
        before = self.behind(*values)
        left = [] if before is None else [before]
        if self._own:
            left.append(self.no_less(reduce(partial(self._graph.binary, "min"), self._own)))
            self._own.clear()
        if left:
            self._of |= dict.fromkeys((a.id for a in atoms), reduce(self._graph.mul, left))

    def behind(self, *values: Expr) -> Expr | None:
        """The least `m` of the unknowns that values follow from; None where these lose nothing."""
        seen = {node.id for node in dependencies(values, self._definition, self._of)}
        left = dict.fromkeys(m for atom, m in self._of.items() if atom in seen)
        return reduce(partial(self._graph.binary, "min"), left) if left else None

    def no_less(self, square: Expr) -> Expr:
        """At least as much as a single square is taken for."""
        if not self._least:
            return square
        return at_least(self._graph, square, self._graph.const(self._least))
