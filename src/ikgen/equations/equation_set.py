"""All scalar equations of a chain: two-sided splits and their invariants.

For every 0 <= k < m <= n the matrix equation
`(A_1 ... A_k C_{k+1})^-1 T (C_{m+1} A_{m+1} ... A_n)^-1 = V_{k+1} C_{k+2} ... V_m`, where `A_i = C_i V_i`
with `C_i = Rx(alpha) Tx(a)` and `V_i = Rz(theta) Tz(d)` (IKBT eqs. 2-5 use m = n only). Added for each
split are the position of the inverse and the squared norms in which whole rotations drop out (IKBT's
x^2 y^2). Long chains are split at their moving joints only.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from functools import cached_property

from ikgen.algebra.expression import Expr
from ikgen.equations.elbow_equations import elbow_equations
from ikgen.equations.equation import Equation
from ikgen.equations.products import ChainProducts
from ikgen.equations.symbolic_transforms import Rigid, identity, multiply

__all__ = ["EquationSet"]

_LONGEST = 8
"""A chain with more rows is split at its moving joints only."""


class EquationSet(ChainProducts):
    """The scalar equations of a chain."""

    def _stripped(self, k: int, m: int) -> tuple[Expr, ...]:
        """Position of `Tz(d_{k+1}) C_{k+2} ... V_m`: the right side without its first rotation."""
        g, v = self.graph, self.variables
        tail = identity(g)
        if k + 1 < m:
            tail = multiply(g, self.link(k + 1), self.right(k + 1, m))
        elif m == self.n:
            tail = self.tool
        return tail.p[0], tail.p[1], g.add(tail.p[2], v.row_distance(k))

    def _stripped_inverse(self, k: int, m: int) -> tuple[Expr, ...]:
        g, v = self.graph, self.variables
        tail = identity(g)
        if k + 1 < m:
            tail = multiply(g, self._link_inverse(m - 1), self.right_inverse(k, m - 1))
        return tail.p[0], tail.p[1], g.sub(tail.p[2], v.row_distance(m - 1))

    def _offsets(self, k: int, m: int) -> Iterator[tuple[Rigid, list[Expr]]]:
        """Positions of frame m from frame k, unrotated: seen from every earlier run's first frame.

        Their norms do not depend on joints that turn the offset as a whole.
        """
        for j in range(k + 1):
            if j == 0 or (j == self._run_start(j) and self._splits_at(j)):
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

    def _splits_at(self, i: int) -> bool:
        """Whether the chain is split at row i. Those at held joints say what the moving ones' do, turned by
        what is known, in other forms: some arms need them. Long chains, where their number would grow with
        every joint held, do without."""
        dh = self.dh
        return self.n <= _LONGEST or dh.joints[dh.rows[i].driver].name not in dh.free

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
        rows = [i for i in range(self.n) if self._splits_at(i)]
        splits = (self.split(k, i + 1) for k in rows for i in rows if i >= k)
        more = elbow_equations(self) if self.elbow else ()
        for e in itertools.chain(itertools.chain.from_iterable(splits), more):
            sides = (e.left.id, e.right.id)
            if e.left is not e.right and sides not in seen:
                seen.add(sides)
                out.append(e)
        return tuple(out)
