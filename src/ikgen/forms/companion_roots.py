"""Roots of polynomials as eigenvalues."""

from __future__ import annotations

from typing import Any

import numpy as np

__all__ = ["companion_roots"]


def companion_roots(p: Any) -> Any:
    """The roots (..., d) of polynomials (..., d + 1), highest power first, the first coefficient not 0: the
    eigenvalues of their companion matrices."""
    degree = p.shape[-1] - 1
    companion = np.zeros((*p.shape[:-1], degree, degree), dtype=complex)
    companion[..., 1:, :-1] = np.eye(degree - 1)
    companion[..., :, -1] = -p[..., :0:-1] / p[..., :1]
    return np.linalg.eigvals(companion)
