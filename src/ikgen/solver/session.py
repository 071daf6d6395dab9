"""One solving session: what the tree's nodes read and write. No node knows another."""

from __future__ import annotations

import time
from collections.abc import Collection, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ikgen.algebra.expression import Expr
from ikgen.equations.equation_set import EquationSet
from ikgen.equations.knowledge import Knowledge, PolynomialEquation, Variable
from ikgen.equations.probes import Probes
from ikgen.kinematics.fixed_order import cosines, product, sines
from ikgen.solver.candidate import Candidate
from ikgen.solver.choice import Chooser, Step
from ikgen.solver.leaves import Leaf
from ikgen.solver.ranker import judge, rank_key

__all__ = ["Session", "Tick", "first_fork"]

MOST_UNKNOWNS = 2


@dataclass(frozen=True, slots=True)
class Tick:
    """What one node did in one round: for the report, `-v` and bug reports. `path` are the names from
    the tree's root to the node; `kind` is "leaf" or the composite's ("sequence", "selector", "or")."""

    round: int
    path: tuple[str, ...]
    kind: str
    outcome: str
    detail: str
    seconds: float

    @property
    def node(self) -> str:
        """The node's name."""
        return self.path[-1]


@dataclass
class Session:
    """State of a session. `collected` are the equations of the current round with few unknowns, `equations`
    those that leaves look at: the same, or what a transform made of them; unknowns that are `passed_over`
    are not to be the first that is solved with branches; `among` are the labels of the only equations to
    collect (None: all)."""

    system: EquationSet
    probes: Probes
    knowledge: Knowledge
    held: tuple[int, ...] = ()
    passed_over: Collection[Variable] = ()
    among: Collection[str] | None = None
    round: int = 0
    collected: list[PolynomialEquation] = field(default_factory=list)
    equations: list[PolynomialEquation] = field(default_factory=list)
    candidates: list[Candidate] = field(default_factory=list)
    steps: list[Step] = field(default_factory=list)
    ticks: list[Tick] = field(default_factory=list)
    _chooser: Chooser = field(init=False)
    _used: set[int] = field(default_factory=set)
    _forks: list[tuple[int, float]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self._chooser = Chooser(self.system, self.probes)

    def record(
        self, path: tuple[str, ...], kind: str, outcome: str, detail: str, started: float
    ) -> None:
        """Add a tick to the trace."""
        spent = time.perf_counter() - started
        self.ticks.append(Tick(self.round, path, kind, outcome, detail, spent))

    # -- targets --------------------------------------------------------------------------------

    def joint_variable(self, joint: int) -> Variable:
        """The variable of a joint."""
        return self.knowledge.joint_variable(joint)

    @property
    def open_joints(self) -> list[int]:
        """Joints not solved yet."""
        return [
            j
            for j in range(self.system.dh.dof)
            if not self.knowledge.is_known(self.joint_variable(j))
        ]

    def truth(self, variable: Variable) -> tuple[NDArray[np.float64], ...]:
        """The variable's generating values at the probes."""
        value = product(self.probes.values, np.array(variable.combination, dtype=float))
        return (cosines(value), sines(value)) if variable.kind == "angle" else (value,)

    def start(self) -> None:
        """Held joints are known from the start."""
        self.knowledge.refresh()
        for j in self.held:
            v = self.joint_variable(j)
            if v.kind == "angle":
                self.knowledge.learn_angle(v.combination)
            else:
                self.knowledge.learn_distance(j)

    # -- a round --------------------------------------------------------------------------------

    def collect(self) -> None:
        """The scalar equations with one or two unknowns (IKBT sorts its equations so)."""
        self.round += 1
        self.candidates = []
        k = self.knowledge
        out: list[PolynomialEquation] = []
        for e in self.system.equations:
            if self.among is not None and e.label not in self.among:
                continue
            if not 1 <= k.unknown_rank(e.left.support | e.right.support) <= MOST_UNKNOWNS:
                continue
            p = k.polynomial_equation(e)
            if p.unknowns:
                out.append(p)
        self.collected = self.equations = out

    def new_equations(self, made: list[PolynomialEquation]) -> None:
        """Equations that a transform made, in place of those that were looked at."""
        self.equations = made

    @property
    def unknowns(self) -> list[Variable]:
        """Unknowns that occur in the round's equations."""
        return sorted({v for e in self.equations for v in e.unknowns})

    def try_leaf(self, leaf: Leaf) -> int:
        """Let a leaf look at every unknown; keep what reproduces the probes. Returns how many."""
        kept = 0
        for unknown in self.unknowns:
            truth = self.truth(unknown)
            for c in leaf.find(self.equations, unknown, self.knowledge):
                judged = judge(c, truth, self.probes, self._used, self.weight_of)
                if judged is not None:
                    self.candidates.append(judged)
                    kept += 1
        return kept

    def choose(self, *, anything: bool = False) -> Step | None:
        """Take the best candidate that holds at every regular configuration, alone or with fallbacks
        where its divisor vanishes; failing that, with `anything`, the best there is."""
        ranked = sorted(filter(self._wanted, self.candidates), key=rank_key)
        step = self._chooser.choose(ranked, anything=anything)
        if step is not None:
            step = replace(step, round=self.round)
            self._accept(step)
        return step

    def _wanted(self, candidate: Candidate) -> bool:
        if self.knowledge.leaves_parts(candidate.unknown):
            return False
        passed = candidate.unknown in self.passed_over
        return not passed or candidate.branches == 1 or first_fork(self.steps) is not None

    def _accept(self, step: Step) -> None:
        k = self.knowledge
        variable = step.candidate.unknown
        self.steps.append(step)
        for c in (step.candidate, *step.fallbacks):
            self._mark_used(c.coefficients)
        mask = k.known_mask
        if variable.kind == "angle":
            k.learn_angle(variable.combination)
        else:
            joint = variable.joint
            assert joint is not None
            k.learn_distance(joint)
        level = self._forks[-1][1] if self._forks else 1.0
        if step.branches > 1 or not self._forks:
            level *= step.branches
        self._forks.append((k.known_mask & ~mask, level))

    def _mark_used(self, roots: tuple[Expr, ...]) -> None:
        stack = list(roots)
        while stack:
            node = stack.pop()
            if node.id not in self._used:
                self._used.add(node.id)
                stack.extend(node.args)

    def weight_of(self, support: int) -> float:
        """For how many branches an expression with this support is computed."""
        for mask, level in reversed(self._forks):
            if support & mask:
                return level
        return 1.0


def first_fork(steps: Sequence[Step]) -> Variable | None:
    """The first unknown that was solved with branches."""
    return next((s.candidate.unknown for s in steps if s.branches > 1), None)
