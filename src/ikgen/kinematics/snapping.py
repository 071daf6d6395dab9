"""Tolerances that turn a file's rounded digits into exact constants.

A robot description writes pi/2 as 1.57, 1.5708 or 1.571. Symbolic rules need sin(alpha) = 1, so
angles near multiples of pi/12 and lengths near zero (or near each other) become exact here. Nothing
is decided about axes or frames; that is `links` and `modified_dh`.
"""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np

from ikgen.kinematics.fixed_order import length, product
from ikgen.kinematics.rigid import rotation_x, rotation_z
from ikgen.model.arrays import Array
from ikgen.model.dh import Angle, Length, Snap

__all__ = [
    "ANGLE_STEP",
    "ROUND_OFF",
    "WRITTEN_IN_FULL",
    "LengthBook",
    "SnapLog",
    "exact_angle",
    "snap_angle",
    "snap_axis",
    "snap_rotation",
    "tidy",
    "wrap_angle",
]

ANGLE_STEP = math.pi / 12
"""Angles become multiples of this, in rad."""

ROUND_OFF = 1e-12
"""Differences up to this (rad or m) are floating point noise."""

WRITTEN_IN_FULL = 1e-9
"""Constants changed by at most this (rad or m) were exact as far as a file can say."""


def wrap_angle(angle: float) -> float:
    """`angle` (rad) modulo 2 pi in (-pi, pi]."""
    wrapped = math.remainder(angle, 2 * math.pi)
    return math.pi if wrapped <= -math.pi + 1e-15 else wrapped


def snap_angle(angle: float, tolerance: float) -> float:
    """The multiple of pi/12 within `tolerance` of `angle` (rad), or `angle`; in (-pi, pi]."""
    nearest = round(angle / ANGLE_STEP) * ANGLE_STEP
    return wrap_angle(nearest if abs(angle - nearest) <= tolerance else angle)


def exact_angle(angle: float, tolerance: float, name: str) -> Angle:
    """`angle` (rad) as a multiple of pi/12 where it is one within `tolerance`, else with `name`."""
    steps = round(angle / ANGLE_STEP)
    if abs(angle - steps * ANGLE_STEP) > tolerance:
        return Angle(wrap_angle(angle), None, name)
    steps = (steps + 11) % 24 - 11
    return Angle(steps * ANGLE_STEP, Fraction(steps, 12))


def tidy(length: float) -> float:
    """`length` (m) with the fewest decimals that are the same number to round-off."""
    for decimals in range(1, 15):
        short = round(length, decimals)
        if abs(short - length) <= 2e-16 * max(1.0, abs(length)):
            return short + 0.0
    return length


def snap_axis(axis: Array, tolerance: float) -> Array:
    """The signed coordinate axis (3,) within `tolerance` (rad) of unit vector `axis`, or `axis`."""
    k = int(np.argmax(np.abs(axis)))
    rest = length(np.delete(axis, k))
    if rest > tolerance:
        return axis
    snapped = np.zeros(3)
    snapped[k] = math.copysign(1.0, axis[k])
    return snapped


def snap_rotation(R: Array, tolerance: float, turn_tolerance: float) -> Array:
    """The rotation next to `R` (3, 3) whose Euler angles z-x-z are exact where they nearly are.

    With z along an axis on both sides, `R = Rz(phi) Rx(alpha) Rz(psi)` holds the Denavit-Hartenberg
    twist and both its normals, so this snaps a joint's rotation in the digits its author wrote.
    Nearly parallel axes become parallel ones, and the turn about them is snapped as one angle.
    `tolerance` (rad) is for alpha, `turn_tolerance` for the others.
    """
    alpha = math.atan2(math.hypot(R[0, 2], R[1, 2]), R[2, 2])
    if alpha <= tolerance:
        turn = math.atan2(R[1, 0] - R[0, 1], R[0, 0] + R[1, 1])
        return rotation_z(snap_angle(turn, turn_tolerance))
    if math.pi - alpha <= tolerance:
        turn = math.atan2(R[1, 0] + R[0, 1], R[0, 0] - R[1, 1])
        return product(rotation_z(snap_angle(turn, turn_tolerance)), np.diag([1.0, -1.0, -1.0]))
    phi = snap_angle(math.atan2(R[0, 2], -R[1, 2]), turn_tolerance)
    psi = snap_angle(math.atan2(R[2, 0], R[2, 1]), turn_tolerance)
    return product(rotation_z(phi), rotation_x(snap_angle(alpha, tolerance)), rotation_z(psi))


class SnapLog:
    """Collects the constants that were replaced by exact ones, noise left out."""

    def __init__(self) -> None:
        self._snaps: list[Snap] = []

    def add(self, what: str, before: float, after: float) -> None:
        """Note that `what` went from `before` to `after` (rad or m)."""
        if abs(before - after) > WRITTEN_IN_FULL:
            self._snaps.append(Snap(what, float(before), float(after)))

    @property
    def snaps(self) -> tuple[Snap, ...]:
        """What was noted, in order."""
        return tuple(self._snaps)


class LengthBook:
    """Names lengths in the order they come; ones equal up to sign within tolerance share a name."""

    def __init__(self, tolerance: float, log: SnapLog) -> None:
        self.tolerance = tolerance
        self._log = log
        self._known: list[tuple[str, float]] = []

    def enter(self, value: float, name: str, length_error: float = 0.0) -> Length:
        """`value` (m) as constant `name` or as one known already; zero within tolerance + length_error."""
        if abs(value) <= self.tolerance + length_error:
            self._log.add(name, value, 0.0)
            return Length(0.0, None)
        sign = 1 if value > 0 else -1
        for known, magnitude in self._known:
            if abs(abs(value) - magnitude) <= self.tolerance:
                self._log.add(name, value, sign * magnitude)
                return Length(sign * magnitude, known, sign)
        magnitude = tidy(abs(value))
        self._known.append((name, magnitude))
        return Length(sign * magnitude, name, sign)
