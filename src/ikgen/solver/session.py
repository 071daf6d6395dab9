"""One solving session: what the tree's nodes read and write. No node knows another."""

from __future__ import annotations

import time
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ikgen.equations.build import EquationSet
from ikgen.equations.expression import Expr
from ikgen.equations.knowledge import Knowledge, PolynomialEquation, Variable
from ikgen.equations.probes import Probes
from ikgen.solver.candidate import Candidate
from ikgen.solver.leaves import Leaf
from ikgen.solver.ranker import judge, rank_key
from ikgen.solver.soundness import conditions, weak_configurations

__all__ = ["Session", "Step", "Tick"]

MOST_UNKNOWNS = 2
MOST_TRIED = 6
MOST_FALLBACKS = 40
SAFE_MARGIN = 1e-3


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


@dataclass(frozen=True, slots=True)
class Step:
    """One solved unknown: the chosen candidate, fallbacks where its divisor vanishes at regular
    configurations, and the candidates that the ranker rejected."""

    candidate: Candidate
    fallbacks: tuple[Candidate, ...]
    rejected: tuple[Candidate, ...]

    @property
    def branches(self) -> int:
        """Number of alternatives, over all its forms."""
        return max(c.branches for c in (self.candidate, *self.fallbacks))


@dataclass
class Session:
    """State of a session. `equations` are those of the current round with few unknowns."""

    system: EquationSet
    probes: Probes
    knowledge: Knowledge
    held: tuple[int, ...] = ()
    round: int = 0
    equations: list[PolynomialEquation] = field(default_factory=list)
    candidates: list[Candidate] = field(default_factory=list)
    steps: list[Step] = field(default_factory=list)
    ticks: list[Tick] = field(default_factory=list)
    _weak: dict[tuple[object, ...], NDArray[np.float64]] = field(default_factory=dict)
    _used: set[int] = field(default_factory=set)
    _weight: dict[int, float] = field(default_factory=dict)
    _forks: list[tuple[int, float]] = field(default_factory=list)

    def record(
        self, path: tuple[str, ...], kind: str, outcome: str, detail: str, started: float
    ) -> None:
        """Add a tick to the trace."""
        spent = time.perf_counter() - started
        self.ticks.append(Tick(self.round, path, kind, outcome, detail, spent))

    # -- targets --------------------------------------------------------------------------------

    def joint_variable(self, joint: int) -> Variable:
        """The variable of a joint."""
        unit = self.knowledge.variables.unit(joint)
        revolute = self.knowledge.variables.primary[joint].revolute
        return Variable("angle" if revolute else "dist", unit)

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
        value = self.probes.values @ np.array(variable.key, dtype=float)
        return (np.cos(value), np.sin(value)) if variable.kind == "angle" else (value,)

    def start(self) -> None:
        """Held joints are known from the start."""
        self.knowledge.refresh()
        for j in self.held:
            v = self.joint_variable(j)
            if v.kind == "angle":
                self.knowledge.learn_angle(v.key)
            else:
                self.knowledge.learn_distance(j)

    # -- a round --------------------------------------------------------------------------------

    def collect(self) -> None:
        """The scalar equations with one or two unknowns (IKBT sorts its equations so)."""
        self.round += 1
        self.candidates = []
        self._weight = {}
        k = self.knowledge
        out: list[PolynomialEquation] = []
        for e in self.system.equations:
            if not 1 <= k.unknown_rank(e.left.support | e.right.support) <= MOST_UNKNOWNS:
                continue
            p = k.polynomial_equation(e)
            if p.unknowns:
                out.append(p)
        self.equations = out

    def new_equations(self, made: list[PolynomialEquation], *, keep: bool) -> None:
        """Equations that a transform made, beside the round's own or in their place."""
        self.equations = [*self.equations, *made] if keep else made

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
                judged = judge(c, truth, self.probes, self._used, _Weights(self))
                if judged is not None:
                    self.candidates.append(judged)
                    kept += 1
        return kept

    def choose(self, *, anything: bool = False) -> Step | None:
        """Take the best candidate that holds at every regular configuration, alone or with fallbacks
        where its divisor vanishes; failing that, with `anything`, the best there is."""
        ranked = sorted(self.candidates, key=rank_key)
        step = self._sound(ranked) or self._covered(ranked)
        if step is None and anything and ranked:
            simple = [c for c in ranked if c.branches <= 2 and not c.is_weak]
            quartic = [c for c in ranked if c.branches > 2 and not c.is_weak]
            best = (simple or quartic or ranked)[0]
            step = self._step(best, (), ranked)
        if step is not None:
            self._accept(step)
        return step

    def _step(
        self, best: Candidate, fallbacks: tuple[Candidate, ...], ranked: list[Candidate]
    ) -> Step:
        rejected = [c for c in ranked if c is not best and c.unknown == best.unknown]
        return Step(best, fallbacks, tuple(rejected[:8]))

    def _weak_at(self, candidate: Candidate) -> NDArray[np.float64]:
        """Regular configurations where a candidate fails, sought once."""
        key = (candidate.form, *(e.id for e in candidate.coefficients))
        if key not in self._weak:
            found = weak_configurations(candidate, self.system, self.probes)
            special = self.probes.values[: self.probes.regular]
            holds = self._holds(candidate, special)
            self._weak[key] = np.concatenate([found, special[~holds]])
        return self._weak[key]

    def _holds(self, candidate: Candidate, values: NDArray[np.float64]) -> NDArray[np.bool_]:
        """At which configurations (N, dof) a candidate is well-conditioned."""
        parts = conditions(candidate, self.system, values)
        sizes = [np.abs(p).max(axis=0) for p in parts]
        return np.asarray(np.all([s > SAFE_MARGIN for s in sizes], axis=0))

    def _sound(self, ranked: list[Candidate]) -> Step | None:
        tried = 0
        for c in ranked:
            if c.branches > 2 or c.is_weak:
                continue
            tried += 1
            found = weak_configurations(c, self.system, self.probes)
            if not len(found):
                return self._step(c, (), ranked)
            if tried >= MOST_TRIED:
                break
        return None

    def _covered(self, ranked: list[Candidate]) -> Step | None:
        """A weak candidate and others of the same unknown that hold where it does not."""
        tried: dict[Variable, int] = {}
        for best in ranked:
            tried[best.unknown] = tried.get(best.unknown, 0) + 1
            if best.branches > 2 or tried[best.unknown] > 2:
                continue
            same = [c for c in ranked if c.unknown == best.unknown and c.branches <= best.branches]
            fallbacks = self._fallbacks(best, same[:MOST_FALLBACKS])
            if fallbacks is not None:
                return self._step(best, fallbacks, ranked)
        return None

    def _fallbacks(self, best: Candidate, others: list[Candidate]) -> tuple[Candidate, ...] | None:
        """Candidates that cover all regular configurations where `best` fails; None if none do."""
        uncovered = self._weak_at(best)
        out: list[Candidate] = []
        while len(uncovered) and len(out) < 2:
            gains = [(int(self._holds(c, uncovered).sum()), -i) for i, c in enumerate(others)]
            gain, index = max(gains, default=(0, 0))
            if gain == 0:
                return None
            chosen = others[-index]
            out.append(chosen)
            uncovered = uncovered[~self._holds(chosen, uncovered)]
        return None if len(uncovered) else tuple(out)

    def _accept(self, step: Step) -> None:
        k = self.knowledge
        variable = step.candidate.unknown
        self.steps.append(step)
        for c in (step.candidate, *step.fallbacks):
            self._mark_used(c.coefficients)
        mask = k.known_mask
        if variable.kind == "angle":
            k.learn_angle(variable.key)
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


class _Weights(dict[int, float]):
    """Lazy mapping from support mask to number of branches."""

    def __init__(self, session: Session) -> None:
        super().__init__()
        self.session = session

    def get(self, support: int, default: float = 1.0) -> float:  # type: ignore[override]
        if support not in self:
            self[support] = self.session.weight_of(support)
        return self[support]
