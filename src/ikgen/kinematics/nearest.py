"""Rows of a given structure that come nearest to the file's own chain.

Constants are found by Gauss-Newton steps on the difference of poses at random configurations, as in
kinematic calibration (Mooring, Roth and Driels, Fundamentals of Manipulator Calibration, 1991). What
must be exact for a closed form stays as it is; the rest takes the values that lose least.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ikgen.kinematics.file_frames import random_configurations
from ikgen.kinematics.fixed_order import dot, least_squares, length, product
from ikgen.kinematics.forward import file_forward, row_values
from ikgen.kinematics.rigid import coordinate_motion, inverse
from ikgen.kinematics.row_ends import tidy_pose
from ikgen.model.arrays import Array
from ikgen.model.dh import DHChain

__all__ = ["FIELDS", "Constant", "Fitted", "end_motions", "fit_rows"]

FIELDS = ("alpha", "a", "theta", "d")
"""The constants of a row in the order of its motions; the offset is that of theta, or of d."""

Constant = tuple[int, str]
"""A constant that may change: row (from 0) and field."""

_SAMPLES = 40
_SEED = 19910401
_STEPS = 8
_DEPENDENT = 1e-6
_SETTLED = 2e-15

_ENDS = ("Rx", "Ry", "Rz", "Tx", "Ty", "Tz")


@dataclass(frozen=True, slots=True)
class Fitted:
    """`change` (rad or m) of each constant, that of an end's motion in the last step included, and the
    end constants (4, 4) that go with them."""

    change: dict[Constant, float]
    X_base: Array
    X_tip: Array


@dataclass(frozen=True, slots=True)
class _Factor:
    """One motion of the chain along or about an axis, by `value` (m or rad, of all samples)."""

    motion: str
    value: Array
    label: Constant


def end_motions(dh: DHChain) -> tuple[Constant, ...]:
    """The motions of frame 0 in the base and of the tip in frame n, as constants that may change."""
    return tuple((end, motion) for end in (-1, len(dh.rows)) for motion in _ENDS)


def fit_rows(dh: DHChain, constants: tuple[Constant, ...]) -> Fitted:
    """Changes of `constants` with the least differences of poses.

    Of constants that can stand in for each other the first ones change.
    """
    if not constants:
        return Fitted({}, dh.X_base, dh.X_tip)
    q = random_configurations(dh, _SAMPLES, _SEED)
    target, values = file_forward(dh, q), row_values(dh, q)
    change = dict.fromkeys(constants, 0.0)
    X_base, X_tip = dh.X_base, dh.X_tip
    chosen: list[int] | None = None
    for _ in range(_STEPS):
        T, columns = _derivatives(_factors(dh, values, change), constants, X_base, X_tip)
        J = columns[:, :, :3].reshape(len(constants), -1).T
        chosen = _independent(J) if chosen is None else chosen
        step = np.zeros(len(constants))
        step[chosen] = least_squares(J[:, chosen], (target - T)[:, :3].ravel())
        by_label = dict(zip(constants, step.tolist(), strict=True))
        change = {c: change[c] + by_label[c] for c in constants}
        X_base = product(X_base, _end_motion(by_label, -1))
        X_tip = product(_end_motion(by_label, len(dh.rows)), X_tip)
        if np.abs(step).max() < _SETTLED:
            break
    return Fitted(change, tidy_pose(X_base), tidy_pose(X_tip))


def _factors(dh: DHChain, values: Array, change: dict[Constant, float]) -> list[_Factor]:
    out = []
    for i, row in enumerate(dh.rows):
        turn, slide = np.full(len(values), row.theta.value), np.full(len(values), row.d.value)
        if row.revolute:
            turn = values[:, i]
        else:
            slide = values[:, i]
        constant = np.ones(len(values))
        terms = (constant * row.alpha.value, constant * row.a.value, turn, slide)
        for motion, field, value in zip(("Rx", "Tx", "Rz", "Tz"), FIELDS, terms, strict=True):
            out.append(_Factor(motion, value + change.get((i, field), 0.0), (i, field)))
    return out


def _derivatives(
    factors: list[_Factor], labels: tuple[Constant, ...], X_base: Array, X_tip: Array
) -> tuple[Array, Array]:
    """The poses (N, 4, 4) and their derivatives by `labels`, each (N, 4, 4)."""
    before = [np.broadcast_to(X_base, (len(factors[0].value), 4, 4))]
    for factor in factors:
        before.append(product(before[-1], _motion(factor.motion, factor.value)))
    places = {f.label: (f.motion, k + 1) for k, f in enumerate(factors)}
    last = max(row for row, _ in places) + 1
    for m in _ENDS:
        places[-1, m], places[last, m] = (m, 0), (m, len(factors))
    T = product(before[-1], X_tip)
    columns = []
    for label in labels:
        motion, k = places[label]
        moved = product(before[k], _GENERATORS[motion])
        columns.append(product(moved, inverse(before[k]), T))
    return T, np.stack(columns)


def _independent(J: Array) -> list[int]:
    """Columns that the ones before do not span, by Gram and Schmidt's method."""
    basis: list[Array] = []
    chosen = []
    for k, column in enumerate(J.T):
        rest = column
        for _ in range(2):
            for b in basis:
                rest = rest - b * dot(b, rest)
        size = length(rest)
        if size > _DEPENDENT * max(length(column), 1e-3):
            basis.append(rest / size)
            chosen.append(k)
    return chosen


def _end_motion(step: dict[Constant, float], end: int) -> Array:
    T = np.eye(4)
    for m in _ENDS:
        T = product(T, _motion(m, step.get((end, m), 0.0)))
    return T


def _motion(motion: str, value: ArrayLike) -> Array:
    """The motions (..., 4, 4) by values (...,) of "Rx" to "Tz"."""
    return coordinate_motion(motion[0] == "R", "xyz".index(motion[1]), value)


def _generator(motion: str) -> Array:
    axis = "xyz".index(motion[1])
    G = np.zeros((4, 4))
    if motion[0] == "T":
        G[axis, 3] = 1.0
    else:
        i, j = (axis + 1) % 3, (axis + 2) % 3
        G[j, i], G[i, j] = 1.0, -1.0
    return G


_GENERATORS = {m: _generator(m) for m in ("Rx", "Ry", "Rz", "Tx", "Ty", "Tz")}
