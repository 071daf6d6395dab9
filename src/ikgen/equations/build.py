"""All scalar equations of a chain: two-sided splits and their invariants.

For every 0 <= k < m <= n the matrix equation
`(A_1 ... A_k C_{k+1})^-1 T (C_{m+1} A_{m+1} ... A_n)^-1 = V_{k+1} C_{k+2} ... V_m`, where `A_i = C_i V_i`
with `C_i = Rx(alpha) Tx(a)` and `V_i = Rz(theta) Tz(d)` (IKBT eqs. 2-5 use m = n only). Added for each
split are the position of the inverse and the squared norms in which whole rotations drop out (IKBT's
x^2 y^2).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ikgen.equations.expression import Expr
from ikgen.equations.expression_graph import ExpressionGraph
from ikgen.equations.rigid import (
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

__all__ = ["Equation", "EquationSet"]

ENTRY_NAMES = (
    *(f"r{i}{j}" for i in (1, 2, 3) for j in (1, 2, 3)),
    "px",
    "py",
    "pz",
)


@dataclass(frozen=True, slots=True)
class Equation:
    """`left = right`: entry `entry` of the matrix equation that moves k joints to the left and keeps
    joints k+1..m on the right. Norms carry the entry names "p.p", "px2+py2", "qx2+qy2"."""

    left: Expr
    right: Expr
    k: int
    m: int
    entry: str

    @property
    def label(self) -> str:
        """Where the equation comes from, as the report prints it."""
        return f"({self.k},{self.m}) {self.entry}"

    @property
    def squared(self) -> bool:
        """Whether the equation is a sum of squares."""
        return "+" in self.entry or "." in self.entry


class EquationSet:
    """The scalar equations of `dh` over the graph's atoms.

    `pose` (probes, 4, 4) are the probes' poses in DH frames; `readable` names the entries of the pose
    that the task reads: the others are unknowns that nothing solves.
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
    ) -> None:
        self.graph = graph
        self.dh = dh
        self.n = len(dh.rows)
        self.variables = JointVariables(graph, dh, values)
        self.runs = runs_of(dh)
        self.readable = readable
        self.tool_on_right = tool_on_right
        self.tool = constant(graph, dh.X_tip) if tool_on_right else identity(graph)
        self._left: dict[int, Rigid] = {}
        self._targets: dict[tuple[int, int], Rigid] = {}
        self.pose = self._pose(pose)

    def _pose(self, values: NDArray[np.float64]) -> Rigid:
        g = self.graph

        def entry(name: str, probe: NDArray[np.float64]) -> Expr:
            return g.atom("pose", name, probe, unknown=name not in self.readable)

        rows = tuple(
            tuple(entry(f"r{i + 1}{j + 1}", values[:, i, j]) for j in range(3)) for i in range(3)
        )
        p = tuple(entry(f"p{'xyz'[i]}", values[:, i, 3]) for i in range(3))
        return Rigid(rows, p)

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

    def _stripped(self, k: int, m: int) -> tuple[Expr, ...]:
        """Position of `Tz(d_{k+1}) C_{k+2} ... V_m`: the right side without its first rotation."""
        g, v = self.graph, self.variables
        tail = identity(g)
        if k + 1 < m:
            tail = multiply(g, link(v, k + 1), self.right(k + 1, m))
        elif m == self.n:
            tail = self.tool
        return tail.p[0], tail.p[1], g.add(tail.p[2], v.row_distance(k))

    def _stripped_inverse(self, k: int, m: int) -> tuple[Expr, ...]:
        g, v = self.graph, self.variables
        tail = identity(g)
        if k + 1 < m:
            tail = multiply(g, inverse(g, link(v, m - 1)), self.right_inverse(k, m - 1))
        return tail.p[0], tail.p[1], g.sub(tail.p[2], v.row_distance(m - 1))

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

    def _offsets(self, k: int, m: int) -> Iterator[tuple[Rigid, list[Expr]]]:
        """Positions of frame m from frame k, unrotated: seen from every earlier run's first frame.

        Their norms do not depend on joints that turn the offset as a whole.
        """
        for j in range(k + 1):
            if j == self._run_start(j) or j == 0:
                target, start = self._target(j, m), self._between(j, k)
                pairs = zip(target.p, start.p, strict=True)
                yield target, [self.graph.sub(p, q) for p, q in pairs]

    def _norms(self, k: int, m: int, left: Rigid, q: list[Expr]) -> list[Equation]:
        g = self.graph

        def squares(parts: list[Expr]) -> Expr:
            return g.dot(parts, parts)

        w = self._stripped(k, m)
        norm = squares(list(w))
        out = [Equation(squares(d), norm, k, m, "p.p") for _, d in self._offsets(k, m)]
        out.append(Equation(squares(list(left.p[:2])), squares(list(w[:2])), k, m, "px2+py2"))
        if m < self.n or self.tool.p == identity(g).p:
            u = self._stripped_inverse(k, m)
            out.append(Equation(squares(q[:2]), squares(list(u[:2])), k, m, "qx2+qy2"))
        return out

    def split(self, k: int, m: int) -> list[Equation]:
        """The scalar equations of one split."""
        g = self.graph
        left, right = self.left(k, m), self.right(k, m)
        out = [
            Equation(left.R[i][j], right.R[i][j], k, m, f"r{i + 1}{j + 1}")
            for i in range(3)
            for j in range(3)
        ]
        out += [Equation(left.p[i], right.p[i], k, m, f"p{'xyz'[i]}") for i in range(3)]
        back = self.right_inverse(k, m)
        first: list[Expr] = []
        for target, offset in self._offsets(k, m):
            q = [g.neg(g.dot(target.column(i), offset)) for i in range(3)]
            first = first or q
            out += [Equation(q[i], back.p[i], k, m, f"q{'xyz'[i]}") for i in range(3)]
        return out + self._norms(k, m, left, first)

    @cached_property
    def equations(self) -> tuple[Equation, ...]:
        """Every equation whose sides differ as expressions, each pair of sides once."""
        seen: set[tuple[int, int]] = set()
        out: list[Equation] = []
        for k in range(self.n):
            for m in range(k + 1, self.n + 1):
                for e in self.split(k, m):
                    sides = (e.left.id, e.right.id)
                    if e.left is not e.right and sides not in seen:
                        seen.add(sides)
                        out.append(e)
        return tuple(out)
