"""Rows of a Denavit-Hartenberg table as text."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ikgen.model.dh import Angle, DHChain, DHRow, Length

__all__ = ["angle_text", "length_text", "row_texts"]


def row_texts(dh: DHChain) -> list[tuple[str, str, str, str, str, str]]:
    """Number, joint, alpha, a, theta and d of each modified DH row, its joint in theta or d."""
    rows = []
    for i, row in enumerate(dh.rows, start=1):
        theta, d = _variable(row, dh), length_text(row.d)
        if not row.revolute:
            theta, d = angle_text(row.theta), theta
        rows.append((str(i), row.name, angle_text(row.alpha), length_text(row.a), theta, d))
    return rows


def _variable(row: DHRow, dh: DHChain) -> str:
    """The row's variable: `scale * q + offset` with the joint's name for q."""
    name = dh.joints[row.driver].name
    text = name if row.scale == 1 else f"-{name}" if row.scale == -1 else f"{row.scale:g} {name}"
    offset = angle_text(row.offset) if row.revolute else length_text(row.offset)  # type: ignore[arg-type]
    if offset == "0":
        return text
    return f"{text} - {offset[1:]}" if offset.startswith("-") else f"{text} + {offset}"


def angle_text(angle: Angle) -> str:
    """An exact angle as a multiple of pi, another one by its name or value."""
    exact = angle.exact
    if exact is None:
        return angle.name or f"{angle.value:.10g}"
    if exact == 0:
        return "0"
    sign = "-" if exact < 0 else ""
    size = Fraction(abs(exact))
    top = "pi" if size.numerator == 1 else f"{size.numerator} pi"
    return f"{sign}{top}" if size.denominator == 1 else f"{sign}{top}/{size.denominator}"


def length_text(length: Length) -> str:
    """A length by its signed name; exact zero is 0."""
    if length.name is None:
        return "0"
    return f"-{length.name}" if length.sign < 0 else length.name
