"""All real solutions of six joints by an elimination, and the one of six revolute joints."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from ikgen.runtime.python.arm.chain_kinematics import Motion
from ikgen.runtime.python.arm.solve_policy import Policy
from ikgen.runtime.python.arm.whole_pose import PoseTask
from ikgen.runtime.python.arrays.array_types import Array, Flags, Index
from ikgen.runtime.python.elimination.back_substitution import complete_angles, middle_angles
from ikgen.runtime.python.elimination.displaced_poses import ASIDE, CLOSE, FARTHER
from ikgen.runtime.python.elimination.loop_equations import (
    joint_values,
    loop_constants,
    loop_equations,
)
from ikgen.runtime.python.elimination.six_joints import SixJoints, one_axis_each
from ikgen.runtime.python.newton.flat_steps import flat_steps
from ikgen.runtime.python.newton.refinement import refine, smallest_singular_values
from ikgen.runtime.python.rows.solution_rows import (
    Turning,
    distinct_rows,
    exact_first,
    first_of_equals,
    rows_of,
    slides_near,
    sorted_rows,
)

__all__ = [
    "DIRECT",
    "Candidates",
    "Elimination",
    "Finder",
    "Plan",
    "Way",
    "candidates",
    "enough_alone",
    "refined_rows",
    "six_joint_rows",
]

Elimination = tuple[int, int, int]
"""The joint that the loop begins at, whether it is reversed, and what its finder goes by besides: whether
the angles beside the hidden one are swapped, or a kind of `parallel_links`, or a coupled joint's degree."""
Candidates = tuple[Index, Array, Index, Flags]
Finder = Callable[[Sequence[Array], Array, Elimination, Turning], Candidates]
Way = tuple[Finder, Elimination, float]  # the last: how far off the pose exact candidates may be
_SIX = range(6)
# Error of a candidate from a root that is exact: a double one is off by the square root.
DIRECT = 1e-7
# Error of one that stalls where more than two solutions meet: steps get no closer there in reasonable time.
_STALLED = 1e-6
_OTHERS = 2  # the run from which other eliminations follow the first one
# Smallest singular value where solutions meet: rows keep few digits there, and so close together are one.
_MEETS, _CLOSE_BY = 1e-6, 1e-3
# Beside a fold rows of several runs are one only where all have all their digits.
_THOROUGH = ((3, 1e-12, 0.1), (6, 1e-12, 1e-3), (30, 0.0, 0.0))
_FINEST = ((3, 1e-13, 0.1), (6, 1e-13, 1e-3), (30, 0.0, 0.0))


@dataclass(frozen=True)
class Plan:
    """How an arm is solved: its typical `length` (m), the `eliminations` that suit it, in order of
    preference, and the function that finds candidates by one of them. `direct`: ways that its geometry
    allows besides, tried first. `motions`: those of the axes in their order along the chain where they are
    more than the six joints. `tool`: the tool's axis (0: x) that the last joint turns about, where that is
    none of the arm's."""

    length: float
    eliminations: tuple[Elimination, ...]
    turning: Turning
    find: Finder
    direct: tuple[Way, ...] = ()
    motions: tuple[Motion, ...] = ()
    tool: int | None = None

    @property
    def axes(self) -> tuple[Motion, ...]:
        """The motions of all axes."""
        return self.motions or one_axis_each(self.turning)


def candidates(F: Sequence[Array], T: Array, elimination: Elimination, _: Turning) -> Candidates:
    """Approximate solutions for the poses T (N, 4, 4) by one elimination: pose index (k,), joint
    angles (k, 6); how many solutions each pose has at least, -1 where it does not tell, and whether those
    are all (N,)."""
    start, reverse, swap = elimination
    order, C = loop_constants(F, T, start, reverse)
    E, left, right = loop_equations(C)
    pose, t, least, clear = middle_angles(E, left, swap)
    if not len(pose):
        return pose, np.zeros((0, 6)), least, clear
    angles = complete_angles(C, left, right, pose, t)
    return pose, joint_values(angles, order, reverse), least, clear


def refined_rows(
    six: SixJoints, plan: Plan, pose: Index, T: Array, q: Array, policy: Policy
) -> tuple[Array, Array, Array]:
    """Newton steps from q (k, 6) to T (k, 4, 4) of the poses with indices `pose` (k,): q, and the errors
    that they leave and those before (k,)."""
    near = slides_near(q, plan.turning)
    held = np.broadcast_to(rows_of(six.held, pose), (len(q), six.held.shape[1]))
    start = np.concatenate([np.where(near[:, None], q, 0.0), held], axis=1)
    thorough = _thorough(policy, bool(plan.motions))
    q, error, before, _ = refine(six.chain, PoseTask(1.0), _SIX, start, T, thorough)
    return q[:, :6], np.where(near, error, np.inf), np.where(near, before, np.inf)


