"""Candidates constructed from an arm's own angles: right everywhere but where a test wants them not."""

from __future__ import annotations

import math

import numpy as np
from tests.support.tables import table

from ikgen.algebra.expression import Expr
from ikgen.algebra.expression_graph import ExpressionGraph
from ikgen.equations.equation import Equation
from ikgen.equations.equation_set import EquationSet
from ikgen.equations.knowledge import Variable
from ikgen.equations.probes import make_probes
from ikgen.forms.form import Form
from ikgen.forms.pair_form import LinearPair
from ikgen.forms.quartic_form import TrigQuartic
from ikgen.forms.sine_cosine_form import SineCosine
from ikgen.forms.tangent_form import Tangent
from ikgen.solver.candidate import Candidate
from ikgen.solver.ranker import judge

__all__ = ["Constructed"]


class Constructed:
    """An arm of three axes; candidates for its first angle, whose coefficients are made of the cosines
    and sines of the angles themselves."""

    def __init__(self) -> None:
        self.dh = table(("R", "0", 0.0, 0.1), ("R", "1", 0.4, 0.0), ("R", "1", 0.3, 0.2))
        self.probes = make_probes(self.dh)
        self.graph = ExpressionGraph(len(self.probes.values))
        self.system = EquationSet(self.graph, self.dh, self.probes.values, self.probes.pose)
        variables = self.system.variables
        self.c1, self.s1 = variables.pair((1, 0, 0))
        self.c2, self.s2 = variables.pair((0, 1, 0))
        angle = self.probes.values[:, 0]
        self.truth = (np.cos(angle), np.sin(angle))

    def candidate(self, form: Form, leaf: str = "tangent", squared: bool = False) -> Candidate:
        """A candidate of this form for the first angle; `squared`: from a sum of squares."""
        source = Equation(self.c1, self.s1, 0, 1, "px2+py2" if squared else "px")
        return Candidate(Variable("angle", (1, 0, 0)), leaf, form, (source,))

    def judged(self, candidate: Candidate) -> Candidate | None:
        """The ranker's judgement of it."""
        return judge(candidate, self.truth, self.probes, set(), lambda _: 1.0)

    def found(self, form: Form, leaf: str = "tangent") -> Candidate:
        """A judged candidate of this form."""
        judged = self.judged(self.candidate(form, leaf))
        assert judged is not None
        return judged

    def tangent(self, factor: Expr) -> Tangent:
        """`factor * (cos, sin)` of the first angle: fails where the factor vanishes."""
        return Tangent(self.graph.mul(factor, self.c1), self.graph.mul(factor, self.s1))

    def pair(self, factor: Expr) -> LinearPair:
        """`factor cos = ..., factor sin = ...`: one branch, fails where the factor vanishes."""
        g = self.graph
        left, right = g.mul(factor, self.c1), g.mul(factor, self.s1)
        return LinearPair(factor, g.zero, left, g.zero, factor, right)

    def folding(self) -> SineCosine:
        """`cos(q1 - q2)` given: the branches meet where the two angles are equal or opposite."""
        g = self.graph
        return SineCosine(self.c2, self.s2, g.dot([self.c2, self.s2], [self.c1, self.s1]))

    def paired(self, apart: float) -> TrigQuartic:
        """`sin(u - q1) sin(u - q1 - apart) = 0`, doubled: two pairs of roots."""
        g, c, s = self.graph, math.cos(apart), math.sin(apart)
        twice_c = g.sub(g.square(self.c1), g.square(self.s1))
        twice_s = g.mul(g.const(2.0), g.mul(self.c1, self.s1))
        a2 = g.dot([g.const(-c), g.const(s)], [twice_c, twice_s])
        b2 = g.dot([g.const(-s), g.const(-c)], [twice_c, twice_s])
        return TrigQuartic(a2, b2, g.zero, g.zero, g.const(c))

    def quartic(self) -> TrigQuartic:
        """`sin(u - q1) = 0` as a form with four branches."""
        g = self.graph
        return TrigQuartic(g.zero, g.zero, g.neg(self.s1), self.c1, g.zero)
