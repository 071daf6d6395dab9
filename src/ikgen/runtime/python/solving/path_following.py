"""Joint values along a path of poses, on one branch."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import inf
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ikgen.runtime.python.arguments.joint_arguments import seed_rows
from ikgen.runtime.python.arguments.pose_arguments import poses_in_line
from ikgen.runtime.python.arguments.pose_faults import too_far
from ikgen.runtime.python.arm.chain_kinematics import tip_and_jacobian
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_types import Array, Flags
from ikgen.runtime.python.newton.refinement import smallest_singular_values
from ikgen.runtime.python.rows.solutions import Solutions, Status
from ikgen.runtime.python.solving.pose_between import pose_between
from ikgen.runtime.python.solving.pose_solving import solve_pose

__all__ = ["Path", "follow_poses"]

_Search = Callable[[Array, Array, bool], Solutions]

_DEEPEST = 24  # how often the way from one pose to the next is halved
_SHALLOW = 9  # how often the way to a pose without rows is halved
_MOST = 1000  # steps from one pose to the next, where rows follow at no length
_FARTHEST = 0.3  # rad or m that a joint may move at once
_AWAY = 1.0  # rad or m by which joints turn around a singularity, where another row is next to the last one
_OFF = 0.2  # share of the motion that a row may be from where the Jacobian leads
_LEAST_OFF = 1e-4  # rad or m that a row may be from where the Jacobian leads in any case
_NEWTON_STEPS = 30
_BESIDE_START = 0.1  # rad or m that the first row may be from the start
_DAMPING = 1e-8  # damping of steps that shall arrive, also along directions that are all but lost
_LEAST_DAMPING = 1e-14  # damping of steps that shall tell how far the next row is
_JUMP = 0.05  # rad or m that a row may be from the last one where halving does not help


@dataclass(frozen=True, eq=False)
class Path:
    """Joint values `q` (N, DOF) along N poses, on one branch and without leaps of whole turns; NaN from
    the first that was not reached. `reached`: how many were; `status`: OK for all of them, else why the
    next was not, SINGULAR where its rows are a leap away. `singular` (N,): the row is at a singularity,
    or was reached across one."""

    q: Array
    reached: int
    status: Status
    singular: Flags


def follow_poses(
    arm: Arm,
    search: _Search,
    poses: Any,
    start: ArrayLike,
    limits: bool,
) -> Path:
    """From the row of the first pose (N, 4, 4) that is nearest to `start` (dof,); `search(pose, start,
    limits)`: rows nearest to it first. Raises ValueError for bad arguments."""
    T, dof = poses_in_line(poses, arm.task.alone), len(arm.lower)
    row = seed_rows(arm, start, (dof,), name="start")
    q, singular = np.full((len(T), dof), np.nan), np.zeros(len(T), dtype=bool)
    walk, before = _Walk(arm, search, limits), np.eye(4)
    for i, lines in enumerate(T.tolist()):
        walk.crossed = False
        read = arm.task.read(lines, arm.policy)
        pose = np.array(lines if read is None else read)
        if read is None:
            far = too_far(arm.task, T[i : i + 1], arm.policy)[0]
            status = Status.UNREACHABLE if far else Status.INVALID
        elif i:
            status = walk.go_on(before, pose)
        else:
            status = walk.begin(pose, row)
        if status is not Status.OK:
            return Path(q, i, status, singular)
        q[i], singular[i], before = walk.q, walk.crossed, pose
    return Path(q, len(T), Status.OK, singular)


class _Walk:
    """`q`: where the arm is, `singular`: at a singularity; `crossed`: whether it came across one since that
    was last unset."""

    def __init__(self, arm: Arm, search: _Search, limits: bool) -> None:
        self.arm, self.search, self.limits = arm, search, limits
        self.q: Array = np.zeros(len(arm.lower))
        self.crossed = self.singular = False
        self.left = _MOST

    def begin(self, pose: Array, start: Array) -> Status:
        """To the row next to the start, or the best that a search finds."""
        self.q = start
        if self.arm.free_joints:
            rows, flags, *_ = self._unstopped(pose)
            if len(rows) and np.abs(rows[0] - start).max() < _BESIDE_START:
                self.crossed = bool(flags[0])
                return self._arrive(rows[0], pose)
        found = self.search(pose, start, self.limits)
        if len(found):
            self.q, self.crossed = found.q[0], bool(found.singular[0])
        return found.status

    def go_on(self, before: Array, pose: Array) -> Status:
        """From a pose to the next; where halved steps lead far away or nowhere, as beside a singularity,
        to a row next to the last one if there is one: of arms with held joints also where these have
        other values than the shortest motion leads to."""
        here, self.left = self.q, _MOST
        status = self.step(before, pose, 0)
        if status is Status.OK and np.abs(self.q - here).max() < _AWAY:
            return status
        there, self.q = self.q, here
        rows, flags, why, _ = self._rows(pose)
        if self._beside(rows, flags, pose):
            return Status.OK
        if self.arm.free_joints and status is not Status.OK:
            found = self.search(pose, here, self.limits)
            if self._beside(found.q, found.singular, pose):
                return Status.OK
            if status is why is Status.UNREACHABLE and len(found):
                why = status = Status.SINGULAR
        self.q = there
        return why if status is Status.SINGULAR and not len(rows) else status

    def _beside(self, rows: Array, flags: Flags, pose: Array) -> bool:
        """To the row that is next to where the arm is, if one is inside the limits."""
        moved = np.abs(rows - self.q).max(axis=1)
        k = int(moved.argmin()) if len(rows) else -1
        if k < 0 or not moved[k] < _FARTHEST or self._arrive(rows[k], pose) is not Status.OK:
            return False
        self.crossed, self.singular = True, bool(flags[k])
        return True

    def step(self, before: Array, pose: Array, depth: int) -> Status:
        """From a pose to the next, with halved steps where the rows do not follow the Jacobian."""
        self.left -= 1
        rows, flags, status, expected = self._rows(pose)
        if len(rows):
            gap = np.abs(rows - expected).max(axis=1)
            k = int(gap.argmin())
            moved = float(np.abs(rows[k] - self.q).max())
            follows = moved < _FARTHEST and gap[k] < _LEAST_OFF + _OFF * moved
            across = follows and not flags[k] and self._across(rows[k])
            follows = follows and not (across and moved > _LEAST_OFF)
            if follows or (depth == _DEEPEST and moved < _JUMP):
                self.singular = bool(flags[k])
                self.crossed = self.crossed or self.singular or across or not follows
                return self._arrive(rows[k], pose)
            status = Status.SINGULAR
        if depth == _DEEPEST or self.left < 0 or (depth >= _SHALLOW and not len(rows)):
            return status
        middle = pose_between(before, pose)
        first = self.step(before, middle, depth + 1)
        return first if first is not Status.OK else self.step(middle, pose, depth + 1)

    def _across(self, row: Array) -> bool:
        """Whether a singularity lies between here and a row, as it does where the determinant changes its
        sign: of arms that hold no joint. Of none at one."""
        arm = self.arm
        if arm.free_joints or self.singular:
            return False
        a, b = arm.task.rows(*tip_and_jacobian(arm.chain, np.array([self.q, row])))
        return bool(np.linalg.det(a.T @ b) < 0.0)

    def _arrive(self, row: Array, pose: Array) -> Status:
        """To a row, if it is inside the limits on the turn that it came to, or to the one beside it that
        is: rounding may move it out."""
        policy = self.arm.policy
        if self.limits:
            off = self._outside(row)
            if policy.limit_tolerance < off <= policy.limit_reach:
                placed = solve_pose(self.arm, pose, None, row, True).q
                beside = placed[np.abs(placed - row).max(axis=1) < _LEAST_OFF]
                row, off = (beside[0], 0.0) if len(beside) else (row, off)
            if off > policy.limit_tolerance:
                return Status.LIMITS
            row = np.clip(row, self.arm.lower, self.arm.upper)
        self.q = row
        return Status.OK

    def _outside(self, rows: Array) -> Any:
        """How far rows (..., dof) are outside the limits, (...) in rad or m; negative inside."""
        return np.maximum(self.arm.lower - rows, rows - self.arm.upper).max(axis=-1)

    def _expected(self, pose: Array, stopped: Mapping[int, float]) -> Array:
        """Where the shortest motion by the Jacobian of joints that are not stopped leads."""
        at, moving = self._but_for(stopped)
        return at + self._motion(at, pose, moving, _LEAST_DAMPING)[0]

    def _but_for(self, stopped: Mapping[int, float]) -> tuple[Array, list[int]]:
        """Where the arm is but for joints that are stopped at values; the other joints."""
        at = self.q.copy()
        for j, value in stopped.items():
            at[j] = value
        return at, [j for j in range(len(at)) if j not in stopped]

    def _motion(
        self, q: Array, pose: Array, moving: list[int], damping: float
    ) -> tuple[Array, float]:
        """The shortest motion (dof,) of some joints that the Jacobian asks for, at most a radian or metre
        each; the error that it shall make good."""
        arm = self.arm
        here, J = tip_and_jacobian(arm.chain, q[None])
        error, rows = arm.task.error(here, pose[None])[0], arm.task.rows(here, J)[0][:, moving]
        normal = rows @ rows.T + damping * np.eye(len(rows))
        step = np.zeros(len(q))
        step[moving] = np.clip(rows.T @ np.linalg.solve(normal, error), -1.0, 1.0)
        return step, float(np.abs(error).max())

    def _rows(self, pose: Array) -> tuple[Array, Flags, Status, Array]:
        """All rows without limits; with held joints the one that those lead to which no limit stops. Last
        what is to be expected of the joints that move."""
        if self.arm.free_joints:
            return self._unstopped(pose)
        found = solve_pose(self.arm, pose, None, self.q, False)
        open_ = self._open(found.q)
        return found.q[open_], found.singular[open_], found.status, self._expected(pose, {})

    def _open(self, rows: Array) -> Flags:
        """Where rows (n, dof) go on: from a singularity, where branches meet, those inside the limits if
        there are any."""
        inside = self._outside(rows) <= self.arm.policy.limit_reach
        both = self.limits and inside.any() and not inside.all()
        return inside if both and self._singular(self.q[None])[0] else np.ones(len(rows), bool)

    def _unstopped(self, pose: Array) -> tuple[Array, Flags, Status, Array]:
        """The row next to the expected one that all joints reach together, those that it would take out
        of their limits stopped there; where their steps end beside the pose, as at a fold, all rows with
        what is held where they ended. Before, a joint is let go once if the error would shrink by its
        motion off its limit: those stopped first may be the wrong ones."""
        arm, stopped, released = self.arm, dict[int, float](), set[int]()
        low, high = np.array(arm.lower), np.array(arm.upper)
        while True:
            at, moving = self._but_for(stopped)
            q, error = self._newton(at, pose, moving)
            if error < arm.policy.arrived:
                excess = np.maximum(low - q, q - high)
                worst = int(excess.argmax())
                if not self.limits or excess[worst] <= arm.policy.limit_tolerance:
                    expected = self._expected(pose, stopped)
                    return q[None], self._singular(q[None]), Status.OK, expected
                stopped[worst] = float(low[worst] if q[worst] < low[worst] else high[worst])
                continue
            freed = self._pulled_off(q, pose, [j for j in stopped if j not in released])
            if freed is None:
                held = np.clip(q, low, high) if self.limits else q
                rows = solve_pose(arm, pose, None, held, False).q
                rows = rows[self._open(rows)]
                why = Status.LIMITS if stopped or released else Status.UNREACHABLE
                status = Status.OK if len(rows) else why
                return rows, self._singular(rows), status, self._expected(pose, {})
            released.add(freed)
            del stopped[freed]

    def _pulled_off(self, q: Array, pose: Array, stopped: list[int]) -> int | None:
        """The joint at its limit by whose motion off it the error shrinks most, if there is one."""
        arm = self.arm
        here, J = tip_and_jacobian(arm.chain, q[None])
        pull = arm.task.error(here, pose[None])[0] @ arm.task.rows(here, J)[0]
        inwards = {j: float(pull[j] if q[j] <= arm.lower[j] else -pull[j]) for j in stopped}
        best = max(inwards, key=inwards.__getitem__, default=None)
        return best if best is not None and inwards[best] > 0.0 else None

    def _singular(self, rows: Array) -> Flags:
        """Where all joints together lose a freedom (n,)."""
        arm = self.arm
        sigma = smallest_singular_values(arm.chain, arm.task, range(rows.shape[1]), rows, arm.rank)
        return np.asarray(sigma < arm.policy.singular_below)

    def _newton(self, q: Array, pose: Array, moving: list[int]) -> tuple[Array, float]:
        """The best row of shortest motions from q, and its error."""
        best, least = q, inf
        for i in range(_NEWTON_STEPS):
            step, error = self._motion(q, pose, moving, _DAMPING)
            slow = not error < 0.5 * least
            if error < least:
                best, least = q, error
            if (slow and i > 2) or least < self.arm.policy.converged:
                break
            q = q + step
        return best, least