def _followed(
    six: SixJoints, pose: Index, T: Array, q: Array, error: Array, policy: Policy
) -> tuple[Array, Array, Flags]:
    """Rows q (k, 6) to T (k, 4, 4) and their errors (k,), of which those that stalled (k,) beside a
    continuum went on along its curve, if that leads to a solution."""
    stalled = (error >= policy.arrived) & (error < _STALLED)
    flat = np.flatnonzero(stalled)
    if not len(flat):
        return q, error, stalled
    held = np.broadcast_to(rows_of(six.held, pose), (len(q), six.held.shape[1]))
    start = np.concatenate([q, held], axis=1)[flat]
    there, left = flat_steps(six.chain, PoseTask(1.0), _SIX, start, T[flat])
    arrived = left < policy.exact
    q[flat[arrived]], error[flat[arrived]] = there[arrived, :6], left[arrived]
    return q, error, stalled


@cache
def _thorough(policy: Policy, farther: bool) -> Policy:
    """With which candidates are refined; roots of a high degree come from `farther` off: of their rows all
    digits are wanted."""
    if farther:
        return replace(policy, refinement=_FINEST, converged=0.0)
    return replace(policy, refinement=_THOROUGH)


def _runs(plan: Plan) -> list[tuple[Way, tuple[Array | None, ...]]]:
    """One after the other what is tried, and the motions of the tool to the poses that it is tried at."""
    ways = [(plan.find, one, DIRECT) for one in plan.eliminations]
    runs: list[tuple[Way, tuple[Array | None, ...]]] = [(way, (None,)) for way in plan.direct]
    runs += [(ways[0], (None,)), (ways[0], ASIDE)]
    runs += [(way, (None, *ASIDE)) for way in ways[1:]]
    return runs + [(way, moves) for moves in (FARTHER, *CLOSE) for way in ways]


def six_joint_rows(
    six: SixJoints, plan: Plan, T: Array, policy: Policy
) -> tuple[Index, Array, Flags]:
    """All real solutions of the six joints for poses T (N, 4, 4): pose indices (k,) in order, joint values
    (k, 6), angles in (-pi, pi], sorted, and which poses (N,) may have more, or some though none was found.

    One run of the first is enough where its roots are clearly real, or clearly not, and lead to as many
    solutions, each to many digits. Otherwise more runs follow, with the pose displaced to both sides, by
    the next elimination and with the pose displaced by less, until they find all that is known and no more,
    an even number, none stalls near another, and one of the pose itself has kept its rank; so has the next
    elimination where solutions meet, displaced poses have more roots, or the pose's own do not tell.
    """
    T = T.copy()
    T[:, :3, 3] /= plan.length
    found, of = np.zeros((0, 6)), np.zeros(0, dtype=np.intp)
    todo = np.flatnonzero(np.abs(T[:, :3]).max(axis=(1, 2), initial=0.0) < 1e6)  # false for NaN
    hollow, unsure, blurred = np.zeros((3, size := len(T)), dtype=bool)
    least = np.full(size, -1)
    for number, (way, moves) in enumerate(_runs(plan)):
        if not len(todo):
            break
        (pose, q, before), real, clear, stalled = _run(six, plan, way, moves, T, todo, policy)
        own, run = moves[0] is None, number - len(plan.direct)
        beside = _noted(real, clear, todo, own, run, (least, unsure, blurred))
        q, pose, exact = exact_first(q, pose, before < way[2], plan.turning, policy.coincident)
        mine = np.bincount(pose, minlength=size)[todo]
        if number == 0:
            direct = np.bincount(pose[exact], minlength=size)[todo]
            settled = enough_alone(real[0], clear, mine, direct)
            found, of, count = q, pose, mine
            hollow[todo] = (real[0] > 0) & (mine == 0)  # roots that led to nothing
        else:
            known, old = np.bincount(of, minlength=size)[todo], (found, of)
            both = np.concatenate([found, q]), np.concatenate([of, pose])
            found, of, _ = distinct_rows(*both, plan.turning, policy.coincident)
            count = np.bincount(of, minlength=size)[todo]
            ranked = (least[todo] >= 0) & ~stalled & (~hollow[todo] | (len(moves) > 1))
            settled = ranked & (mine == known) & (known == count) & (count % 2 == 0)
            others = run >= _OTHERS  # one alone may miss the same of a crowd twice
            settled &= others | (count >= beside) & ~blurred[todo]
            left = np.flatnonzero(ranked & others & ~settled)
            settled[left] = _same_apart(six, plan, todo[left], ((found, of), old, (q, pose)))
        settled &= (count >= least[todo]) & ((count > 0) | ~unsure[todo])
        todo = todo[~settled]
    more = _may_have_more(np.bincount(of, minlength=size) > 0, unsure, todo, least)
    return of, sorted_rows(found, of, plan.turning) * np.where(plan.turning, 1.0, plan.length), more


