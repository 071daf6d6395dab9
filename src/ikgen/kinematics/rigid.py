"""Rigid transforms as matrices."""

from __future__ import annotations

import numpy as np

from ikgen.model.joint_tree import Matrix

__all__ = ["inverse"]


def inverse(T: Matrix) -> Matrix:
    """The inverse (4, 4) of a rigid transform, its rotation without round-off."""
    out = np.eye(4)
    out[:3, :3] = T[:3, :3].T
    out[:3, 3] = -T[:3, :3].T @ T[:3, 3]
    return out
