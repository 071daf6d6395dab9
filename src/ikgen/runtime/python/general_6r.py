"""All real solutions of six joints by an elimination, and the one of six revolute joints."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cmp_to_key

import numpy as np
from numpy.typing import NDArray

from ikgen.runtime.python.array_types import Array, Flags
from ikgen.runtime.python.back_substitution import complete_angles, null_angles
from ikgen.runtime.python.chain_kinematics import Chain, chain_of
from ikgen.runtime.python.hidden_angle import hidden_angles, loop_resultant
from ikgen.runtime.python.loop_equations import loop_constants, loop_equations
from ikgen.runtime.python.refinement import refine
from ikgen.runtime.python.rigid_motion import inverses, rotations_z
from ikgen.runtime.python.solve_policy import Policy
from ikgen.runtime.python.whole_pose import PoseTask

__all__ = [
    "Candidates",
    "Elimination",
    "Finder",
    "Plan",
    "Turning",
    "candidates",
    "distinct_rows",
    "refined_rows",
    "rows_of",
    "six_joint_rows",
    "six_joints",
]

Elimination = tuple[int, int, int]  # joint that the loop begins at, whether reversed or swapped
Turning = tuple[bool, ...]  # which of the six joints turn; the others slide
Candidates = tuple[NDArray[np.intp], Array, NDArray[np.intp], Flags]
Finder = Callable[[Array, Array, Elimination, Turning], Candidates]
_SIX = range(6)
_FARTHEST = 1e4  # of a slide, in arm lengths
# Beside a fold rows of several runs are one only where all have all their digits.
_THOROUGH = ((3, 1e-12, 0.1), (6, 1e-12, 1e-3), (30, 0.0, 0.0))


@dataclass(frozen=True)
class Plan:
    """How an arm is solved: its typical `length` (m), the `eliminations` that suit it, in order of
    preference, and the function that finds candidates by one of them."""

    length: float
    eliminations: tuple[Elimination, ...]
    turning: Turning
    find: Finder


def candidates(F: Array, T: Array, plan: Elimination, _: Turning) -> Candidates:
    """Approximate solutions for the poses T (N, 4, 4) by one plan: pose index (k,), joint angles
    (k, 6); how many solutions each pose has at least, and whether its roots are simple (N,)."""
    start, reverse, swap = plan
    order, C = loop_constants(F, T, start, reverse)
    E, left, right = loop_equations(C)
    mono = left.reshape(-1, 14, 3, 3).swapaxes(2, 3).reshape(-1, 14, 9) if swap else left
    M = loop_resultant(E, mono)
    pose, t3, least, simple = hidden_angles(E, mono, M, 0.03)
    if not len(pose):
        return pose, np.zeros((0, 6)), least, simple
    c, s = np.cos(t3)[:, None, None], np.sin(t3)[:, None, None]
    M0, M1, M2 = (rows_of(m, pose) for m in M)
    k, t45 = null_angles(M0 + c * M1 + s * M2)
    t = np.concatenate([t3[k, None], t45[:, ::-1] if swap else t45], axis=1)
    pose = pose[k]
    frames = [rows_of(c, pose) for c in C]
    angles = complete_angles(frames, rows_of(left, pose), rows_of(right, pose), t)
    q = np.empty_like(angles)
    q[:, order] = -angles if reverse else angles
    return pose, q, least, simple


def rows_of(rows: Array, pose: NDArray[np.intp]) -> Array:
    """Rows of poses, where they are not the same for all."""
    return rows[pose] if len(rows) > 1 else rows


def refined_rows(
    F: Array, turning: Turning, T: Array, q: Array, policy: Policy
) -> tuple[Array, Flags, Array]:
    """Newton steps from q (k, 6) to T (k, 4, 4): q, which arrived, and the errors before (k,)."""
    near = _slides_near(q, turning)
    chain, start = six_joints(F, turning), np.where(near[:, None], q, 0.0)
    thorough = replace(policy, refinement=_THOROUGH)
    q, arrived, before = refine(chain, PoseTask(1.0), _SIX, start, T, thorough)
    return q, arrived & near, np.where(near, before, np.inf)


def _slides_near(q: Array, turning: Turning) -> Flags:
    """Which rows (k, 6) have no slide far beyond the arm: there slides become parallel."""
    return np.asarray((np.array(turning) | (np.abs(q) < _FARTHEST)).all(axis=1))


def six_joints(F: Array, turning: Turning) -> Chain:
    """The chain of frames F (7, 4, 4), each joint turning or sliding."""
    return chain_of(F, tuple((i, turns, 1.0, 0.0) for i, turns in enumerate(turning)), 6)


def distinct_rows(q: Array, turning: Turning, coincident: float) -> Array:
    """The rows of q (k, 6), angles reduced to (-pi, pi], without repetitions and slides far beyond the arm:
    long slides count relative to their length."""
    turns = np.array(turning)
    q = np.where(turns, np.pi - np.mod(np.pi - q, 2.0 * np.pi), q)
    q = q[_slides_near(q, turning)]
    size = np.where(turns, 1.0, np.maximum(np.abs(q), 1.0))
    apart = np.abs(q[:, None] - q)
    apart = np.where(turns, np.abs(np.pi - np.abs(np.pi - apart)), apart / size).max(axis=2)
    return np.asarray(q[~np.tril(apart < coincident, -1).any(axis=1)], dtype=float)


def _displaced() -> Array:
    """A rotation of about 1e-3 rad, and as much of a translation (in arm lengths)."""
    X = np.eye(4)
    X[:3, :3] = (
        rotations_z(np.array(9e-4)) @ rotations_z(np.array(1.1e-3))[[2, 0, 1, 3]][:, [2, 0, 1, 3]]
    )[:3, :3]
    X[:3, 3] = 8e-4, -1.1e-3, 6e-4
    return X


def _compare(a: list[float], b: list[float]) -> int:
    """Sign of the first difference of two rows."""
    for x, y in zip(a, b):
        if abs(x - y) > 1e-7:
            return 1 if x > y else -1
    return 0


def _sorted(rows: Array, turning: Turning) -> Array:
    """Rows (k, 6) in an order that does not hang on how they were found; turns are cut at -1 rad, where no
    right angle lies."""
    keys = np.where(turning, np.mod(rows + 1.0, 2.0 * np.pi), rows).tolist()
    order = sorted(range(len(keys)), key=cmp_to_key(lambda i, k: _compare(keys[i], keys[k])))
    return np.asarray(rows[order])


def six_joint_rows(F: Array, plan: Plan, T: Array, policy: Policy) -> list[Array]:
    """All real solutions of `F_0 M_1 F_1 ... M_6 F_6 = T` for poses T (N, 4, 4).

    F (7, 4, 4) constant rigid transforms; M_i turns about z or moves along it. One run of the first is
    enough where its roots are real, apart and each a solution to many digits. Otherwise more runs follow,
    with the pose displaced to either side (where right angles make roots coincide they come apart, and
    Newton's method takes them back) and by the next elimination, until one finds all that is known and no
    more. Returns for every pose its joint values (k, 6), angles in (-pi, pi], sorted.
    """
    F, T = F.copy(), T.copy()
    F[:, :3, 3] /= plan.length
    T[:, :3, 3] /= plan.length
    found = [np.zeros((0, 6)) for _ in T]
    near = np.abs(T[:, :3]).max(axis=(1, 2), initial=0.0) < 1e6  # false for NaN
    todo = np.nonzero(near)[0]
    least = np.zeros(len(T), dtype=int)
    aside = _displaced()
    runs = [(one, X) for one in plan.eliminations for X in (None, aside, inverses(aside))]
    for number, (one, X) in enumerate(runs):
        if not len(todo):
            break
        exact = T[todo]
        pose, q, real, simple = plan.find(F, exact if X is None else exact @ X, one, plan.turning)
        if X is None:
            least[todo] = np.maximum(least[todo], real)
        if len(q):
            q, arrived, before = refined_rows(F, plan.turning, exact[pose], q, policy)
            simple[pose[before > 1e-5]] = False
            pose, q = pose[arrived], q[arrived]
        settled = np.zeros(len(todo), dtype=bool)
        for i, n in enumerate(todo):
            mine, known = (
                distinct_rows(q[pose == i], plan.turning, policy.coincident),
                len(found[n]),
            )
            both = np.concatenate([found[n], mine])
            found[n] = distinct_rows(both, plan.turning, policy.coincident) if known else mine
            count = len(found[n])
            enough = count % 2 == 0 and count >= least[n]
            alone = number == 0 and bool(simple[i]) and count == real[i] > 0
            settled[i] = enough and (alone or (number > 0 and len(mine) == known == count))
        todo = todo[~settled]
    unit = np.where(plan.turning, 1.0, plan.length)
    return [_sorted(rows, plan.turning) * unit for rows in found]
