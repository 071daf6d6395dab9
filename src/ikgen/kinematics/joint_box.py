"""Values that joints are drawn from: inside their limits, and near 0 where these are wide or none."""

from __future__ import annotations

import math

import numpy as np

from ikgen.model.arrays import Array
from ikgen.model.chain import REVOLUTE
from ikgen.model.dh import DHChain

__all__ = ["joint_box"]


def joint_box(dh: DHChain, slide: float, turn: float = math.pi) -> tuple[Array, Array]:
    """Lowest and highest values (dof,), rad or m, inside the limits and at most `turn` (rad) or `slide` (m)
    from 0; of a joint whose limits are all beyond that, what lies between it and them."""
    wide = np.array([turn if joint.kind == REVOLUTE else slide for joint in dh.joints])
    low = np.maximum([joint.limits.lower for joint in dh.joints], -wide)
    high = np.minimum([joint.limits.upper for joint in dh.joints], wide)
    return np.minimum(low, high), np.maximum(low, high)
