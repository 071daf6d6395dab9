"""The arm under test as the checks see it: the oracle's kinematics, one task, limits and free
joints."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ikgen.model.arrays import Array
from ikgen.program.policy import LEVEL
from ikgen.runtime.python.held.arm_angle import ArmAngle
from ikgen.verify.oracle import Oracle
from ikgen.verify.screws import ScrewChain
from ikgen.verify.task_space import TaskSpace

__all__ = ["FAR_LIMIT", "REGULAR_SIGMA", "ArmUnderTest", "arm_under_test"]


REGULAR_SIGMA = 1e-3
"""Smallest singular value of the length-scaled task Jacobian above which a configuration is usually
regular."""

_LEAST_REGULAR = 1e-7

FAR_LIMIT = 1e3
"""Limits (rad or m) beyond this mean "none": files write 999999, where rounding alone moves the
tip."""

_UNBOUNDED_SLIDE = 1.0  # m: range sampled of a prismatic joint without limits


@dataclass(frozen=True, slots=True)
class ArmUnderTest:
    """`lower`, `upper` (dof,): limits in rad or m; `low`, `high`: the part of them that is sampled
    (at most one turn); `free`: indices of held joints; `active`: the others; `length` (m) scales
    metres against radians: the largest distance of the tip from the base that a random sample
    reached; `period` (dof,): as of the oracle, by which values are compared; `held`: names of what is
    held; `angle`: the arm angle, where that is held after the joints; `tilting`: whether the task reads the
    heading of an axis that the joints tilt more and less."""

    oracle: Oracle
    task: TaskSpace
    lower: Array
    upper: Array
    low: Array
    high: Array
    free: tuple[int, ...]
    active: tuple[int, ...]
    revolute: NDArray[np.bool_]
    period: Array
    screws: ScrewChain
    length: float
    held: tuple[str, ...] = ()
    angle: ArmAngle | None = None
    tilting: bool = False

    @property
    def rank(self) -> int:
        """How many freedoms the task fixes, the arm angle that is held among them, and the tilt of a
        heading that changes its length."""
        return self.task.rank + int(self.angle is not None) + int(self.tilting)

    @property
    def dof(self) -> int:
        """Number of actuated joints."""
        return len(self.lower)

    @property
    def different(self) -> NDArray[np.bool_]:
        """Which joints (dof,) turn so that each turn is another configuration: those that drive others by a
        gear, of 5 : 4 say. Their values count inside their limits."""
        return np.asarray(self.revolute & ~np.isfinite(self.period))

    @property
    def fastest(self) -> Array:
        """How many times as far (dof,) as a joint the fastest of what it drives moves, at least 1."""
        return np.asarray(np.max(np.abs(self.screws.A), axis=0, initial=1.0))

    def held_values(self, q: Array, poses: Array) -> Array | None:
        """What configurations (N, dof) at `poses` (N, 4, 4) have of it: (N, held); None where nothing is
        held."""
        if not self.held:
            return None
        values = q[:, list(self.free)]
        if self.angle is None:
            return values
        return np.concatenate([values, self.angle.of_rows(q, poses)[:, None]], axis=1)

    def held_off(self, q: Array, wanted: Array, poses: Array) -> Array:
        """How far rows (N, dof) are off what `wanted` (N, dof) have of it, both at `poses` (N, 4, 4): (N,),
        rad or m; of the arm angle what the elbow is off times its distance from the line to the wrist, over
        the square of the upper arm: near the line that is of the order of the pose's error."""
        off = np.abs(self.difference(q, wanted)[:, list(self.free)]).max(axis=1, initial=0.0)
        if self.angle is None:
            return np.asarray(off)
        angle = self.angle.of_rows(wanted, poses)
        apart = self.angle.beside_line(q, poses)
        radius = np.linalg.norm(apart, axis=1)
        there = radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        missed = radius * np.linalg.norm(apart - there, axis=1) / self.angle.upper**2
        return np.asarray(np.maximum(off, missed))

    def aims(self, q: Array, poses: Array) -> Array:
        """Poses (N, 4, 4), and what is held with them as q (N, dof) have it."""
        if self.angle is None:
            return poses
        return self.angle.aims(poses, self.angle.of_rows(q, poses)[:, None])

    def residual(self, q: Array, T: Array, aims: Array) -> Array:
        """Scaled errors (N, m) of configurations (N, dof), T their poses (N, 4, 4), from `aims`."""
        e = self.task.residual(T, aims)
        e[:, self.task.lengths] /= self.length
        if self.angle is None:
            return e
        more = self.angle.errors(q, aims)[0] * (self.angle.upper / self.length)
        return np.concatenate([e, more[:, None]], axis=1)

    def scaled_jacobian(self, q: Array, aims: Array | None = None) -> tuple[Array, Array]:
        """Tip poses (N, 4, 4) and the dimensionless task Jacobian (N, m, active joints), the arm angle's
        line at `aims`, by default at the poses."""
        T, J = self.screws.forward_and_jacobian(q)
        J[:, :3] /= self.length
        J *= np.where(self.revolute, 1.0, self.length)
        J = self.task.jacobian(T, J)[:, :, list(self.active)]
        if self.angle is None:
            return T, J
        line = self.angle.errors(q, self.aims(q, T) if aims is None else aims)[1]
        line = line[:, None, list(self.active)] * (self.angle.upper / self.length)
        return T, np.concatenate([J, line], axis=1)

    def sigma(self, q: Array) -> Array:
        """Smallest singular value (N,) of the scaled task Jacobian: 0 where the arm is singular."""
        if not len(q) or not self.active:
            return np.ones(len(q))
        values = np.linalg.svd(self.scaled_jacobian(q)[1], compute_uv=False)
        return np.asarray(values[:, min(self.rank, len(self.active)) - 1])

    def regular_above(self, usual: float = REGULAR_SIGMA) -> float:
        """Smallest singular value above which a configuration is regular: the `usual` one, or a tenth of
        what is typical of an arm that is nowhere far from singular, as one of links that are short beside
        a long one."""
        typical = np.median(self.sigma(self.uniform(np.random.default_rng(0), 64)))
        return min(usual, max(0.1 * float(typical), _LEAST_REGULAR))

    def difference(self, a: Array, b: Array) -> Array:
        """Joint-wise a - b, modulo the joints' periods."""
        d = a - b
        period = np.where(np.isfinite(self.period), self.period, 0.0)
        return np.asarray(d - period * np.rint(d / self.period))

    def unit_of(self, q: Array) -> Array:
        """What a tolerance on each value of q (…, dof) is relative to: a slide's size (m) where that
        is over 1 m, else 1."""
        return np.asarray(np.where(self.revolute, 1.0, np.maximum(1.0, np.abs(q))))

    def size_of(self, q: Array) -> Array:
        """What an error of the tip's position is relative to (m), for rows q (N, dof): the arm's length
        or the row's longest slide, at least 1."""
        longest = np.max(self.unit_of(q), axis=-1, initial=1.0)
        return np.asarray(np.maximum(longest, self.length))

    def distance(self, a: Array, b: Array) -> Array:
        """Largest joint-wise difference (rad, or m relative to `unit_of`) over the last axis, modulo
        whole turns."""
        apart = np.abs(self.difference(a, b)) / self.unit_of(b)
        return np.asarray(np.max(apart, axis=-1, initial=0.0))

    def within(self, q: Array, tolerance: float | Array = 0.0) -> NDArray[np.bool_]:
        """Which configurations (N,) lie inside the limits, but for a tolerance (of each joint)."""
        inside = (q >= self.lower - tolerance) & (q <= self.upper + tolerance)
        return np.asarray(np.all(inside, axis=-1))

    def uniform(self, rng: np.random.Generator, n: int, *, limits: bool = True) -> Array:
        """Random configurations (n, dof); without limits joints take their whole period."""
        whole, half = np.isfinite(self.period) & (not limits), 0.5 * self.period
        low, high = np.where(whole, -half, self.low), np.where(whole, half, self.high)
        return np.asarray(rng.uniform(low, high, size=(n, self.dof)))


