"""The file's own chain with four constants a link.

A frame on a joint's axis may be turned about and moved along that axis, as both commute with the joint's
motion. So any constant transform between two axes becomes a step in the x-y plane and a turn about x;
unlike Denavit and Hartenberg's parameters these are well determined for parallel axes too.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ikgen.kinematics.fixed_order import product
from ikgen.kinematics.rigid import rotation_x, rotation_z
from ikgen.model.arrays import Array
from ikgen.model.dh import DHChain

__all__ = ["TwistChain", "TwistLink", "twist_chain"]

_PARALLEL = 1e-12
"""Sine of the angle between two axes below which they are parallel."""


@dataclass(frozen=True, slots=True)
class TwistLink:
    """A joint's motion and the constants behind it: `Rz(u) Tz(v) Tx(x) Ty(y) Rx(twist)` (m, rad).

    Of u and v the joint's own is `scale * q[driver] + offset`; the other is 0, but for a slide's u, `turn`.
    """

    driver: int
    revolute: bool
    scale: float
    offset: float
    turn: float
    x: float
    y: float
    twist: float


@dataclass(frozen=True, slots=True)
class TwistChain:
    """The pose of the tip is `first * links * last` with constant `first` and `last` (4, 4)."""

    first: Array
    links: tuple[TwistLink, ...]
    last: Array


def twist_chain(dh: DHChain) -> TwistChain:
    """The file's chain (`dh.file_frames`) in this form, to round-off."""
    frames, heights = _without_heights(dh)
    links: list[TwistLink] = []
    turn = 0.0
    for row, F, height in zip(dh.rows, frames[1:], heights, strict=True):
        before = twist = after = x = y = 0.0
        if len(links) < len(dh.rows) - 1:  # what follows the last joint is `last`
            before, twist, after = _euler(F[:3, :3])
            x, y = product(rotation_z(-before)[:2, :2], F[:2, 3])
        turn += before
        own, rest = (turn, 0.0) if row.revolute else (height, turn)
        offset = row.offset.value + own
        links.append(
            TwistLink(row.driver, row.revolute, row.scale, offset, rest, float(x), float(y), twist)
        )
        turn = after
    return TwistChain(frames[0], tuple(links), frames[-1])


def _without_heights(dh: DHChain) -> tuple[list[Array], list[float]]:
    """The frames without steps along z between two axes, and what a slide in front of one gains."""
    frames = [np.array(F) for F in dh.file_frames]
    heights = [0.0] * len(dh.rows)
    for i in reversed(range(len(dh.rows) - 1)):
        height = float(frames[i + 1][2, 3])
        frames[i + 1][2, 3] = 0.0
        if dh.rows[i].revolute:
            frames[i][:3, 3] += height * frames[i][:3, 2]  # in front of the turn
        else:
            heights[i] = height
    return frames, heights


def _euler(R: Array) -> tuple[float, float, float]:
    """`R = Rz(before) Rx(twist) Rz(after)`: before, twist and after."""
    x, y, z = R[:, 2]
    sine = math.hypot(x, y)
    before = math.atan2(x, -y) if sine > _PARALLEL else 0.0
    twist = math.atan2(sine if sine > _PARALLEL else 0.0, z)
    left = product(product(rotation_z(before), rotation_x(twist)).T, R)
    return before, twist, math.atan2(left[1, 0], left[0, 0])
