"""The solution graph: solved unknowns, their direct parents, and how joints follow from them."""

from __future__ import annotations

from dataclasses import dataclass, field

from ikgen.algebra.dependencies import dependencies
from ikgen.algebra.expression import Expr
from ikgen.equations.knowledge import Knowledge, Variable
from ikgen.equations.probes import Probes
from ikgen.model.dh import DHChain
from ikgen.solver.choice import Step
from ikgen.solver.session import Session, Tick

__all__ = ["SolutionGraph", "graph_of"]


@dataclass(frozen=True, slots=True)
class SolutionGraph:
    """A finished derivation; nothing that uses it changes it.

    `steps` are in the order solved; `parents` (variable -> direct parents, redundant ones pruned) over
    solved unknowns and joints; `passed` are sums of angles that no unknown has as a parent: they bring
    no branch of their own, so what is computed from them has their parents instead. `open_joints` have
    no closed form, `held` have their values given. `probes` are the configurations that the derivation
    looked at, `ticks` what each node of the behavior tree did, `outline` the paths of its nodes.
    """

    dh: DHChain
    steps: tuple[Step, ...]
    parents: tuple[tuple[Variable, tuple[Variable, ...]], ...]
    passed: tuple[Variable, ...]
    open_joints: tuple[int, ...]
    held: tuple[int, ...]
    probes: Probes
    ticks: tuple[Tick, ...]
    _known: Knowledge = field(repr=False, compare=False)
    outline: tuple[tuple[str, ...], ...] = ()

    def workspace(self) -> Knowledge:
        """What was known at the end, over an expression graph of its own that may grow."""
        return self._known.workspace()

    def joint_variable(self, joint: int) -> Variable:
        """The variable of a joint."""
        return self._known.joint_variable(joint)

    @property
    def order(self) -> tuple[str, ...]:
        """The unknowns in the order solved, each with its leaf."""
        return tuple(f"{s.candidate.unknown.text} ({s.candidate.leaf})" for s in self.steps)

    @property
    def sound(self) -> bool:
        """Whether every step holds at all regular configurations that were looked at."""
        return all(step.sound for step in self.steps)


def _variables_in(roots: tuple[Expr, ...], knowledge: Knowledge) -> set[Variable]:
    """Solved variables that expressions depend on, derived angles replaced by what they come from."""
    found: set[Variable] = set()
    for node in dependencies(roots, knowledge.binding):
        if node.id in knowledge.binding or node.atom is None:
            continue
        if node.atom.kind in ("cos", "sin"):
            assert not isinstance(node.atom.key, str)
            found.add(Variable("angle", node.atom.key))
        elif node.atom.kind == "prismatic":
            assert not isinstance(node.atom.key, str)
            found.add(Variable("prismatic", node.atom.key))
    return found


def _prune(direct: dict[Variable, set[Variable]]) -> dict[Variable, tuple[Variable, ...]]:
    """Drop a parent that another parent depends on already (IKBT, redundancy detection)."""
    ancestors: dict[Variable, set[Variable]] = {}
    for child, parents in direct.items():
        found: set[Variable] = set()
        for p in parents:
            found |= {p} | ancestors.get(p, set())
        ancestors[child] = found
    out: dict[Variable, tuple[Variable, ...]] = {}
    for child, parents in direct.items():
        above = set().union(*(ancestors.get(p, set()) for p in parents)) if parents else set()
        out[child] = tuple(sorted(parents - above))
    return out


def _through(
    direct: dict[Variable, set[Variable]], passed: frozenset[Variable]
) -> dict[Variable, set[Variable]]:
    """Put the parents of `passed` unknowns in their place."""
    out: dict[Variable, set[Variable]] = {}
    for child, parents in direct.items():
        out[child] = set().union(*(out[p] if p in passed else {p} for p in parents))
    return out


def graph_of(session: Session) -> SolutionGraph:
    """The graph of a finished session."""
    k = session.knowledge
    direct: dict[Variable, set[Variable]] = {}
    for step in session.steps:
        roots = tuple(e for c in (step.candidate, *step.fallbacks) for e in c.coefficients)
        direct[step.candidate.unknown] = _variables_in(roots, k)
    for joint in range(session.system.dh.dof):
        variable = session.joint_variable(joint)
        if variable.kind == "angle" and variable not in direct:
            pair = k.known_pair(variable.combination)
            if pair is not None:
                direct[variable] = _variables_in(pair, k) - {variable}
    passed = frozenset(
        step.candidate.unknown
        for step in session.steps
        if step.candidate.unknown.joint is None and step.branches == 1
    )
    parents = tuple(_prune(_through(direct, passed)).items())
    return SolutionGraph(
        dh=session.system.dh,
        steps=tuple(session.steps),
        parents=parents,
        passed=tuple(sorted(passed)),
        open_joints=tuple(session.open_joints),
        held=session.held,
        probes=session.probes,
        ticks=tuple(session.ticks),
        _known=k.workspace(),
    )