def _sampled_range(lower: Array, upper: Array, period: Array) -> tuple[Array, Array]:
    """The part of the limits to sample: one period about the value nearest to 0, or 1 m to each
    side."""
    half = np.where(np.isfinite(period), 0.5 * period, _UNBOUNDED_SLIDE)
    unbounded = (np.abs(lower) > FAR_LIMIT) | (np.abs(upper) > FAR_LIMIT)
    wide = unbounded | (upper - lower > period)
    centre = np.clip(0.0, lower + half, np.maximum(upper - half, lower + half))
    return np.where(wide, centre - half, lower), np.where(wide, centre + half, upper)


def arm_under_test(
    oracle: Oracle,
    task: TaskSpace,
    limits: tuple[Array, Array],
    held: tuple[str, ...],
    angle: ArmAngle | None = None,
) -> ArmUnderTest:
    """Gather what the checks need; `limits` are (lower, upper), each (dof,), in rad or m. `held` names what
    is held: joints, and last the arm `angle` where there is one."""
    lower, upper = (np.asarray(bound, dtype=float) for bound in limits)
    screws, period = oracle.screws, oracle.periods(upper - lower)
    low, high = _sampled_range(lower, upper, period)
    free = tuple(oracle.joint_names.index(name) for name in held if name in oracle.joint_names)
    active = tuple(i for i in range(oracle.dof) if i not in free)
    probe = np.random.default_rng(0).uniform(low, high, size=(64, oracle.dof))
    tips = screws.forward(probe)
    length = max(float(np.max(np.linalg.norm(tips[:, :3, 3], axis=1))), 1e-3)
    tilting = task.orientation == "yaw" and bool(np.ptp(tips[:, 2, task.axis] ** 2) > LEVEL)
    return ArmUnderTest(
        oracle, task, lower, upper, low, high, free, active, oracle.revolute, period, screws, length,
        held, angle, tilting,
    )  # fmt: skip
