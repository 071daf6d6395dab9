"""Poses as people have them, as homogeneous matrices."""

from __future__ import annotations

from typing import Any

import numpy as np

from ikgen.runtime.python.arrays.array_types import Array
from ikgen.runtime.python.arrays.real_numbers import real_array

__all__ = ["one_pose", "pose_matrices", "poses_in_line"]

# of pin.SE3, RigidTransform of SciPy, SE3 of spatialmath
_TRANSFORMS = ("homogeneous", "as_matrix", "A")
_FORMS = "(4, 4), (3, 4), (rotation (3, 3), position), (position, quaternion x y z w)"


def one_pose(pose: Any, alone: str) -> Array:
    """`pose_matrices` of one, (4, 4); raises ValueError for another shape."""
    T = pose_matrices(pose, alone)
    if T.shape != (4, 4):
        raise ValueError(f"pose has shape {T.shape}, expected (4, 4)")
    return T


def poses_in_line(poses: Any, alone: str) -> Array:
    """`pose_matrices` of many, (N, 4, 4); raises ValueError for another shape."""
    T = pose_matrices(poses, alone)
    if T.shape == (0,):  # a sequence of none
        return np.empty((0, 4, 4))
    if T.ndim != 3 or T.shape[1:] != (4, 4):
        raise ValueError(f"poses have shape {T.shape}, expected (N, 4, 4)")
    return T


def pose_matrices(pose: Any, alone: str) -> Array:
    """(4, 4), or (N, 4, 4) of many: of matrices (4, 4) or (3, 4), pairs (rotation (3, 3), position) or
    (position, quaternion x y z w), objects that have one of `_TRANSFORMS`, or a sequence of those.

    A rotation (3, 3) or a position (3,) does where the task reads it `alone`. What is none of these keeps
    its shape, or raises ValueError.
    """
    if isinstance(pose, np.ndarray) and pose.shape[-2:] == (4, 4):
        return real_array(pose, "pose")
    if not isinstance(pose, (list, tuple)) or not len(pose):
        return _completed(real_array(_matrix_of(pose), "pose"), alone)
    parts = [_matrix_of(part) for part in pose]
    pair = None
    try:
        if len(parts) == 2:
            pair = _of_pair(*(real_array(part, "pose") for part in parts))
        return _completed(real_array(parts, "pose"), alone) if pair is None else pair
    except ValueError:  # of several shapes
        each = [pose_matrices(part, alone) for part in parts]
        if any(one.shape != (4, 4) for one in each):
            raise ValueError(f"pose is none of {_FORMS}, nor a sequence of them") from None
        return np.stack(each)


def _matrix_of(pose: Any) -> Any:
    """What an object with one of `_TRANSFORMS` has there; others as they are."""
    for name in _TRANSFORMS:
        value = getattr(pose, name, None)
        if value is not None:
            return value() if callable(value) else value
    return pose


def _of_pair(a: Array, b: Array) -> Array | None:
    """The matrices of a rotation and a position, or of a position and a quaternion."""
    if a.shape[-2:] == (3, 3) and b.shape == a.shape[:-1]:
        return _matrices(a, b)
    if a.shape[-1:] == (3,) and b.shape == (*a.shape[:-1], 4):
        return _matrices(_rotations(b), a)
    return None


def _matrices(R: Array, p: Array) -> Array:
    T = np.zeros((*p.shape[:-1], 4, 4))
    T[..., :3, :3], T[..., :3, 3], T[..., 3, 3] = R, p, 1.0
    return T


def _rotations(quaternion: Array) -> Array:
    """(..., 3, 3) of x y z w: times its squared norm, so that a norm that is not 1 gives no rotation."""
    x, y, z, w = np.moveaxis(quaternion, -1, 0)
    rows = (
        (w * w + x * x - y * y - z * z, 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)),
        (2.0 * (x * y + w * z), w * w - x * x + y * y - z * z, 2.0 * (y * z - w * x)),
        (2.0 * (x * z - w * y), 2.0 * (y * z + w * x), w * w - x * x - y * y + z * z),
    )
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)


def _completed(given: Array, alone: str) -> Array:
    if given.shape[-2:] == (3, 4):
        return _matrices(given[..., :3], given[..., 3])
    if alone == "rotation" and given.shape[-2:] == (3, 3):
        return _matrices(given, np.zeros(given.shape[:-1]))
    if alone == "position" and given.shape[-1:] == (3,):
        return _matrices(np.eye(3), given)
    return given
