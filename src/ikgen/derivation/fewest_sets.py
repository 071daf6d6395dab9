"""The closed form with the fewest solution sets: no branch is asked for that never holds with the others.

A step whose branches another step decides leaves sets that can never reproduce a pose. Where poses of the
arm show fewer solutions than a form claims, those in which another unknown is the first that is solved with
branches are tried too.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from ikgen.equations.knowledge import Variable
    from ikgen.model.dh import DHChain
    from ikgen.program.statements import Program
    from ikgen.runtime.python.held.arm_angle import ArmAngle as HeldAngle
    from ikgen.solver.solution_graph import SolutionGraph

__all__ = ["with_fewest_sets"]

Solve = Callable[[tuple["Variable", ...]], "SolutionGraph"]

_POSES = 200
_SEED = 7
_TRIES = 3
"""Unknowns that are tried in place of the one that the ranker solves first with branches."""

_SAME = 1e-6
"""Solutions (rad, or m over the arm's size) nearer to each other than this are one."""


def with_fewest_sets(
    graph: SolutionGraph, lowered: Callable[[SolutionGraph], Program], solve: Solve
) -> tuple[SolutionGraph, Program]:
    """The graph of the fewest solution sets, and its program: `graph` where poses show as many solutions as
    it claims, else what `solve` makes of unknowns that are not to be the first with branches."""
    from ikgen.solver.session import first_fork

    best = latest = graph
    program = lowered(graph)
    passed: tuple[Variable, ...] = ()
    while best.sound and len(passed) < _TRIES and not _all_hold(best.dh, program):
        fork = first_fork(latest.steps)
        if fork is None or fork in passed:
            break
        passed = (*passed, fork)
        latest = solve(passed)
        if latest.sound and not latest.open_joints and _sets(latest) < _sets(best):
            best, program = latest, lowered(latest)
    return best, program


def _sets(graph: SolutionGraph) -> int:
    """Solution sets that a graph claims."""
    return int(np.prod([step.branches for step in graph.steps]))


def _all_hold(dh: DHChain, program: Program) -> bool:
    """Whether all solution sets that a program claims hold together at some pose; that they do is taken for
    granted of routines, whose number of roots follows from their equation."""
    if any(level.call for level in program.levels):
        return True
    return any(found == program.max_solutions for found in _counts(dh, program))


def _counts(dh: DHChain, program: Program) -> Iterator[int]:
    """Numbers of distinct solutions of poses: joints are at random values and at multiples of 90 degrees,
    where solutions of an arm with fewer than six joints meet that are apart elsewhere."""
    from ikgen.equations.probes import arm_size, dh_pose, in_ranges, quarters
    from ikgen.kinematics.fixed_order import product
    from ikgen.lowering.held_angle import held_angle
    from ikgen.program.interpret import run

    rng, size = np.random.default_rng(_SEED), arm_size(dh)
    revolute = np.array([dh.lead_row(j).revolute for j in range(dh.dof)])
    turns = in_ranges(dh, rng.uniform(-np.pi, np.pi, (_POSES, dh.dof)))
    values = np.where(revolute, turns, size * rng.uniform(0.3, 1.5, turns.shape))
    right = np.where(revolute, quarters(dh, rng.integers(-1, 3, values.shape)), 0.0)
    values = np.where(rng.random(values.shape) < rng.random((_POSES, 1)), right, values)
    poses = product(product(dh.X_base, dh_pose(dh, values)), dh.X_tip)
    angle = held_angle(dh)
    for value, pose in zip(values, poses, strict=True):
        rows = run(program, _inputs(dh, angle, value, pose))
        yield _distinct(np.array([row.q for row in rows]).reshape(-1, dh.dof), revolute, size)


def _inputs(
    dh: DHChain, angle: HeldAngle | None, values: NDArray[np.float64], pose: NDArray[np.float64]
) -> dict[str, float]:
    """What a program is handed at DH variables (dof,) and their pose (4, 4)."""
    from ikgen.program.inputs import ArmAngle, HeldValue, PoseEntry, SeedValue

    inputs = {PoseEntry(i, j).name: float(pose[i, j]) for i in range(3) for j in range(4)}
    for j, value in enumerate(values):
        row = dh.lead_row(j)
        inputs[HeldValue(j).name] = float(value - row.offset.value) / row.scale
        inputs[SeedValue(j).name] = 0.0
    if angle is not None:
        q = np.array([inputs[HeldValue(j).name] for j in range(dh.dof)])
        inputs[ArmAngle().name] = float(angle.of_rows(q, pose))
    return inputs


def _distinct(rows: NDArray[np.float64], revolute: NDArray[np.bool_], size: float) -> int:
    """How many of the rows (k, dof) are distinct, whole turns aside."""
    gap = np.abs(rows[:, None] - rows)
    turned = np.abs(np.pi - np.abs(np.pi - gap % (2.0 * np.pi)))
    apart = np.where(revolute, turned, gap / size).max(axis=-1, initial=0.0) > _SAME
    return sum(bool(np.all(apart[i, :i])) for i in range(len(rows)))
