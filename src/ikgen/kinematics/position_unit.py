"""What errors of a tip's position are relative to."""

from __future__ import annotations

import numpy as np

from ikgen.kinematics.forward import file_forward
from ikgen.kinematics.joint_box import joint_box
from ikgen.model.dh import DHChain

__all__ = ["distance_away", "position_unit"]

_CONFIGURATIONS = 64
_TINY = 0.05
"""Arms whose links are all shorter (m) are tiny: what their joints move is little beside a metre."""

_AWAY = 1e-4
"""What a metre counts that the arm stands away from the frame of its poses."""

_SHORTEST = 1e-4
_DIGITS = 2
"""To which a reach is rounded: round-off, which differs between machines, is not in it."""


def distance_away(dh: DHChain) -> float:
    """How far (m) the arm stands from the frame of its poses, by the largest entry."""
    return float(np.abs(dh.file_frames[0][:3, 3]).max())


def position_unit(dh: DHChain) -> float:
    """A length (m): 1 for arms of a usual size, more for large ones and less for tiny ones.

    It is the largest entry of a link's translation, or as far as the tip comes from the first axis where
    that is less: DH parameters put the frame of an axis that is nearly parallel to the next many times as
    far away as the arm reaches. Where the arm stands moves nothing; far away it takes digits, though.
    """
    away = distance_away(dh)
    largest = max(float(np.abs(F[:3, 3]).max()) for F in dh.file_frames[1:])
    least = max(1.0, _AWAY * away)
    tiny = max(away, largest) < _TINY and all(row.revolute for row in dh.rows)
    if dh.symbols or (largest <= 1.0 and not tiny):
        return max(least, largest)
    low, high = joint_box(dh, 1.0)
    q = np.random.default_rng(0).uniform(low, high, (_CONFIGURATIONS, dh.dof))
    way = file_forward(dh, q)[:, :3, 3] - dh.file_frames[0][:3, 3]
    farthest = float(np.linalg.norm(way, axis=1).max())
    reach = min(largest, float(f"{farthest:.{_DIGITS}g}"))
    return max(reach, _SHORTEST if tiny else least)
