"""A path through poses that were marked in the scene, followed by the emitted module: where it leads, and
where the status changes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ikgen.kinematics.quaternion_rotation import quaternion, rotation
from ikgen.model.arrays import Array
from ikgen.verify.runners.python_module import PythonModule

__all__ = ["Followed", "between", "followed"]


_STEP, _MOST = 0.02, 2000
"""Length (of the arm's size) or turn (rad) from one pose to the next, and how many poses at most."""


def between(marks: Sequence[Array], size: float) -> Array:
    """Poses (N, 4, 4) on straight lines through the marked ones (4, 4), turning about one axis between two
    of them; the marks are among them."""
    poses = [marks[0]]
    for start, end in pairwise(marks):
        a, b = quaternion(start[:3, :3]), quaternion(end[:3, :3])
        b = -b if a @ b < 0 else b
        angle = float(np.arccos(np.minimum(1.0, a @ b)))
        way = float(np.linalg.norm(end[:3, 3] - start[:3, 3])) / size + 2.0 * angle
        steps = int(np.clip(np.ceil(way / _STEP), 1, max(1, _MOST // len(marks))))
        for t in np.arange(1, steps + 1) / steps:
            T = np.eye(4)
            T[:3, 3] = (1.0 - t) * start[:3, 3] + t * end[:3, 3]
            T[:3, :3] = rotation(_slerp(a, b, angle, float(t)))
            poses.append(T)
    return np.array(poses)


def _slerp(a: Array, b: Array, angle: float, t: float) -> Array:
    """Shoemake (Animating rotation with quaternion curves, 1985)."""
    if angle < 1e-9:
        return (1.0 - t) * a + t * b
    return np.asarray((np.sin((1.0 - t) * angle) * a + np.sin(t * angle) * b) / np.sin(angle))


@dataclass(frozen=True, slots=True)
class Followed:
    """Joint values `q` (reached, dof) along `poses` (N, 4, 4), the `status` that ended it, and by itself
    of each pose (`alone`, N)."""

    poses: Array
    q: Array
    status: str
    alone: tuple[str, ...]

    @property
    def changes(self) -> tuple[int, ...]:
        """Indices of poses whose own status is another one than that of the pose before."""
        pairs = enumerate(pairwise(self.alone), start=1)
        return tuple(i for i, (before, after) in pairs if before != after)

    @property
    def words(self) -> str:
        """Markdown for people."""
        n = len(self.poses)
        end = "" if self.status == "OK" else f"; the next is **{self.status}**"
        lines = [f"**{len(self.q)} of {n}** poses followed{end}"]
        lines += [
            f"- pose {i + 1}: {self.alone[i - 1]}, then {self.alone[i]}" for i in self.changes
        ]
        return "\n".join(lines)


def followed(runner: PythonModule, poses: Array, start: Array, held: Array | None) -> Followed:
    """Follow poses (N, 4, 4) from the row nearest to `start` (dof,); `held` are values of held joints that
    each pose is solved with by itself."""
    path = runner.module.follow(poses, start=start)
    alone = runner.solve_batch(poses, free=held)
    assert alone is not None
    q = np.asarray(path.q, dtype=float)[: path.reached]
    return Followed(poses, q, path.status.name, alone.status)
