"""How motors move joints: a matrix between the two."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ikgen.model.arrays import Array

__all__ = ["Transmission"]


@dataclass(frozen=True, slots=True)
class Transmission:
    """`joints = matrix @ motors + offset`, and `motors = inverse @ (joints - offset)`: (dof, dof) and
    (dof,), rad or m. There is a motor a joint, called by the joint's name."""

    matrix: Array
    inverse: Array
    offset: Array

    def joints(self, motors: Array) -> Array:
        """Values (..., dof) of the joints at those of the motors."""
        joints: Array = motors @ self.matrix.T + self.offset
        return joints

    def motors(self, joints: Array) -> Array:
        """Values (..., dof) of the motors at those of the joints."""
        motors: Array = (joints - self.offset) @ self.inverse.T
        return motors

    def words(self, names: Sequence[str]) -> tuple[str, ...]:
        """`JOINT=A*k1+B*k2+c` for each joint that its own motor does not move alone and one to one."""
        lines = []
        for joint, row, c in zip(names, self.matrix.tolist(), self.offset.tolist(), strict=True):
            terms = [(name, k) for name, k in zip(names, row, strict=True) if k]
            if c or terms != [(joint, 1.0)]:
                right = "+".join(f"{name}*{k:.9g}" for name, k in terms)
                lines.append(f"{joint}={right}" + (f"{c:+.9g}" if c else ""))
        return tuple(lines)
