"""What the arm angle is measured by, as the text of constants."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ikgen.emit.solver_module import SolverModule
from ikgen.kinematics.elbow_geometry import elbow_geometry

__all__ = ["elbow_text"]


def elbow_text(module: SolverModule, number: Callable[[float], str]) -> dict[str, Any] | None:
    """`frames` to the elbow and the `shoulder`'s, upper three lines, the `wrist` and the length of
    the `upper` arm, written by `number`; None where the arm angle is not held."""
    if not module.dh.arm_angle:
        return None
    found = elbow_geometry(module.dh)

    def lines(T: NDArray[np.float64]) -> list[list[str]]:
        return [[number(float(x) + 0.0) for x in row] for row in T[:3]]

    return {
        "frames": [lines(F) for F in found.elbow],
        "shoulder": lines(found.shoulder),
        "wrist": [number(float(x)) for x in found.wrist],
        "upper": number(found.upper),
    }
