"""A chain of joints at many configurations at once, which are the last axis of all arrays.

NumPy takes a fraction of a nanosecond for a number in a long row, but tens of them for each small matrix
of a product."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi

import numpy as np

from ikgen.runtime.python.arm.lane_tasks import LaneTask
from ikgen.runtime.python.arrays.array_types import Array, Single

__all__ = ["LaneChain", "Sines", "lane_jacobian", "sines", "turned", "walk"]

Link = tuple[bool, float, float, float, float, float, float]
Sines = tuple[Array, Array]  # cosines and sines


@dataclass(frozen=True)
class LaneChain:
    """A frame `first`, links `Rz(u) Tz(v) Tx(x) Ty(y) Rx(twist)`, and a frame `last` (4, 4).

    `task`: what counts of its tip's pose. A link: whether it turns, cosine and sine of a slide's u, x, y,
    cosine and sine of the twist. Its value, u or of a slide v, is `scale * q[joint] + offset` (n, 1);
    `direct`: whether that is `q + offset`.
    """

    task: LaneTask
    first: Array
    joint: tuple[int, ...]
    scale: Array
    offset: Array
    links: tuple[Link, ...]
    last: Array
    direct: bool

    def changes(self, d: Array) -> Array:
        """The changes (n, k) of the links' values that changes d (dof, k) of the joints are."""
        return d if self.direct else np.asarray(d[list(self.joint)] * self.scale)


_PARTS = 2048  # of a turn: what is left of an angle is at most 1.6e-3 rad
_GRID = 2.0 * pi / _PARTS * np.arange(_PARTS)
_GRID_SINES = np.cos(_GRID), np.sin(_GRID)
_HIGH, _LOW = (
    0.0030679614283144474,
    1.4745683505648208e-10,
)  # a part: products of the first are exact


def sines(angle: Array) -> Sines:
    """Cosines and sines to 1e-15, of angles below 1e6 (reduced as by Cody & Waite 1980): faster than
    NumPy's."""
    part = np.rint(angle * (_PARTS / (2.0 * pi)))
    index = part.astype(np.intp)
    index &= _PARTS - 1
    left = part * -_HIGH
    left += angle
    part *= _LOW
    left -= part
    near = _GRID_SINES[0].take(index), _GRID_SINES[1].take(index)
    return _turned(near, left, (-1.0 / 6, 1.0), (-1.0 / 24, 0.5))


def turned(by: Sines, angle: Array) -> Sines:
    """Cosines and sines turned by angles of at most 0.05 rad (Taylor's polynomials)."""
    odd, even = (-1.0 / 5040, 1.0 / 120, -1.0 / 6, 1.0), (-1.0 / 40320, 1.0 / 720, -1.0 / 24, 0.5)
    return _turned(by, angle, odd, even)


def _turned(by: Sines, angle: Array, odd: Sequence[float], even: Sequence[float]) -> Sines:
    """By angles of which the sine, over the angle, and 1 - cosine, over its square, have these factors of
    the square's powers, the highest first."""
    c, s = by
    z = angle * angle
    sine, versine = _series(z, *odd), _series(z, *even)
    sine *= angle
    versine *= z
    change, other = c * versine, s * sine
    change += other
    cosine = c - change
    np.multiply(s, versine, out=change)
    np.multiply(c, sine, out=other)
    change -= other
    return cosine, np.subtract(s, change, out=change)


def _series(z: Array, *factors: float) -> Array:
    """The polynomial in z with these factors, the highest first: in place."""
    first, second, *others = factors
    out = z * first
    out += second
    for x in others:
        out *= z
        out += x
    return np.asarray(out)


def walk(chain: LaneChain, values: Array, angles: Sines) -> tuple[Array, Single]:
    """The tip's upper rows (3, 4, k) at the links' values (n, k), of which the cosines and sines are given,
    and directions and points (2, n, 3, k) of the axes."""
    count = values.shape[1]
    x, y, z, p = chain.first[:3].T[:, :, None]
    axes = np.empty((2, len(values), 3, count), dtype=np.float32)
    for i, (turns, cosine, sine, along, aside, twist_c, twist_s) in enumerate(chain.links):
        axes[0, i], axes[1, i] = z, p
        if turns:
            c, s = angles[0][i], angles[1][i]
            x, y = x * c + y * s, y * c - x * s
        else:
            p = p + values[i] * z
            x, y = cosine * x + sine * y, cosine * y - sine * x
        if along:
            p = p + along * x
        if aside:
            p = p + aside * y
        if twist_s or twist_c != 1.0:
            y, z = twist_c * y + twist_s * z, twist_c * z - twist_s * y
    tip = np.empty((3, 4, count))
    for k, (a, b, c, _) in enumerate(chain.last.T.tolist()):
        tip[:, k] = a * x + b * y + c * z
    tip[:, 3] += p
    return tip, axes


def lane_jacobian(chain: LaneChain, tip: Array, axes: Single, dof: int) -> Single:
    """The geometric Jacobians (dof, 6, k), linear rows first, of what `walk` gave: in single precision, as
    what a step is wrong by is left for the next one."""
    z, r = axes[0], tip[:, 3].astype(np.float32) - axes[1]
    J = np.empty((len(z), 6, tip.shape[2]), dtype=np.float32)
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        np.subtract(z[:, j] * r[:, k], z[:, k] * r[:, j], out=J[:, i])
    J[:, 3:] = z
    for i, (turns, *_) in enumerate(chain.links):
        if not turns:
            J[i, :3], J[i, 3:] = z[i], 0.0
    if chain.direct:
        return J
    J *= chain.scale[:, :, None]
    out = np.zeros((dof, *J.shape[1:]), dtype=np.float32)
    for i, joint in enumerate(chain.joint):
        out[joint] += J[i]
    return out
