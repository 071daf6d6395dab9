"""The two sides of a chain's matrix equations as products of links, moves and the pose."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from copy import copy
from functools import wraps
from types import MappingProxyType
from typing import TypeVar, cast

import numpy as np
from numpy.typing import NDArray

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.equations.probes import elbow_position
from ikgen.equations.symbolic_transforms import (
    Rigid,
    constant,
    identity,
    inverse,
    link,
    multiply,
    run,
    run_inverse,
)
from ikgen.equations.variables import JointVariables, runs_of
from ikgen.model.dh import DHChain
from ikgen.model.entry_names import ENTRY_NAMES

__all__ = ["ChainProducts"]

Products = TypeVar("Products", bound="ChainProducts")
Method = TypeVar("Method", bound=Callable[..., Rigid])


def _kept(method: Method) -> Method:
    """The method, which makes each product once: its factors make many."""

    @wraps(method)
    def product(self: ChainProducts, *key: int) -> Rigid:
        place = method.__name__, key
        if place not in self._products:
            self._products[place] = method(self, *key)
        return self._products[place]

    return cast(Method, product)


class ChainProducts:
    """Products of `dh` over the graph's atoms, those of the pose included.

    `pose` (probes, 4, 4) are the probes' poses in DH frames; `readable` names the entries of the pose
    that the task reads: the others are unknowns that nothing solves; `kept` as in `Probes`.
    """

    def __init__(
        self,
        graph: ExpressionGraph,
        dh: DHChain,
        values: NDArray[np.float64],
        pose: NDArray[np.float64],
        *,
        readable: frozenset[str] = frozenset(ENTRY_NAMES),
        tool_on_right: bool = False,
        kept: Mapping[str, NDArray[np.float64]] = MappingProxyType({}),
    ) -> None:
        self.graph = graph
        self.dh = dh
        self.n = len(dh.rows)
        self.variables = JointVariables(graph, dh, values, kept)
        self.runs = runs_of(dh)
        self.readable = readable
        self.tool_on_right = tool_on_right
        self.tool = constant(graph, dh.X_tip) if tool_on_right else identity(graph)
        self._products: dict[tuple[str, tuple[int, ...]], Rigid] = {}
        self.pose = self._pose(pose)
        self.elbow = self._elbow(values, kept) if dh.arm_angle else ()

    def over(self: Products, graph: ExpressionGraph) -> Products:
        """The same products over a graph that has all nodes of this one's."""
        other = copy(self)
        other.graph = graph
        other.variables = self.variables.over(graph)
        other._products = dict(self._products)
        return other

    def _pose(self, values: NDArray[np.float64]) -> Rigid:
        g = self.graph

        def entry(name: str, probe: NDArray[np.float64]) -> Expr:
            return g.atom("pose", name, probe, unknown=name not in self.readable)

        rows = tuple(
            tuple(entry(f"r{i + 1}{j + 1}", values[:, i, j]) for j in range(3)) for i in range(3)
        )
        p = tuple(entry(f"p{'xyz'[i]}", values[:, i, 3]) for i in range(3))
        return Rigid(rows, p)

    def _elbow(
        self, values: NDArray[np.float64], kept: Mapping[str, NDArray[np.float64]]
    ) -> tuple[Expr, ...]:
        """Position of the elbow in frame 0: known where the arm angle is given with the pose."""
        probes = elbow_position(self.dh, values, kept)
        names = ("ex", "ey", "ez")
        return tuple(
            self.graph.atom("pose", n, x, unknown=False)
            for n, x in zip(names, probes.T, strict=True)
        )

    def _run_end(self, i: int) -> int:
        while i + 1 < self.n and self.runs[i + 1] == self.runs[i]:
            i += 1
        return i

    def _run_start(self, i: int) -> int:
        while i > 0 and self.runs[i - 1] == self.runs[i]:
            i -= 1
        return i

    @_kept
    def before(self, k: int) -> Rigid:
        """`(A_1 ... A_k)^-1`-side product applied to the pose: `(A_1 ... A_k)^-1 T`."""
        if k == 0:
            return self.pose
        start = self._run_start(k - 1)
        earlier = multiply(self.graph, self._link_inverse(start), self.before(start))
        return multiply(self.graph, run_inverse(self.variables, start, k - 1), earlier)

    @_kept
    def _head(self, k: int, linked: bool) -> Rigid:
        """`before(k)`, or that behind the inverse of row k's link."""
        if not linked or k == self.n:
            return self.before(k)
        return multiply(self.graph, self._link_inverse(k), self.before(k))

    @_kept
    def _without_tool(self, k: int, linked: bool) -> Rigid:
        g = self.graph
        return multiply(g, self._head(k, linked), inverse(g, self.tool))

    def left(self, k: int, m: int) -> Rigid:
        """The left side of the split (k, m)."""
        return self._after(k, True, m)

    @_kept
    def _after(self, k: int, linked: bool, m: int) -> Rigid:
        """`_head(k, linked) * (A_{m+1} ... A_n)^-1`, from the right end inwards."""
        if m == self.n:
            return self._head(k, linked)
        ahead, piece = self._without_tool(k, linked), self._piece(m)
        following = self._run_end(m) + 1
        if following < self.n:
            ahead = self._after(k, linked, following)
        return multiply(self.graph, ahead, piece)

    @_kept
    def _piece(self, i: int) -> Rigid:
        """The inverse of rows i to the end of their run."""
        turned = run_inverse(self.variables, i, self._run_end(i))
        return multiply(self.graph, turned, self._link_inverse(i))

    @_kept
    def link(self, i: int) -> Rigid:
        """`C_{i+1}`."""
        return link(self.variables, i)

    @_kept
    def _link_inverse(self, i: int) -> Rigid:
        return inverse(self.graph, self.link(i))

    @_kept
    def _linked_run(self, first: int, last: int) -> Rigid:
        return multiply(self.graph, self.link(first), run(self.variables, first, last))

    @_kept
    def right(self, k: int, m: int) -> Rigid:
        """`V_{k+1} C_{k+2} V_{k+2} ... V_m`, in cumulative angles."""
        product = self._rows(k, m)
        return multiply(self.graph, product, self.tool) if m == self.n else product

    @_kept
    def _rows(self, k: int, m: int) -> Rigid:
        """`right` without a tool."""
        start = self._run_start(m - 1)
        if start <= k:
            return run(self.variables, k, m - 1)
        return multiply(self.graph, self._rows(k, start), self._linked_run(start, m - 1))

    @_kept
    def right_inverse(self, k: int, m: int) -> Rigid:
        """The inverse of `right`, built from the other end so that the first joint's angle is not in
        its position."""
        g = self.graph
        last = min(self._run_end(k), m - 1)
        if last < m - 1:
            ahead = multiply(g, self.right_inverse(last + 1, m), self._link_inverse(last + 1))
        else:
            ahead = inverse(g, self.tool) if m == self.n else identity(g)
        return multiply(g, ahead, run_inverse(self.variables, k, last))

    @_kept
    def _between(self, j: int, k: int) -> Rigid:
        """`A_{j+1} ... A_k C_{k+1}`; j is the start of a run."""
        return multiply(self.graph, self._complete(j, k), self.link(k))

    @_kept
    def _complete(self, j: int, k: int) -> Rigid:
        """`A_{j+1} ... A_k`; j is the start of a run."""
        if j == k:
            return identity(self.graph)
        start = self._run_start(k - 1)
        return multiply(self.graph, self._complete(j, start), self._linked_run(start, k - 1))

    def _target(self, j: int, m: int) -> Rigid:
        """`(A_1 ... A_j)^-1 T (A_{m+1} ... A_n)^-1`."""
        return self._after(j, False, m)
