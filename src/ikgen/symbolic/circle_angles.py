"""The real roots of trigonometric polynomials, as roots of polynomials on the unit circle."""

from __future__ import annotations

from typing import Any

import numpy as np

from ikgen.forms.companion_roots import companion_roots

__all__ = ["circle_angles"]


def circle_angles(p: Any) -> Any:
    """The angles (..., d) of the roots on the unit circle of polynomials (..., d + 1), highest power first;
    NaN in place of other roots, and where coefficients are no numbers or the first is 0."""
    usable = np.isfinite(p).all(axis=-1) & (np.abs(p[..., 0]) > 0.0)
    elsewhere = np.eye(p.shape[-1])[0]
    elsewhere[-1] = 16.0  # no root on the circle
    z = companion_roots(np.where(usable[..., None], p, elsewhere))
    return np.where(np.abs(np.abs(z) - 1.0) < 1e-6, np.angle(z), np.nan)
