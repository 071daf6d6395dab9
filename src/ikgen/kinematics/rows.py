"""DH rows with exact and named constants, out of the numbers that links and offsets give."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction

from ikgen.kinematics.links import LinkShape, Tolerance
from ikgen.kinematics.offsets import Offsets
from ikgen.kinematics.snapping import LengthBook, SnapLog, exact_angle, tidy
from ikgen.model.chain import REVOLUTE, ChainAxis
from ikgen.model.dh import Angle, DHRow, Length

__all__ = ["build_rows", "drive_row"]

_ZERO_ANGLE = Angle(0.0, Fraction(0))
_ZERO_LENGTH = Length(0.0, None)

_SUM_FRACTION = 0.05
"""Part of the turn tolerance for theta's offset: both its terms were snapped with all of it."""

_MOSTLY_TWIST = 1.01
"""A link turned by less than this times its change of alpha was turned in alpha alone."""

_SAME_ANGLE = 1e-5
"""Twists (rad) that are not multiples of pi/12 share a name within this, and within the tolerance."""


def build_rows(
    axes: tuple[ChainAxis, ...],
    shapes: tuple[LinkShape, ...],
    signs: tuple[int, ...],
    offsets: Offsets,
    tolerance: Tolerance,
    log: SnapLog,
) -> tuple[DHRow, ...]:
    """One row an axis, offsets as at value 0 of the axis itself (mimic joints not yet driven).

    Row i (from 1) holds alpha_{i-1}, a_{i-1}, d_i, theta_i, named as in textbooks and IKBT.
    """
    book = LengthBook(tolerance.length, log)
    twists: list[Angle] = []
    rows = []
    for k, axis in enumerate(axes):
        alpha, a = _ZERO_ANGLE, _ZERO_LENGTH
        if k > 0:
            alpha = _twist(shapes[k - 1], k, twists, tolerance, log)
            a = book.enter(shapes[k - 1].a, f"a_{k}")
            log.add(f"a_{k}", shapes[k - 1].measured_a, shapes[k - 1].a)
        row = DHRow(
            name=axis.name,
            kind=axis.kind,
            alpha=alpha,
            a=a,
            d=_ZERO_LENGTH,
            theta=_ZERO_ANGLE,
            driver=axis.driver,
            scale=float(signs[k]),
            offset=_ZERO_ANGLE,
        )
        fill = _revolute_row if axis.kind == REVOLUTE else _prismatic_row
        rows.append(fill(row, k, offsets, tolerance, book, log))
    return tuple(rows)


def _revolute_row(
    row: DHRow, k: int, offsets: Offsets, tolerance: Tolerance, book: LengthBook, log: SnapLog
) -> DHRow:
    i, theta = k + 1, offsets.theta[k]
    offset = exact_angle(theta, tolerance.turn * _SUM_FRACTION, f"theta_offset_{i}")
    log.add(f"theta_{i}", theta, _near(offset.value, theta))
    d = book.enter(offsets.d[k], f"d_{i}", offsets.length_error[k])
    return replace(row, d=d, offset=offset)


def _prismatic_row(
    row: DHRow, k: int, offsets: Offsets, tolerance: Tolerance, book: LengthBook, log: SnapLog
) -> DHRow:
    i, theta = k + 1, offsets.theta[k]
    angle = exact_angle(theta, tolerance.angle, f"theta_{i}")
    log.add(f"theta_{i}", theta, _near(angle.value, theta))
    # where the variable starts is no constant of the geometry: it shares no name
    own = LengthBook(book.tolerance, log)
    return replace(
        row, theta=angle, offset=own.enter(offsets.d[k], f"d_offset_{i}", offsets.length_error[k])
    )


def drive_row(row: DHRow, multiplier: float, offset: float, number: int) -> DHRow:
    """`row` of a value turned into one of another: `value = multiplier * other + offset`."""
    scale, moved = row.scale * multiplier, row.scale * offset
    if offset == 0.0:
        return replace(row, scale=scale)
    value = row.offset.value + moved
    shifted: Angle | Length
    if row.revolute:
        shifted = exact_angle(value, 1e-12, f"theta_offset_{number}")
    else:
        shifted = LengthBook(0.0, SnapLog()).enter(tidy(value), f"d_offset_{number}")
    return replace(row, scale=scale, offset=shifted)


def _twist(
    shape: LinkShape, number: int, known: list[Angle], tolerance: Tolerance, log: SnapLog
) -> Angle:
    name, same = f"alpha_{number}", min(_SAME_ANGLE, tolerance.angle)
    alpha = exact_angle(shape.alpha, 1e-9, name)
    for twist in known:
        if alpha.exact is None and abs(twist.value - alpha.value) <= same:
            alpha = twist
    if alpha.exact is None:
        known.append(alpha)
    log.add(name, shape.link.true_alpha, alpha.value)
    turned = shape.link.change
    if turned > _MOSTLY_TWIST * abs(shape.link.true_alpha - alpha.value):
        log.add(f"turn about axes {number} and {number + 1}", turned, 0.0)
    return alpha


def _near(angle: float, other: float) -> float:
    """`angle` (rad) within half a turn of `other`, to compare the two."""
    turn = 2 * math.pi
    return angle + turn * round((other - angle) / turn)
