"""Closed forms of the file's own chain in place of those of its exact geometry, where they are as good.

A row of the file's own chain needs no Newton steps, and none is lost near singularities. What decides
is the number of branches: a constant that a two-branch form cannot do with is made exact.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterator
from typing import TYPE_CHECKING

from ikgen.emit.solver_module import CLOSE

if TYPE_CHECKING:
    from ikgen.kinematics.nearest import Constant
    from ikgen.model.dh import DHChain
    from ikgen.solver.solution_graph import SolutionGraph

__all__ = ["solve_as_written"]

SolveAmong = Callable[["DHChain", Collection[str] | None], "SolutionGraph"]

_ROUND_OFF = 1e-13
"""Deviation (rad or m) of rows that are the file's own. Where rows are right to `CLOSE` but no better,
those next to a fold, which moves by the root of it, are others than the file's."""

_NEAR = 1e-6
"""Deviation (rad or m) of exact geometry up to which nothing is gained by rows that are nearer, but need
Newton steps all the same: what they keep of the file breaks its singularities apart, and as much as they
are still off loses rows between the parts."""

_WORTH = 0.5
"""Where Newton steps follow all the same, the rows must come nearer to the file's by this factor."""


def solve_as_written(
    dh: DHChain, graph: SolutionGraph, attempt: SolveAmong, whole_pose: bool = True
) -> tuple[DHChain, SolutionGraph]:
    """Rows nearer to the file's chain than `dh` and their solution, if it is as good as `graph`.

    `attempt` solves a chain among the equations of some labels, or among all. What solved the exact
    geometry mostly solves the file's too, and one equation in ten is soon looked through. `whole_pose`:
    whether all of the pose is read; else base and tool stay turned as they are where others fail.
    """
    if max(dh.deviation) <= _ROUND_OFF:
        return dh, graph
    for written in _written(dh, whole_pose):
        for among in (_labels(graph), None):
            other = attempt(written, among)
            if not other.open_joints and _as_good(other, graph):
                return written, other
    return dh, graph


def _labels(graph: SolutionGraph) -> frozenset[str]:
    """Labels of the equations that the solution was chosen from."""
    candidates = (c for s in graph.steps for c in (s.candidate, *s.fallbacks, *s.rejected))
    return frozenset(e.label for c in candidates for e in c.sources)


def _written(dh: DHChain, whole_pose: bool) -> Iterator[DHChain]:
    """The rows with as many constants as the file has them as may be, most first; then, where Newton steps
    follow all the same, those that come nearest."""
    from ikgen.kinematics.kept import keep_constants, keep_ends, stray_lengths

    off = max(dh.deviation)
    enough = CLOSE if off > CLOSE else _ROUND_OFF
    ends = keep_ends(dh)
    if max(ends.deviation) <= _ROUND_OFF:  # no axis is off: only base and tool were taken as exact
        yield ends
    strays = stray_lengths(dh)
    if strays:
        whole = keep_constants(dh, strays)
        if max(whole.deviation) <= enough:
            yield whole
    nearest = keep_constants(dh)
    if max(nearest.deviation) <= enough:
        yield nearest
    elif off > _NEAR:
        yield from _nearer(dh, nearest, strays, whole_pose)


def _nearer(
    dh: DHChain, nearest: DHChain, strays: frozenset[Constant], whole_pose: bool
) -> Iterator[DHChain]:
    """Rows that come nearer to the file's, nearest first: of all constants, and of those that are no
    directions, as a closed form may need exact ones."""
    from ikgen.kinematics.kept import keep_lengths

    lengths = keep_lengths(dh, frozenset(), whole_pose)
    found = [nearest, lengths]
    if strays:
        strayed = keep_lengths(dh, strays, whole_pose)
        if max(strayed.deviation) <= _WORTH * min(max(one.deviation) for one in found):
            found.append(strayed)
    for one in sorted(found, key=lambda one: max(one.deviation)):
        if max(one.deviation) <= _WORTH * max(dh.deviation):
            yield one


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
