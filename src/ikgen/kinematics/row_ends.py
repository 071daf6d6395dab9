"""The constant transforms at both ends of the rows, as simple as the base and tip frames allow.

Frame 0 may be turned about the first axis and frame n about the last one; theta's offset takes up
the turn exactly. Where the axis lies along a coordinate axis of the base (tip) frame, the turn is
chosen so that the rotation that is left is the identity or permutes the coordinate axes.
"""

from __future__ import annotations

import math

import numpy as np

from ikgen.kinematics.fixed_order import product
from ikgen.kinematics.links import FLIP, Tolerance, align_z
from ikgen.kinematics.offsets import Offsets
from ikgen.kinematics.rigid import inverse, rotation_z
from ikgen.kinematics.snapping import snap_angle, wrap_angle
from ikgen.model.arrays import Array
from ikgen.model.chain import Chain

__all__ = ["base_points_down", "end_transforms", "tidy_pose"]


def base_points_down(chain: Chain, tolerance: Tolerance) -> bool:
    """Whether the first axis runs against the base frame's z, so that z is better reversed."""
    first = chain.axes[0]
    return float(product(first.T_prev_axis[:3, :3], first.axis)[2]) < -math.cos(tolerance.angle)


def end_transforms(
    chain: Chain,
    signs: tuple[int, ...],
    shifts: tuple[Array, ...],
    offsets: Offsets,
    tolerance: Tolerance,
) -> tuple[Array, Array, tuple[float, ...]]:
    """`X_base`, `X_tip` (4, 4) and the rows' thetas (rad) with the ends' turns settled."""
    base = product(chain.axes[0].T_prev_axis, _axis_frame(chain, 0, signs, shifts))
    tip = product(inverse(_axis_frame(chain, -1, signs, shifts)), chain.T_last_tip)
    theta = list(offsets.theta)
    prismatic = chain.axes[0].kind != "revolute", chain.axes[-1].kind != "revolute"

    turn = _turn(base[:3, :3], theta[0], prismatic[0], tolerance)
    X_base = product(base, _screw(turn, offsets.base_lift))
    theta[0] = wrap_angle(theta[0] - turn)

    turn = _turn(tip[:3, :3].T, theta[-1], prismatic[1], tolerance)
    X_tip = product(_screw(turn, offsets.tip_lift), tip)
    theta[-1] = wrap_angle(theta[-1] - turn)
    return tidy_pose(X_base), tidy_pose(X_tip), tuple(theta)


def _turn(R: Array, theta: float, prismatic: bool, tolerance: Tolerance) -> float:
    """Angle about z (rad) that makes `R Rz(angle)` simple, then `theta - angle` small.

    `R` (3, 3) has the axis as its z column, seen from the end's own frame.
    """
    if prismatic:
        return theta
    k = int(np.argmax(np.abs(R[:, 2])))
    if math.hypot(*np.delete(R[:, 2], k)) > tolerance.angle:
        return theta
    onto = [0] if k == 2 and R[2, 2] > 0 else [m for m in range(3) if m != k]
    turns = [math.atan2(-R[m, 1], R[m, 0]) for m in onto]
    if len(onto) > 1:
        turns += [wrap_angle(turn + math.pi) for turn in turns]
    turns = [snap_angle(turn, tolerance.angle) for turn in turns]
    return min(turns, key=lambda turn: (round(abs(wrap_angle(theta - turn)), 6), abs(turn)))


def _axis_frame(chain: Chain, k: int, signs: tuple[int, ...], shifts: tuple[Array, ...]) -> Array:
    """Frame (4, 4) with z along axis k as the rows direct it, in the axis' joint frame."""
    T = np.eye(4)
    R = align_z(chain.axes[k].axis)
    T[:3, :3] = R if signs[k] > 0 else product(R, FLIP)
    T[:3, 3] = product(R, shifts[k])
    return T


def _screw(angle: float, lift: float) -> Array:
    T = np.eye(4)
    T[:3, :3] = rotation_z(angle)
    T[2, 3] = lift
    return T


def tidy_pose(T: Array) -> Array:
    """`T` without round-off around 0 and ±1."""
    whole = np.round(T)
    near = (np.abs(T - whole) < 2e-15) & (np.abs(whole) <= 1.0)
    cleaned = np.where(near, whole, T) + 0.0
    cleaned.setflags(write=False)
    return np.asarray(cleaned)
