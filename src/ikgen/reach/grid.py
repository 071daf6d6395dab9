"""The poses of a map: a grid of positions, each with the same orientations."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ikgen.errors import UsageError
from ikgen.kinematics.forward import file_forward
from ikgen.kinematics.joint_box import joint_box
from ikgen.model.arrays import Array
from ikgen.model.dh import DHChain

__all__ = ["Grid", "grid_over", "orientations"]


_SAMPLES, _SEED = 20000, 3
_MOST = 4 * 10**9
_WITHOUT_LIMIT = 1.0
"""Travel (m) to each side of a sliding joint without limits."""


@dataclass(frozen=True, slots=True)
class Grid:
    """Coordinates `x`, `y`, `z` (m) in the base link; `rotations` (n, 3, 3) of the tip link. A pose's place
    is the position's (z fastest) times n, plus the rotation's."""

    x: Array
    y: Array
    z: Array
    rotations: Array

    @property
    def shape(self) -> tuple[int, int, int, int]:
        """Positions along each axis, and rotations."""
        return len(self.x), len(self.y), len(self.z), len(self.rotations)

    @property
    def poses(self) -> int:
        """How many poses there are."""
        return math.prod(self.shape)

    @property
    def step(self) -> float:
        """From one position to the next (m); 0 where there is one alone."""
        return max(float(np.diff(axis).max(initial=0.0)) for axis in (self.x, self.y, self.z))

    @property
    def positions(self) -> Array:
        """(k, 3), z fastest."""
        return np.stack(np.meshgrid(self.x, self.y, self.z, indexing="ij"), axis=-1).reshape(-1, 3)


def orientations(directions: int, rolls: int) -> Array:
    """(directions * rolls, 3, 3): tool axes z spread evenly over the sphere (a Fibonacci lattice;
    Gonzalez, 2010), each with its x axis turned to `rolls` places, the first as level as can be."""
    k = np.arange(directions) + 0.5
    height = 1.0 - 2.0 * k / directions
    angle = np.pi * (1.0 + math.sqrt(5.0)) * k
    flat = np.sqrt(1.0 - height**2)
    z = np.stack([flat * np.cos(angle), flat * np.sin(angle), height], axis=1)
    level = np.stack([-np.sin(angle), np.cos(angle), np.zeros(directions)], axis=1)
    out = []
    for axis, side in zip(z, level, strict=True):
        other = np.cross(axis, side)
        for roll in 2.0 * np.pi * np.arange(rolls) / rolls:
            x = math.cos(roll) * side + math.sin(roll) * other
            out.append(np.stack([x, np.cross(axis, x), axis], axis=1))
    return np.array(out)


def grid_over(dh: DHChain, cells: int, directions: int, rolls: int) -> Grid:
    """A grid of cubes, `cells` along the longest side of the box around all that the tip reaches, found
    from random configurations inside the limits. Raises `UsageError` for more than four billion poses."""
    low, high = _box(dh)
    side = max(float((high - low).max()) / cells, 1e-6)
    counts = np.maximum(np.ceil((high - low) / side - 1e-9).astype(int), 1)
    middle = (low + high) / 2
    axes = [m + side * (np.arange(n) - (n - 1) / 2) for m, n in zip(middle, counts, strict=True)]
    total = int(counts.prod()) * directions * rolls
    if total > _MOST:
        raise UsageError(f"{total} poses are too many for one map", hint="take fewer --cells")
    return Grid(axes[0], axes[1], axes[2], orientations(directions, rolls))


def _box(dh: DHChain) -> tuple[Array, Array]:
    """The corners (3,), m, of the tip's positions."""
    low, high = joint_box(dh, _WITHOUT_LIMIT)
    draws = np.random.default_rng(_SEED).uniform(size=(_SAMPLES, dh.dof))
    tips = file_forward(dh, low + draws * (high - low))[:, :3, 3]
    return tips.min(axis=0), tips.max(axis=0)
