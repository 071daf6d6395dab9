"""The file's own chain, written with the DH variables, and how far the exact rows are from it."""

from __future__ import annotations

import math

import numpy as np

from ikgen.kinematics.fixed_order import dot, length, product
from ikgen.kinematics.forward import dh_forward, file_forward, pose_difference, row_constant
from ikgen.kinematics.rigid import axis_motion, inverse, read_only, z_motion
from ikgen.model.arrays import Array
from ikgen.model.chain import REVOLUTE, Chain
from ikgen.model.dh import DHChain, DHRow

__all__ = [
    "file_frames", "frames_beside", "frames_of_chain", "largest_deviation", "random_configurations",
]  # fmt: skip

_SAMPLES = 64
_FAR = 10.0  # over the arm's length
_RAIL = 30.0  # m
_SEED = 20180513
_SAME = 1e-14
_CLEAN = 1e-15


def file_frames(
    chain: Chain,
    rows: tuple[DHRow, ...],
    signs: tuple[int, ...],
    offsets: tuple[float, ...],
    ends: tuple[Array, Array],
) -> tuple[Array, ...]:
    """The n + 1 constants F_i (4, 4) of `T = F_0 M_1(v_1) F_1 ... M_n(v_n) F_n`, as in the file.

    With every axis at 0, B_i is the frame on the file's axis i nearest to DH frame i (`offsets`
    (n,) are the DH variables there, `signs` the directions), or where that is far along an axis that turns,
    as nearly parallel axes have their common normal far away, at the file's own origin. `T = prod(B_i
    M_i(v_i - offset_i) B_i^-1) T(0)`, the product of exponentials (Lynch and Park, Modern Robotics, section
    4.1), is then regrouped.
    """
    axes, T = [], np.eye(4)
    for axis, sign in zip(chain.axes, signs, strict=True):
        T = product(T, axis.T_prev_axis)
        axes.append((T, sign * axis.axis))
    return _frames(axes, product(T, chain.T_last_tip), rows, offsets, ends)


def frames_of_chain(chain: Chain, dh: DHChain) -> tuple[Array, ...]:
    """The constants of another chain with the joints of `dh`, written with the variables of its rows."""
    axes, T = [], np.eye(4)
    for axis, row in zip(chain.axes, dh.rows, strict=True):
        T = product(T, axis.T_prev_axis)
        axes.append((T, math.copysign(1.0, row.scale * axis.multiplier) * axis.axis))
        T = product(T, axis_motion(axis.kind == REVOLUTE, axis.axis, axis.offset))
    offsets = tuple(row.offset.value for row in dh.rows)
    return _frames(axes, product(T, chain.T_last_tip), dh.rows, offsets, (dh.X_base, dh.X_tip))


def frames_beside(
    dh: DHChain, rows: tuple[DHRow, ...], ends: tuple[Array, Array]
) -> tuple[Array, ...]:
    """The constants of the file's chain of `dh`, written with the variables of other `rows`."""
    axes, T, z = [], np.eye(4), np.array([0.0, 0.0, 1.0])
    for F, row in zip(dh.file_frames, dh.rows, strict=False):
        T = product(T, F)
        axes.append((T, z))
        T = product(T, z_motion(row.revolute, row.offset.value))
    offsets = tuple(row.offset.value for row in rows)
    return _frames(axes, product(T, dh.file_frames[-1]), rows, offsets, ends)


def _frames(
    axes: list[tuple[Array, Array]],
    T_home: Array,
    rows: tuple[DHRow, ...],
    offsets: tuple[float, ...],
    ends: tuple[Array, Array],
) -> tuple[Array, ...]:
    """The constants between the `axes` (frame and direction in it), the tip being at `T_home`."""
    X_base, X_tip = ends
    nominal = [X_base, *(row_constant(row) for row in rows[1:]), X_tip]
    F: list[Array] = []
    pending, T_dh = np.eye(4), X_base
    places = np.array([*(frame[:3, 3] for frame, _ in axes), T_home[:3, 3]])
    far = _FAR * float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum())
    for i, ((T_axis, axis), row) in enumerate(zip(axes, rows, strict=True)):
        if i:
            T_dh = product(T_dh, row_constant(row))
        home = z_motion(row.revolute, offsets[i])
        T_dh = product(T_dh, home)
        B = _nearest_frame(T_dh, T_axis, axis, row.revolute, far)
        F.append(product(pending, B, inverse(home)))
        pending = inverse(B)
    F.append(product(pending, T_home))
    return tuple(read_only(_clean(f, exact)) for f, exact in zip(F, nominal, strict=True))


def _nearest_frame(T_dh: Array, T_axis: Array, axis: Array, revolute: bool, far: float) -> Array:
    """The frame with z exactly along the file's axis, otherwise as near to `T_dh` as it can be, unless that
    is farther than `far` (m) along the axis."""
    z = product(T_axis[:3, :3], axis)
    z = z / length(z)
    x = T_dh[:3, 0] - z * dot(z, T_dh[:3, 0])
    x = x / length(x)
    B = np.eye(4)
    B[:3, 0], B[:3, 1], B[:3, 2] = x, np.cross(z, x), z
    origin = T_dh[:3, 3]
    if revolute:
        along = dot(z, origin - T_axis[:3, 3])
        origin = T_axis[:3, 3] + z * (along if abs(along) <= far else 0.0)
    B[:3, 3] = origin
    return B


def largest_deviation(dh: DHChain) -> tuple[float, float]:
    """Largest distance (m) and angle (rad) between the exact rows and the file's chain, slides as far out
    as they go: what turns a base by little takes the end of its rail far."""
    q = random_configurations(dh, travel=_RAIL)
    return pose_difference(dh_forward(dh, q), file_forward(dh, q))


def random_configurations(
    dh: DHChain, count: int = _SAMPLES, seed: int = _SEED, travel: float = 1.0
) -> Array:
    """Joint values (count, dof): revolute over a full turn, prismatic within limits and `travel` (m) to
    either side, ±1 m where they have none."""
    rng = np.random.default_rng(seed)
    low = np.full(dh.dof, -np.pi)
    high = np.full(dh.dof, np.pi)
    for k, joint in enumerate(dh.joints):
        if joint.kind != "revolute":
            bounded = np.isfinite([joint.limits.lower, joint.limits.upper]).all()
            most = travel if bounded else 1.0
            low[k], high[k] = max(joint.limits.lower, -most), min(joint.limits.upper, most)
            if not low[k] < high[k]:
                low[k], high[k] = -1.0, 1.0
    return rng.uniform(low, high, (count, dh.dof))


def _clean(F: Array, nominal: Array) -> Array:
    """The exact constant where `F` is that to round-off, else `F` without noise around 0 and ±1."""
    if float(np.max(np.abs(F - nominal))) < _SAME:
        return np.array(nominal)
    cleaned = F.copy()
    whole = np.round(F)
    near = (np.abs(F - whole) < _CLEAN) & (np.abs(whole) <= 1.0)
    cleaned[near] = whole[near]
    return np.asarray(cleaned + 0.0)
