"""Forward kinematics and Jacobian of a serial chain, for any number of configurations at once."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ikgen.runtime.python.array_types import Array, Flags
from ikgen.runtime.python.real_numbers import real_array

__all__ = [
    "Chain",
    "Motion",
    "chain_of",
    "cross",
    "forward",
    "jacobian",
    "joint_axes",
    "tip_and_jacobian",
]

Motion = tuple[int, bool, float, float]  # joint, whether it turns, scale and offset of its value


@dataclass(frozen=True)
class Chain:
    """`T = F_0 M(v_1) F_1 ... M(v_n) F_n`, M a rotation about or a motion along z,
    `v_i = scale_i * q[joint_i] + offset_i`.

    `frames` (n + 1, 4, 4) and `motions` say the same as `parts` (4, n, 4, 4), with which
    `M(v) F = cos(v) parts[0] + sin(v) parts[1] + v parts[2] + parts[3]`, `joint`, `scale`, `offset` (n,),
    `turning` (n, 1), whether M is a rotation, `slides`, whether one is not, and `drive` (n, dof), the
    derivatives of v by q. `revolute` (dof): whose values are the same
    configuration exactly where they differ by whole turns.
    """

    frames: Array
    motions: tuple[Motion, ...]
    parts: Array
    joint: NDArray[np.intp]
    scale: Array
    offset: Array
    turning: Flags
    slides: bool
    drive: Array
    revolute: tuple[bool, ...]


def chain_of(frames: Array, motions: tuple[Motion, ...], dof: int) -> Chain:
    """The chain of constant frames (n + 1, 4, 4) and the motions between them (n)."""
    parts = np.zeros((4, len(motions), 4, 4))
    for i, (_, turning, _, _) in enumerate(motions):
        F = frames[i + 1]
        if turning:
            parts[0, i, :2] = F[:2]
            parts[1, i, 0], parts[1, i, 1] = -F[1], F[0]
            parts[3, i, 2:] = F[2:]
        else:
            parts[2, i, 2] = F[3]
            parts[3, i] = F
    joint = np.array([m[0] for m in motions])
    scale, offset = (np.array([m[i] for m in motions]) for i in (2, 3))
    turns = np.array([[m[1]] for m in motions])
    drive = scale[:, None] * (joint[:, None] == np.arange(dof))
    revolute = tuple(_turns_freely([m for m in motions if m[0] == j]) for j in range(dof))
    slides = not turns.all()
    return Chain(frames, motions, parts, joint, scale, offset, turns, slides, drive, revolute)


def _turns_freely(motions: Sequence[Motion]) -> bool:
    """Whether a joint's values are the same configuration where they differ by whole turns, and only
    there: not with a motion that turns by another ratio."""
    _, turning, ratio, _ = motions[0]
    return turning and abs(ratio) == 1.0 and all(abs(m[2] - round(m[2])) < 1e-12 for m in motions)


def _steps(chain: Chain, q: Array) -> Array:
    """The transforms `M(v_i) F_i` at q (..., dof): (..., n, 4, 4)."""
    v = (q[..., chain.joint] * chain.scale + chain.offset)[..., None, None]
    cosine, sine, value, rest = chain.parts
    steps = np.cos(v) * cosine + np.sin(v) * sine + rest
    return np.asarray(steps + v * value if chain.slides else steps)


def _joint_values(chain: Chain, q: ArrayLike) -> Array:
    values, dof = real_array(q, "q"), chain.drive.shape[1]
    if values.ndim < 1 or values.shape[-1] != dof:
        raise ValueError(f"q has shape {values.shape}, expected (..., {dof})")
    return values


def forward(chain: Chain, q: ArrayLike) -> Array:
    """Tip poses (..., 4, 4) at q (..., dof); raises ValueError for another shape."""
    steps = _steps(chain, _joint_values(chain, q))
    T: Array = chain.frames[0]
    for i in range(len(chain.motions)):
        T = T @ steps[..., i, :, :]
    return T


def jacobian(chain: Chain, q: ArrayLike) -> Array:
    """Geometric Jacobians (..., 6, dof) at q (..., dof); raises ValueError for another shape."""
    return tip_and_jacobian(chain, _joint_values(chain, q))[1]


def cross(a: Array, b: Array) -> Array:
    """Cross products of (..., 3); for few of them several times faster than np.cross."""
    x, y, z = a[..., 0], a[..., 1], a[..., 2]
    u, v, w = b[..., 0], b[..., 1], b[..., 2]
    return np.stack([y * w - z * v, z * u - x * w, x * v - y * u], axis=-1)


def joint_axes(chain: Chain, q: Array) -> tuple[Array, Array, Array]:
    """Directions (..., n, 3) of the axes, points (..., n, 3) on them, and tip poses (..., 4, 4)."""
    steps, count = _steps(chain, q), len(chain.motions)
    T = np.broadcast_to(chain.frames[0], (*q.shape[:-1], 4, 4))
    axes = np.empty((*q.shape[:-1], count, 3, 2))
    for i in range(count):
        axes[..., i, :, :] = T[..., :3, 2:]
        T = T @ steps[..., i, :, :]
    return axes[..., 0], axes[..., 1], T


def tip_and_jacobian(chain: Chain, q: Array) -> tuple[Array, Array]:
    """Tip poses (..., 4, 4) and geometric Jacobians (..., 6, dof), linear rows first."""
    z, p, T = joint_axes(chain, q)
    r = T[..., None, :3, 3] - p
    J = np.empty((*z.shape[:-2], 6, z.shape[-2]))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        J[..., i, :] = z[..., j] * r[..., k] - z[..., k] * r[..., j]
        J[..., 3 + i, :] = z[..., i]
    if chain.slides:
        slide = ~chain.turning[:, 0]
        J[..., :3, slide], J[..., 3:, slide] = np.swapaxes(z, -1, -2)[..., slide], 0.0
    return T, J @ chain.drive