def enough_alone(real: Index, clear: Flags, count: Index, direct: Index) -> Flags:
    """Whether the first run is enough for poses (N,) of so many `real` roots, whether these are `clear`, by
    the `count` of its solutions, and of those that are exact."""
    even = (count > 0) & (count % 2 == 0)
    return np.asarray(clear & (direct == real) & (count == direct) & even)


def _noted(
    real: Index,
    clear: Flags,
    todo: Index,
    own: bool,
    run: int,
    marks: tuple[Index, Flags, Flags],
) -> Index:
    """Enters what a run, 0 where the first elimination begins, tells of the poses `todo` by its `real`
    roots (m, k), those of the pose itself first if it is its `own`: of all poses (N,) how many solutions
    there are at least, which may have some, whatever is found, and whose own roots do not tell. The most
    roots (k,) of a displaced pose.

    That a pose has none is believed of another elimination whose roots tell so clearly, if those of the
    first do too, or displaced poses have none either."""
    least, unsure, blurred = marks
    if own and run >= 0:
        least[todo] = np.maximum(least[todo], real[0])
        blurred[todo] |= (real[0] < 0) | ~clear
        unsure |= blurred
    beside: Index = real[int(own) :].max(axis=0, initial=0)
    unsure[todo] |= beside > 0
    if own and run >= _OTHERS:
        none = todo[clear & (real[0] == 0) & ((beside == 0) | ~blurred[todo])]
        unsure[none] = blurred[none] = False
    return beside


def _may_have_more(some: Flags, unsure: Flags, todo: Index, least: Index) -> Flags:
    """Which poses (N,), those with `some` solutions, may have more: of which no runs agreed, or where none
    was found though one left a doubt."""
    more = unsure & ~some
    more[todo] |= some[todo] | (least[todo] != 0)
    return np.asarray(more)


def _run(
    six: SixJoints,
    plan: Plan,
    way: Way,
    moves: tuple[Array | None, ...],
    T: Array,
    todo: Index,
    policy: Policy,
) -> tuple[tuple[Index, Array, Array], Index, Flags, Flags]:
    """Solutions of the poses `todo` from one way at the poses that motions of the tool lead to: whose they
    are, rows (k, 6), and the errors (k,) of what steps came from; what the way tells of how many there are,
    and whether some stalled."""
    exact = T[todo]
    aims = np.concatenate([exact if X is None else exact @ X for X in moves])
    some = six.of(np.tile(todo, len(moves)))
    run, q, real, clear = way[0](some.frames, aims, way[1], plan.turning)
    which = run % len(todo)
    q, error, before = refined_rows(some, plan, run, exact[which], q, policy)
    q, error, short = _followed(some, run, exact[which], q, error, policy)
    stalled = np.bincount(which[short], minlength=len(todo)) > 0
    arrived = error < policy.arrived
    rows = todo[which[arrived]], q[arrived], before[arrived]
    return rows, real.reshape(len(moves), -1), clear[: len(todo)], stalled


def _same_apart(
    six: SixJoints, plan: Plan, some: Index, rows: Sequence[tuple[Array, Index]]
) -> Flags:
    """For which poses solutions meet in some rows of the first rows (k, 6) of poses (k,), and the others
    have as many: those close together where solutions meet count as one."""
    counts = []
    meet = np.zeros(len(some), dtype=bool)
    for q, of in rows:
        these = np.isin(of, some)
        q, pose = q[these], np.searchsorted(some, of[these])
        held = np.broadcast_to(rows_of(six.held, of[these]), (len(q), six.held.shape[1]))
        sigma = smallest_singular_values(
            six.chain, PoseTask(1.0), _SIX, np.concatenate([q, held], axis=1)
        )
        folds = sigma < _MEETS
        first = ~folds
        first[folds] = first_of_equals(q[folds], pose[folds], plan.turning, _CLOSE_BY)
        counts.append(np.bincount(pose[first], minlength=len(some)))
        if len(counts) == 1:
            meet = np.bincount(pose[folds], minlength=len(some)) > 0
    return np.asarray(meet & (counts[0] == counts[1]) & (counts[0] == counts[2]))
