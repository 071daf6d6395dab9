"""Versions of each unknown (theta_{3s1}, theta_{3s2}, ...) and the sets that make whole poses.

IKBT's grouping of variables: an unknown has one version for every choice of branches among what it
depends on and its own.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass

from ikgen.equations.knowledge import Variable
from ikgen.solver.solution_graph import SolutionGraph

__all__ = ["Versions", "versions_of"]


@dataclass(frozen=True, slots=True)
class Versions:
    """`forks`: unknowns with more than one branch, in the order solved, and how many. `within`:
    which of them each unknown depends on, itself included."""

    forks: tuple[tuple[Variable, int], ...]
    within: dict[Variable, tuple[int, ...]]
    parents: dict[Variable, tuple[Variable, ...]]

    def count(self, v: Variable) -> int:
        """Number of versions of an unknown."""
        total = 1
        for f in self.within[v]:
            total *= self.forks[f][1]
        return total

    @property
    def poses(self) -> int:
        """Number of pose sets."""
        total = 1
        for _, branches in self.forks:
            total *= branches
        return total

    def choices(self, v: Variable) -> list[tuple[int, ...]]:
        """The branches chosen, for every version of an unknown."""
        return list(itertools.product(*(range(self.forks[f][1]) for f in self.within[v])))

    def number(self, v: Variable, chosen: dict[int, int]) -> int:
        """The version's number (from 1) when fork f takes branch `chosen[f]`."""
        index = 0
        for f in self.within[v]:
            index = index * self.forks[f][1] + chosen[f]
        return index + 1

    def label(self, v: Variable, chosen: dict[int, int]) -> str:
        """s3, or nothing where there is one version only."""
        return f"s{self.number(v, chosen)}" if self.count(v) > 1 else ""

    def sets(self) -> list[dict[int, int]]:
        """Every choice of branches: one pose set each."""
        ranges = [range(branches) for _, branches in self.forks]
        return [dict(enumerate(choice)) for choice in itertools.product(*ranges)]


def versions_of(graph: SolutionGraph) -> Versions:
    """The versions of the solved unknowns and of the joints that follow from them."""
    parents = {v: tuple(sorted(above, key=_place)) for v, above in graph.parents}
    forks = tuple((s.candidate.unknown, s.branches) for s in graph.steps if s.branches > 1)
    place = {v: f for f, (v, _) in enumerate(forks)}
    within: dict[Variable, tuple[int, ...]] = {}
    for v, above in graph.parents:
        found = {f for p in above for f in within.get(p, ())}
        if v in place:
            found.add(place[v])
        within[v] = tuple(sorted(found))
    return Versions(forks, within, parents)


def _place(v: Variable) -> tuple[int, ...]:
    """Base to tip."""
    return tuple(j for j, k in enumerate(v.combination) if k)
