"""Values of trigonometric polynomials at configurations."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ikgen.algebra.polynomial import Polynomial

__all__ = ["polynomial_values"]


def polynomial_values(polynomial: Polynomial, values: NDArray[np.float64]) -> NDArray[np.float64]:
    """The polynomial (N,) at variables (N, dof), its coefficients at the probe of the same place."""
    total = np.zeros(len(values))
    for (trigs, slides), coefficient in polynomial.items():
        term = coefficient.probe.copy()
        for key, kind in trigs:
            term *= (np.cos if kind == "c" else np.sin)(values @ np.array(key))
        for joint, power in slides:
            term *= values[:, joint] ** power
        total += term
    return total
