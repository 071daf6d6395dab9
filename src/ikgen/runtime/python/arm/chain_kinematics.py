"""Forward kinematics and Jacobian of a serial chain, for any number of configurations at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ikgen.runtime.python.arrays.array_types import Array, Index
from ikgen.runtime.python.arrays.real_numbers import real_array

__all__ = [
    "Chain",
    "Motion",
    "chain_of",
    "cross",
    "forward",
    "in_line",
    "jacobian",
    "joint_axes",
    "link_motions",
    "tip_and_jacobian",
]

Motion = tuple[int, bool, float, float]  # joint, whether it turns, scale and offset of its value


@dataclass(frozen=True)
class Chain:
    """`T = F_0 M(v_1) F_1 ... M(v_n) F_n`, M a rotation about or a motion along z,
    `v_i = scale_i * q[joint_i] + offset_i`.

    `frames` (n + 1, 4, 4) and `motions` say the same as `parts` (n, 3, 16), `joint`, `scale`, `offset`
    (n,): of `M(v_i) F_i`, the first `F_0 M(v_1) F_1`, the entries in one line are `cos(v_i) parts[i, 0]
    + sin(v_i) parts[i, 1] + parts[i, 2]`, with v_i in place of the cosine where i is one of `slides`.
    `links` (n, 3, 16): `parts` of `M(v_1) F_1` without F_0.
    `drive` (n, dof): the derivatives of v by q, None where they are 1.
    """

    frames: Array
    motions: tuple[Motion, ...]
    parts: Array
    links: Array
    joint: Index
    scale: Array
    offset: Array
    slides: tuple[int, ...]
    drive: Array | None
    dof: int


def chain_of(frames: Array, motions: tuple[Motion, ...], dof: int) -> Chain:
    """The chain of constant frames (n + 1, 4, 4) and the motions between them (n)."""
    parts = np.zeros((len(motions), 3, 4, 4))
    for i, (_, turning, _, _) in enumerate(motions):
        F = frames[i + 1]
        if turning:
            parts[i, 0, :2] = F[:2]
            parts[i, 1, 0], parts[i, 1, 1] = -F[1], F[0]
            parts[i, 2, 2:] = F[2:]
        else:
            parts[i, 0, 2] = F[3]
            parts[i, 2] = F
    links = parts.reshape(-1, 3, 16).copy()
    parts[0] = frames[0] @ parts[0]
    joint = np.array([m[0] for m in motions])
    scale, offset = (np.array([m[i] for m in motions]) for i in (2, 3))
    slides = tuple(i for i, m in enumerate(motions) if not m[1])
    drive = scale[:, None] * (joint[:, None] == np.arange(dof))
    direct = np.array_equal(drive, np.eye(dof))
    return Chain(
        frames,
        motions,
        parts.reshape(-1, 3, 16),
        links,
        joint,
        scale,
        offset,
        slides,
        None if direct else drive,
        dof,
    )


def link_motions(chain: Chain, parts: Array, q: Array) -> Array:
    """The transforms (n, k, 4, 4) that `parts` of the chain stand for, or its `links`, at q (k, dof)."""
    v = (q if chain.drive is None else q[:, chain.joint] * chain.scale) + chain.offset
    trig = np.empty((len(chain.motions), len(q), 3))
    trig[:, :, 2] = 1.0
    np.cos(v.T, out=trig[:, :, 0])
    np.sin(v.T, out=trig[:, :, 1])
    for i in chain.slides:
        trig[i, :, 0], trig[i, :, 1] = v[:, i], 0.0
    return np.asarray((trig @ parts).reshape(*trig.shape[:2], 4, 4))


def in_line(chain: Chain, q: ArrayLike) -> tuple[tuple[int, ...], Array]:
    """The shape of what q (..., dof) are in front, and q (k, dof)."""
    values, dof = real_array(q, "q"), chain.dof
    if values.ndim < 1 or values.shape[-1] != dof:
        raise ValueError(f"q has shape {values.shape}, expected (..., {dof})")
    return values.shape[:-1], values.reshape(-1, dof)


def forward(chain: Chain, q: ArrayLike) -> Array:
    """Tip poses (..., 4, 4) at q (..., dof); raises ValueError for another shape."""
    shape, rows = in_line(chain, q)
    steps = link_motions(chain, chain.parts, rows)
    T: Array = steps[0]
    for step in steps[1:]:
        T = T @ step
    return T.reshape(*shape, 4, 4)


def jacobian(chain: Chain, q: ArrayLike) -> Array:
    """Geometric Jacobians (..., 6, dof) at q (..., dof); raises ValueError for another shape."""
    shape, rows = in_line(chain, q)
    return np.asarray(tip_and_jacobian(chain, rows)[1].reshape(*shape, 6, rows.shape[1]))


def cross(a: Array, b: Array) -> Array:
    """Cross products of (..., 3); for few of them several times faster than np.cross."""
    x, y, z = a[..., 0], a[..., 1], a[..., 2]
    u, v, w = b[..., 0], b[..., 1], b[..., 2]
    first = y * w - z * v
    out = np.empty((*first.shape, 3), first.dtype)
    out[..., 0], out[..., 1], out[..., 2] = first, z * u - x * w, x * v - y * u
    return out


def joint_axes(chain: Chain, q: Array) -> Array:
    """Frames (n + 1, k, 4, 4) on the axes, z along them, and the tip's, at q (k, dof)."""
    steps = link_motions(chain, chain.parts, q)
    T = np.empty((len(steps) + 1, *steps.shape[1:]))
    T[0], T[1] = chain.frames[0], steps[0]
    for i in range(1, len(steps)):
        np.matmul(T[i], steps[i], out=T[i + 1])
    return T


def tip_and_jacobian(chain: Chain, q: Array) -> tuple[Array, Array]:
    """Tip poses (k, 4, 4) and geometric Jacobians (k, 6, dof), linear rows first, at q (k, dof)."""
    T = joint_axes(chain, q)
    z, p = T[:-1, :, :3, 2:].transpose(3, 2, 0, 1).copy()
    r = T[-1, :, :3, 3].T[:, None] - p
    J = np.empty((6, *z.shape[1:]))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        np.subtract(z[j] * r[k], z[k] * r[j], out=J[i])
    J[3:] = z
    for i in chain.slides:
        J[:3, i], J[3:, i] = z[:, i], 0.0
    out = J.transpose(2, 0, 1)
    return T[-1], out if chain.drive is None else out @ chain.drive
