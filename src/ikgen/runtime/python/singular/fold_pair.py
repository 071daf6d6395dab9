"""Solutions near a singularity, where Newton's method stalls.

The pose is taken to second order along the direction in which it moves least, to first order along the
others (Lyapunov and Schmidt's reduction; Golubitsky & Schaeffer 1985, I.3)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_tuples import some_of
from ikgen.runtime.python.arrays.array_types import Array, Flags
from ikgen.runtime.python.newton.arm_newton import linearized, moved_rows
from ikgen.runtime.python.newton.refinement import clipped, damped, normal_inverse, of_normal

__all__ = [
    "Reduced",
    "approach",
    "correct",
    "flow_and_others",
    "generic",
    "keeps_sense",
    "still_directions",
    "unit",
]

_ALONG = 1e-4  # rad or m: the way over which slopes are compared for the second derivative
_CLOSE = 1e-9  # rad or m: a step that is shorter is the last
_FAR = 0.3  # rad or m: a step, at most
_STEPS = 8
_TURNED = 0.5  # squared length of what is left of a unit direction that turned by 45 degrees


class Reduced(NamedTuple):
    """Rows `q` (k, dof); unit directions `still` (k, n) in which their poses move least, and `out` (k, m)
    of the errors in which no other direction moves them; what is `left` (k,) of the errors then, and how
    that grows along the still direction, its `slope` (k,)."""

    q: Array
    still: Array
    out: Array
    left: Array
    slope: Array


class _Others(NamedTuple):
    """The directions across the `still` one, and what that does to the pose: its `flow` (k, m)."""

    still: Array
    flow: Array
    V: Array
    normal: Array

    def take_away(self, z: Array) -> tuple[Array, Array]:
        """What they leave of z (k, m, i), by going (k, n, i)."""
        going = of_normal(np.linalg.solve, self.normal, self.V.transpose(0, 2, 1) @ z)
        return z - self.V @ going, going

    def moved(self, arm: Arm, q: Array, across: Array, along: Array | float) -> Array:
        """Rows q (k, dof) after a step."""
        return moved_rows(arm, q, clipped(across, _FAR) + along * self.still)


def generic(count: int, size: int) -> Array:
    """Directions (count, size) that are at right angles to none in particular."""
    return np.tile(1.0 + 0.1 * np.arange(size), (count, 1))


def still_directions(arm: Arm, slope: Array) -> Array:
    """The unit directions (k, n) in which poses of derivatives (k, m, n) move least."""
    return _still(slope, generic(len(slope), slope.shape[2]), arm.policy.least_damping)


def approach(arm: Arm, q: Array, T: Array, side: Array) -> tuple[Array, Array]:
    """From q (k, dof) towards the solution on one `side` (k,), 1 or -1, of the place where two may meet, or
    to where they nearly do; T (k, 4, 4). With it how far (k,) the first step led along the still direction:
    there it ends if the second order tells all."""
    q, going, lead = q.copy(), np.arange(len(q)), np.zeros(len(q))
    before: _Stepped | None = None
    for step in range(_STEPS):
        after = _step(arm, q[going], T[going], side[going], before)
        q[going] = after.q
        length = np.abs(after.along)
        if step == 0:
            lead = length
        on = length > _CLOSE
        going, before = going[on], some_of(after, on)
        if not len(going):
            break
    return q, lead


def correct(arm: Arm, at: Reduced, T: Array) -> tuple[Reduced, Array]:
    """After one step across the still directions, with what was left before it; how far (k,) the fastest
    joint goes.

    What the others make good of the still directions' flow turns these to where less moves the pose, as a
    step of inverse iteration does."""
    error, slope = linearized(arm, at.q, T)
    others = _across(slope, at.still, arm.policy.least_damping)
    sides = np.empty((*error.shape, 3))
    sides[:, :, 0], sides[:, :, 1], sides[:, :, 2] = error, at.out, others.flow
    taken, going = others.take_away(sides)
    still, size = unit(at.still - going[:, :, 2])
    out, remains = unit(taken[:, :, 1])
    turned = np.flatnonzero(~(remains**2 >= _TURNED))
    if len(turned):
        out[turned] = _oriented(out[turned], some_of(others, turned))
    left, _, grows = np.matmul(out[:, None, :], taken)[:, 0].T
    across = going[:, :, 0]
    q = others.moved(arm, at.q, across, 0.0)
    return Reduced(q, still, out, left, -grows / size), np.abs(across).max(axis=1)


def _oriented(out: Array, others: _Others) -> Array:
    """Unit directions (k, m) in the sense that goes with the still ones', however far `out` turned in a
    step."""
    if others.V.shape[1] != others.V.shape[2]:
        return out
    return np.where(keeps_sense(others.V, others.still, out)[:, None], out, -out)


def keeps_sense(V: Array, still: Array, out: Array) -> Flags:
    """Whether what others than the still directions (k, n) do to the pose, V (k, n, n), with `out` (k, n)
    for the still ones, keeps orientation (k,)."""
    turned = V + out[:, :, None] * still[:, None, :]
    with np.errstate(all="ignore"):
        return np.asarray(~(np.linalg.det(turned) < 0.0))


def _others(arm: Arm, slope: Array, still: Array) -> _Others:
    damping = arm.policy.least_damping
    return _across(slope, _still(slope, still, damping), damping)


def _across(slope: Array, still: Array, damping: float) -> _Others:
    flow, V = flow_and_others(slope, still)
    normal = V.transpose(0, 2, 1) @ V + still[:, :, None] * still[:, None, :]
    return _Others(still, flow, V, damped(normal, damping))


def flow_and_others(slope: Array, still: Array) -> tuple[Array, Array]:
    """What still directions (k, n) do to the pose (k, m), and the directions across them (k, m, n), by its
    derivatives (k, m, n)."""
    flow = np.matmul(slope, still[:, :, None])[:, :, 0]
    return flow, slope - flow[:, :, None] * still[:, None, :]


class _Stepped(NamedTuple):
    """Rows `q` (k, dof) after a step; the unit directions `still` (k, n) in which the pose moved least
    before it, and how far it went `along` them (k,); how these bend what of the error the others leave,
    `bend` (k, m), in the sense of the steps before."""

    q: Array
    still: Array
    along: Array
    bend: Array


def _step(arm: Arm, q: Array, T: Array, side: Array, before: _Stepped | None) -> _Stepped:
    """From q (k, dof) to one side, with directions in the sense of those of the step `before`. Behind an
    inflection what is left bends the other way, and its slopes have the other sense."""
    error, slope = linearized(arm, q, T)
    still = generic(len(q), slope.shape[2]) if before is None else before.still
    others = _others(arm, slope, still)
    there = others.moved(arm, q, np.zeros_like(still), _ALONG)
    _, beyond = linearized(arm, there, T)
    turned = np.einsum("kej,kj->ke", beyond - slope, others.still) / _ALONG
    taken, going = others.take_away(np.stack([error, turned, others.flow], axis=2))
    rest, bend, flow = np.moveaxis(taken, 2, 0)
    sense = np.ones(len(q))
    if before is not None:
        sense[(bend * before.bend).sum(axis=1) < 0.0] = -1.0
    x = _root(side * sense, rest, bend, flow)
    q = others.moved(arm, q, going[:, :, 0], x[:, None])
    return _Stepped(q, others.still, x, sense[:, None] * bend)


def _still(slope: Array, still: Array, damping: float) -> Array:
    """By four steps of inverse iteration, from what it was, which keeps its sense."""
    inverse = normal_inverse(slope, damping)
    size = np.trace(inverse, axis1=1, axis2=2)[:, None, None]
    inverse = inverse / size  # so that its powers do not overflow
    twice = inverse @ inverse
    return unit((twice @ (twice @ still[:, :, None]))[:, :, 0])[0]


def unit(v: Array) -> tuple[Array, Array]:
    """v (k, n) at unit length, and its length (k,)."""
    size = np.sqrt(np.add.reduce(v * v, axis=1))
    return v / size[:, None], size


def _root(side: Array, rest: Array, bend: Array, flow: Array) -> Array:
    """The root (k,) of s x + k x^2 / 2 = e on this side of the least error, along the direction that the
    others leave; where there is none, that least error itself."""
    k, s, e = (np.einsum("ke,ke->k", bend, v) for v in (bend, flow, rest))
    square = s * s + 2.0 * k * e
    p = s + np.copysign(np.sqrt(np.maximum(square, 0.0)), s)
    with np.errstate(all="ignore"):
        x = np.where(((s > 0.0) == (side > 0.0)) & (square > 0.0), 2.0 * e / p, -p / k)
    return np.asarray(np.clip(np.nan_to_num(np.where(k > 0.0, x, 0.0)), -_FAR, _FAR))
