"""Chains solved once a process, for tests of what comes after their solution."""

from __future__ import annotations

import pickle
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from ikgen.model.dh import DHChain
from ikgen.report.leftover import leftover_text
from ikgen.solver.solution_graph import SolutionGraph
from ikgen.solver.solve import solve_chain

__all__ = ["left_over", "solved"]


def solved(
    dh: DHChain, *, progress: Callable[[str], None] | None = None, **options: Any
) -> SolutionGraph:
    """In the place of `solve_chain`, with ikgen's own leaves and tree: the graph of an equal chain with
    equal options where that was solved before."""
    graph, told = _first(pickle.dumps((dh, options)))
    for text in told if progress is not None else ():
        progress(text)
    return graph


@lru_cache(maxsize=100)
def _first(pickled: bytes) -> tuple[SolutionGraph, list[str]]:
    """The graph of a chain and options, and what it told as its progress."""
    dh, options = pickle.loads(pickled)
    told: list[str] = []
    return solve_chain(dh, progress=told.append, **options), told


def left_over(graph: SolutionGraph) -> list[str]:
    """In the place of `leftover_text`, which takes a second: the text on a graph asked of before."""
    return _text(_Same(graph))


@dataclass(frozen=True, eq=False, slots=True)
class _Same:
    """A graph that equals itself alone: to compare two takes long."""

    graph: SolutionGraph

    def __hash__(self) -> int:
        return id(self.graph)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Same) and self.graph is other.graph


@lru_cache(maxsize=20)
def _text(same: _Same) -> list[str]:
    return leftover_text(same.graph)
