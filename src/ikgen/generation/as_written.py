"""Closed forms of the file's own chain in place of those of its exact geometry, where they are as good.

A row of the file's own chain needs no Newton steps, and none is lost near singularities. What decides
is the number of branches: a constant that a two-branch form cannot do with is made exact.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from ikgen.emit.solver_module import CLOSE

if TYPE_CHECKING:
    from ikgen.model.dh import DHChain
    from ikgen.solver.solution_graph import SolutionGraph

__all__ = ["solve_as_written"]

_WORTH = 0.5
"""Where Newton steps follow all the same, the rows must come nearer to the file's by this factor."""


def solve_as_written(
    dh: DHChain, graph: SolutionGraph, attempt: Callable[[DHChain], SolutionGraph]
) -> tuple[DHChain, SolutionGraph]:
    """Rows nearer to the file's chain than `dh` and their solution, if it is as good as `graph`."""
    if max(dh.deviation) <= CLOSE:
        return dh, graph
    for written in _written(dh):
        other = attempt(written)
        if not other.open_joints and _as_good(other, graph):
            return written, other
    return dh, graph


def _written(dh: DHChain) -> Iterator[DHChain]:
    """The rows with as many constants as the file has them as may be, most first."""
    from ikgen.kinematics.kept import keep_constants, stray_lengths

    strays = stray_lengths(dh)
    if strays:
        whole = keep_constants(dh, strays)
        if max(whole.deviation) <= CLOSE:
            yield whole
    nearest = keep_constants(dh)
    if max(nearest.deviation) <= max(CLOSE, _WORTH * max(dh.deviation)):
        yield nearest


def _as_good(one: SolutionGraph, other: SolutionGraph) -> bool:
    """Whether a solution has no more branches than another and is no less sound."""
    if any(step.branches > 2 for step in one.steps) and not any(
        s.branches > 2 for s in other.steps
    ):
        return False
    branches = [math.prod(step.branches for step in graph.steps) for graph in (one, other)]
    return branches[0] <= branches[1] and _weak(one) <= _weak(other)


def _weak(graph: SolutionGraph) -> int:
    """Steps that fail at some regular configuration."""
    return sum(not step.sound for step in graph.steps)
