"""Consecutive joint axes as pairs of lines: what the file says, snapped, and its DH parameters.

Every joint frame is first turned so that z lies along its axis. The transform from one such frame
to the next then splits into `Rz(phi) Tz(s1) · Tx(a) Rx(alpha) · Tz(s2) Rz(psi)`: the common normal
in the middle, and at both ends a screw about an axis that the neighbouring row absorbs
(Craig, Introduction to Robotics, section 3.4). Working link by link keeps one link's rounding from
tilting all later axes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ikgen.kinematics.fixed_order import dot, length, product
from ikgen.kinematics.rigid import cross_matrix, exact_cos_sin
from ikgen.kinematics.snapping import (
    snap_angle,
    snap_axis,
    snap_rotation,
    wrap_angle,
)
from ikgen.model.arrays import Array
from ikgen.model.chain import Chain

__all__ = [
    "FLIP",
    "Link",
    "LinkShape",
    "Tolerance",
    "align_z",
    "orient",
    "snapped_links",
]

FLIP = np.diag([1.0, -1.0, -1.0])
"""Half a turn about x: the same axis with z the other way."""


@dataclass(frozen=True, slots=True)
class Tolerance:
    """Below these a twist (rad), a length (m) or a turn about an axis (rad) counts as rounded."""

    angle: float
    length: float
    turn: float


@dataclass(frozen=True, slots=True)
class Link:
    """Pose of an axis frame in the one before, z along the axis in both.

    `R` (3, 3) is snapped, `true_alpha` (rad) the angle between the axes before that, `p` (3,) in
    m, `change` (rad) how far R was turned, `length_error` (m) what that may have done to lengths.
    """

    R: Array
    p: Array
    true_alpha: float
    change: float
    length_error: float


@dataclass(frozen=True, slots=True)
class LinkShape:
    """Parameters of one link, `Rz(phi) Tz(s1) Tx(a) Rx(alpha) Tz(s2) Rz(psi)`, in rad and m.

    Parallel axes (alpha = 0) have their offset in s2 and s1 = 0; where they are one line (a = 0 as
    well) only the sum of phi and psi means anything and phi = 0. `measured_a` is `a` before it was
    found to be zero, `link` what was measured.
    """

    alpha: float
    a: float
    phi: float
    psi: float
    s1: float
    s2: float
    measured_a: float
    link: Link

    @property
    def parallel(self) -> bool:
        """Whether the two axes are parallel (or one line)."""
        return self.alpha == 0.0

    @property
    def same_line(self) -> bool:
        """Whether the two axes are one line."""
        return self.alpha == 0.0 and self.a == 0.0


def align_z(axis: Array) -> Array:
    """A rotation (3, 3) whose z column is the unit vector `axis`; exact for coordinate axes."""
    k = int(np.argmax(np.abs(axis)))
    sign = math.copysign(1.0, axis[k])
    nearest = np.zeros(3)
    nearest[k] = sign
    x = np.zeros(3)
    x[0 if k else 1] = 1.0
    near = np.column_stack([x, np.cross(nearest, x), nearest])
    v, c = np.cross(nearest, axis), dot(nearest, axis)
    if not v.any():
        return near
    K = cross_matrix(v)
    return np.asarray(product(np.eye(3) + K + product(K, K) / (1.0 + c), near))


def snapped_links(chain: Chain, tolerance: Tolerance) -> tuple[Link, ...]:
    """The n - 1 links between the axes of `chain`, angles snapped in the file's own frames."""
    true = [align_z(axis.axis) for axis in chain.axes]
    snapped = [align_z(snap_axis(axis.axis, tolerance.angle)) for axis in chain.axes]
    links = []
    for i in range(1, len(chain.axes)):
        T = chain.axes[i].T_prev_axis
        R_true = product(true[i - 1].T, T[:3, :3], true[i])
        R = product(snapped[i - 1].T, T[:3, :3], snapped[i])
        R = snap_rotation(R, tolerance.angle, tolerance.turn)
        p = product(snapped[i - 1].T, T[:3, 3])
        change = length(R_true - R) / math.sqrt(2)
        alpha = math.atan2(math.hypot(R_true[0, 2], R_true[1, 2]), R_true[2, 2])
        links.append(Link(R, p, alpha, change, change * length(p)))
    return tuple(links)


def _measure(link: Link, tolerance: Tolerance) -> LinkShape:
    """The parameters of `link`: alpha in [0, pi], `a` of any sign and exact zero where near it."""
    R, p = link.R, link.p
    near = tolerance.length + link.length_error
    alpha = math.atan2(math.hypot(R[0, 2], R[1, 2]), R[2, 2])
    if alpha < 1e-12:
        return _measure_parallel(link, tolerance)
    phi = math.atan2(R[0, 2], -R[1, 2])
    psi = math.atan2(R[2, 0], R[2, 1])
    (c, s), (ca, sa) = exact_cos_sin(phi), exact_cos_sin(alpha)
    a = float(p[0] * c + p[1] * s)
    s2 = float(p[0] * s - p[1] * c) / sa if sa else 0.0
    s1 = float(p[2]) - s2 * ca
    return LinkShape(alpha, 0.0 if abs(a) <= near else a, phi, psi, s1, s2, a, link)


def _measure_parallel(link: Link, tolerance: Tolerance) -> LinkShape:
    R, p = link.R, link.p
    near = tolerance.length + link.length_error
    turn = math.atan2(R[1, 0], R[0, 0])
    a, s = math.hypot(p[0], p[1]), float(p[2])
    if a <= near:
        return LinkShape(0.0, 0.0, 0.0, turn, 0.0, s, a, link)
    bearing = math.atan2(p[1], p[0])
    phi = snap_angle(bearing, min(tolerance.turn, near / a))
    link = replace(link, change=link.change + abs(wrap_angle(phi - bearing)))
    return LinkShape(0.0, a, phi, turn - phi, 0.0, s, a, link)


def orient(
    links: tuple[Link, ...], flip_first: bool, tolerance: Tolerance
) -> tuple[tuple[LinkShape, ...], tuple[int, ...]]:
    """Shapes of all links and one sign per axis (-1: z against the file's axis).

    Directions are chosen so that every alpha is in [0, pi) and every a >= 0; that settles all but
    intersecting axes, which keep the file's direction where alpha <= pi/2.
    """
    signs, shapes = [-1 if flip_first else 1], []
    for link in links:
        if signs[-1] < 0:
            R, p = product(FLIP, link.R), product(FLIP, link.p)
            link = replace(link, R=R, p=p, true_alpha=math.pi - link.true_alpha)
        shape = _measure(link, tolerance)
        obtuse = shape.a == 0.0 and shape.alpha > math.pi / 2 + 1e-9
        flip = shape.a < 0.0 or obtuse or math.pi - shape.alpha < 1e-12
        if flip:
            link = replace(link, R=product(link.R, FLIP), true_alpha=math.pi - link.true_alpha)
            shape = _measure(link, tolerance)
        shapes.append(shape)
        signs.append(-1 if flip else 1)
    return tuple(shapes), tuple(signs)
