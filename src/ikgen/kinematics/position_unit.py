"""What errors of a tip's position are relative to."""

from __future__ import annotations

import numpy as np

from ikgen.kinematics.forward import file_forward
from ikgen.kinematics.joint_box import joint_box
from ikgen.model.dh import DHChain

__all__ = ["position_unit"]

_CONFIGURATIONS = 64
_TINY = 0.05
"""Arms whose links are all shorter (m) are tiny: what their joints move is little beside a metre."""

_AWAY = 1e-4
"""What a metre counts that the arm stands away from the frame of its poses."""

_SHORTEST = 1e-4
_DIGITS = 2
"""To which a reach is rounded: round-off, which differs between machines, is not in it."""


def position_unit(dh: DHChain) -> float:
    """A length (m): 1 for arms of a usual size, more for large ones and less for tiny ones.

    It is the largest entry of a link's translation, or as far as the tip comes from the first axis where
    that is less: DH parameters put the frame of an axis that is nearly parallel to the next many times as
    far away as the arm reaches. Where the arm stands moves nothing; far away it takes digits, though.
    """
    base, *links = (F[:3, 3] for F in dh.file_frames)
    away, largest = float(np.abs(base).max()), max(float(np.abs(x).max()) for x in links)
    least, tiny = max(1.0, _AWAY * away), max(away, largest) < _TINY
    tiny = tiny and all(row.revolute for row in dh.rows)
    if dh.symbols or (largest <= 1.0 and not tiny):
        return max(least, largest)
    low, high = joint_box(dh, 1.0)
    q = np.random.default_rng(0).uniform(low, high, (_CONFIGURATIONS, dh.dof))
    farthest = float(np.linalg.norm(file_forward(dh, q)[:, :3, 3] - base, axis=1).max())
    reach = min(largest, float(f"{farthest:.{_DIGITS}g}"))
    return max(reach, _SHORTEST if tiny else least)
