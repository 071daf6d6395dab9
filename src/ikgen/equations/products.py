"""The two sides of a chain's matrix equations as products of links, moves and the pose."""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from types import MappingProxyType
from typing import TypeVar

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

__all__ = ["ENTRY_NAMES", "ChainProducts"]

ENTRY_NAMES = (
    *(f"r{i}{j}" for i in (1, 2, 3) for j in (1, 2, 3)),
    "px",
    "py",
    "pz",
)

Products = TypeVar("Products", bound="ChainProducts")


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
        self._left: dict[int, Rigid] = {}
        self._targets: dict[tuple[int, int], Rigid] = {}
        self.pose = self._pose(pose)
        self.elbow = self._elbow(values, kept) if dh.arm_angle else ()

    def over(self: Products, graph: ExpressionGraph) -> Products:
        """The same products over a graph that has all nodes of this one's."""
        other = copy(self)
        other.graph = graph
        other.variables = self.variables.over(graph)
        other._left, other._targets = dict(self._left), dict(self._targets)
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

    def before(self, k: int) -> Rigid:
        """`(A_1 ... A_k)^-1`-side product applied to the pose: `(A_1 ... A_k)^-1 T`."""
        if k == 0:
            return self.pose
        if k not in self._left:
            g, v = self.graph, self.variables
            start = self._run_start(k - 1)
            earlier = multiply(g, inverse(g, link(v, start)), self.before(start))
            self._left[k] = multiply(g, run_inverse(v, start, k - 1), earlier)
        return self._left[k]

    def left(self, k: int, m: int) -> Rigid:
        """The left side of the split (k, m)."""
        g, v = self.graph, self.variables
        head = self.before(k)
        if k < self.n:
            head = multiply(g, inverse(g, link(v, k)), head)
        return self._after(head, m)

    def _after(self, head: Rigid, m: int) -> Rigid:
        """`head * (A_{m+1} ... A_n)^-1`, from the right end inwards."""
        g, v = self.graph, self.variables
        if m < self.n:
            head = multiply(g, head, inverse(g, self.tool))
        pieces: list[Rigid] = []
        i = m
        while i < self.n:
            end = self._run_end(i)
            pieces.append(multiply(g, run_inverse(v, i, end), inverse(g, link(v, i))))
            i = end + 1
        for piece in reversed(pieces):
            head = multiply(g, head, piece)
        return head

    def right(self, k: int, m: int) -> Rigid:
        """`V_{k+1} C_{k+2} V_{k+2} ... V_m`, in cumulative angles."""
        g, v = self.graph, self.variables
        end = min(self._run_end(k), m - 1)
        product = run(v, k, end)
        i = end + 1
        while i < m:
            end = min(self._run_end(i), m - 1)
            product = multiply(g, product, multiply(g, link(v, i), run(v, i, end)))
            i = end + 1
        return multiply(g, product, self.tool) if m == self.n else product

    def right_inverse(self, k: int, m: int) -> Rigid:
        """The inverse of `right`, built from the other end so that the first joint's angle is not in
        its position."""
        g, v = self.graph, self.variables
        product = inverse(g, self.tool) if m == self.n else identity(g)
        i = m - 1
        while i >= k:
            start = max(self._run_start(i), k)
            product = multiply(g, product, run_inverse(v, start, i))
            if start > k:
                product = multiply(g, product, inverse(g, link(v, start)))
            i = start - 1
        return product

    def _between(self, j: int, k: int) -> Rigid:
        """`A_{j+1} ... A_k C_{k+1}`; j is the start of a run."""
        g, v = self.graph, self.variables
        product = identity(g)
        i = j
        while i < k:
            end = min(self._run_end(i), k - 1)
            product = multiply(g, product, multiply(g, link(v, i), run(v, i, end)))
            i = end + 1
        return multiply(g, product, link(v, k))

    def _target(self, j: int, m: int) -> Rigid:
        """`(A_1 ... A_j)^-1 T (A_{m+1} ... A_n)^-1`."""
        if (j, m) not in self._targets:
            self._targets[j, m] = self._after(self.before(j), m)
        return self._targets[j, m]
