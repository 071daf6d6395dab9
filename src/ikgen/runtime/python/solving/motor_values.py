"""Values of motors in place of joints', where a matrix is between the two."""

from __future__ import annotations

from dataclasses import dataclass, replace

from numpy.typing import ArrayLike

from ikgen.runtime.python.arrays.array_types import Array
from ikgen.runtime.python.arrays.real_numbers import real_array
from ikgen.runtime.python.rows.solutions import Solutions
from ikgen.runtime.python.solving.path_following import Path

__all__ = ["Motors"]


@dataclass(frozen=True)
class Motors:
    """`joints = matrix @ motors + offset`: (dof, dof) and (dof,); `inverse` is the matrix's."""

    matrix: Array
    inverse: Array
    offset: Array

    def joints(self, motors: ArrayLike, name: str = "q") -> Array:
        """Values (..., dof) of the joints at those of the motors, called `name`; of another shape they come
        back as they are, for the arm to refuse. Raises ValueError for what is no array of numbers."""
        values = real_array(motors, name)
        if values.shape[-1:] != self.offset.shape:
            return values
        joints: Array = values @ self.matrix.T + self.offset
        return joints

    def seed(self, motors: ArrayLike | None) -> Array | None:
        """`joints` of a seed, if there is one."""
        return None if motors is None else self.joints(motors, "seed")

    def rows(self, joints: Array) -> Array:
        """Values (..., dof) of the motors at those of the joints."""
        motors: Array = (joints - self.offset) @ self.inverse.T
        return motors

    def solutions(self, found: Solutions) -> Solutions:
        """Solutions with rows of motors."""
        names = found.names

        def by_motors(rows: Array) -> tuple[str, ...]:
            return () if names is None else names(self.joints(rows))

        return replace(found, q=self.rows(found.q), names=by_motors)

    def path(self, found: Path) -> Path:
        """A path of motors."""
        return replace(found, q=self.rows(found.q))
