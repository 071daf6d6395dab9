"""Curves on which rows move with the held value: beyond a fold the held value turns back.

Points are told apart by their share of the way along the chord between the two ends of a curve: by another
parameter than the held value it goes on smoothly past a fold (Keller 1977).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields

import numpy as np

from ikgen.runtime.python.arm.limit_margins import outside
from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.arrays.array_types import Array, Flags
from ikgen.runtime.python.newton.arm_newton import linearized
from ikgen.runtime.python.newton.refinement import errors_and_slopes, of_normal
from ikgen.runtime.python.rows.row_links import differences

__all__ = ["Arcs", "Points"]

_ENOUGH = 1e-10  # of an end
_TOUCHING = 1e-6  # rad or m between rows that are one
_FAR = 1.0  # rad or m by which steps may correct what a point's neighbour foretells
_ARRIVED = 1e-9
_STEPS = 10
_MOST = 40
_LEAST = 1e-300  # of what is divided by


@dataclass(frozen=True)
class Points:
    """One on each of n curves: its share of the way and the value of the held joint (n,), the row
    (n, dof), how far that is outside the limits (n,), and the derivatives (n, v) of the joints that move
    and, last, of the held value by the share."""

    share: Array
    held: Array
    q: Array
    off: Array
    flow: Array

    @property
    def rise(self) -> Array:
        """How fast the held value goes up (n,)."""
        return np.asarray(self.flow[:, -1])

    def where(self, these: Flags, others: Points) -> Points:
        """Points of these curves, and the other points of the others."""
        out = []
        for field in fields(self):
            one, other = getattr(self, field.name), getattr(others, field.name)
            out.append(np.where(these[:, None] if one.ndim > 1 else these, one, other))
        return Points(*out)


class Arcs:
    """Curves of a pose T (4, 4) from rows q (n, dof) at values `held` (n,) to rows `there` at `then`."""

    def __init__(
        self, arm: Arm, T: Array, limits: bool, q: Array, held: Array, there: Array, then: Array
    ) -> None:
        self._arm, self._T, self._limits = arm, np.broadcast_to(T, (len(q), 4, 4)), limits
        self._columns = [*arm.moving, *arm.free]
        self._moving = len(arm.moving)
        chord = self._way(q, held, there, then)
        self._length = np.sqrt((chord * chord).sum(axis=1))
        self._unit = chord / np.maximum(self._length, _LEAST)[:, None]
        share = np.zeros(len(q))
        self.start = Points(share, held, q, self._off(q), chord)
        self.end = Points(share + 1.0, then, there, self._off(there), chord)

    def folds(self, sense: Array) -> tuple[Points, Flags]:
        """Just before the held value, which goes up (`sense` 1) or down (-1) at the start, turns back; and
        whether it does on the way to the end."""
        with np.errstate(all="ignore"):
            a, found = self._find(self.start.share, self.start)
            b, also = self._find(self.end.share, self.end)
            found &= also & (sense * a.rise > 0.0) & (sense * b.rise < 0.0)
            room = 0.5 * np.sqrt(_ENOUGH * np.abs(a.rise - b.rise))
            out, close = self._cross(
                a,
                b,
                lambda p: sense * p.rise - room,
                lambda p: sense * p.rise > room,
                lambda p: np.abs(sense * p.rise - room) < room,
            )
        one = self._length < _TOUCHING
        return self.start.where(one, out), one | (found & close)

    def limits(self, inside: Points, beyond: Points) -> tuple[Points, Flags]:
        """The last points inside the limits on the way from points that are to such as are not; whether
        they were found."""
        with np.errstate(all="ignore"):
            room = 0.25 * _ENOUGH * np.abs((beyond.off - inside.off) / (beyond.held - inside.held))
            return self._cross(
                inside,
                beyond,
                lambda p: p.off + room,
                lambda p: p.off <= -room,
                lambda p: (p.off <= 0.0) & (p.off > -2.0 * room),
            )

    def _off(self, q: Array) -> Array:
        return outside(self._arm, q, self._limits) - self._arm.policy.limit_tolerance

    def _way(self, q: Array, held: Array, there: Array, then: Array) -> Array:
        gap = differences(self._arm, q, there)[:, list(self._arm.moving)]
        return np.concatenate([gap, (then - held)[:, None]], axis=1)

    def _cross(
        self,
        a: Points,
        b: Points,
        value: Callable[[Points], Array],
        before: Callable[[Points], Flags],
        close: Callable[[Points], Flags],
    ) -> tuple[Points, Flags]:
        """Where `value` changes its sign: by false position, halving what an end keeps (Dowell & Jarratt
        1971)."""
        x, y = value(a), value(b)
        kept, out = np.zeros(len(x)), a
        done, found = np.zeros((2, len(x)), dtype=bool)
        for _ in range(_MOST):
            part = x / (x - y)
            share = a.share + part * (b.share - a.share)
            c, arrived = self._find(share, a.where(part < 0.5, b))
            out = out.where(done, c)
            found |= ~done & arrived & close(c)
            done |= found | ~arrived
            if done.all():
                break
            first = before(c)
            a, b = c.where(first, a), b.where(first, c)
            x = np.where(first, value(c), np.where(kept == -1, 0.5 * x, x))
            y = np.where(first, np.where(kept == 1, 0.5 * y, y), value(c))
            kept = np.where(first, 1, -1)
        return out.where(done, a), found | ~done

    def _find(self, share: Array, near: Points) -> tuple[Points, Flags]:
        """The points with these shares of the way, from some beside them, by Newton's method; whether that
        leads there."""
        ahead = (share - near.share)[:, None] * near.flow
        q, held, flow = near.q.copy(), near.held + ahead[:, -1], near.flow
        q[:, list(self._arm.moving)] += ahead[:, :-1]
        moved, done = np.zeros(len(q)), np.zeros(len(q), dtype=bool)
        for _ in range(_STEPS):
            step, tangent = self._step(share, q, held)
            size = np.abs(step[:, :-1]).max(axis=1)
            going = ~done & (moved + size < _FAR)
            moved = np.where(done, moved, moved + size)
            q[:, list(self._arm.moving)] += np.where(going[:, None], step[:, :-1], 0.0)
            held = held + np.where(going, step[:, -1], 0.0)
            flow = np.where(going[:, None], tangent, flow)
            done |= going & (size <= _ARRIVED)
            if (done | ~(moved < _FAR)).all():
                break
        if self._arm.free:
            q[:, self._arm.free[0]] = held
        return Points(share, held, q, self._off(q), flow), done

    def _step(self, share: Array, q: Array, held: Array) -> tuple[Array, Array]:
        """Newton steps (n, v) of what moves and of the held value, and derivatives by the share."""
        error, slope = self._missed(q, held)
        left = share * self._length
        left = left - (self._unit * self._way(self.start.q, self.start.held, q, held)).sum(axis=1)
        turned = slope.transpose(0, 2, 1)
        A = turned @ slope + self._unit[:, :, None] * self._unit[:, None, :]
        wanted = (turned @ error[:, :, None])[:, :, 0] + self._unit * left[:, None]
        both = np.stack([wanted, self._unit * self._length[:, None]], axis=2)
        both = of_normal(np.linalg.solve, A, both)
        return both[:, :, 0], both[:, :, 1]

    def _missed(self, q: Array, held: Array) -> tuple[Array, Array]:
        """What rows miss of the pose (n, m), and the slope (n, m, v) of that by what moves and, last, the
        held value."""
        arm = self._arm
        if arm.angle is None:
            q = q.copy()
            q[:, arm.free[0]] = held
            return errors_and_slopes(arm.chain, arm.task, self._columns, q, self._T, None)
        aim = arm.angle.aims(self._T, held[:, None])
        error, slope = linearized(arm, q, aim)
        last = np.zeros((*slope.shape[:2], 1))
        last[:, -1, 0] = arm.angle.turned(q, aim)
        return error, np.concatenate([slope, last], axis=2)
