"""The roots of a trigonometric polynomial of any degree, as a function that SymPy knows."""

from __future__ import annotations

from typing import Any

import numpy as np
import sympy

from ikgen.symbolic.circle_angles import circle_angles

__all__ = ["MOST_DEGREE", "TrigPolynomialRoot"]

MOST_DEGREE = 60
"""The largest degree whose roots the eigenvalues of a companion matrix give with enough digits."""


class TrigPolynomialRoot(sympy.Function):
    """`TrigPolynomialRoot(k, low, high, a0, n1, a1, b1, n2, a2, b2, ...)`: the k-th real root u (from 0,
    ascending) from low to high, inside (-pi, pi], of `a0 + a1 cos(n1 u) + b1 sin(n1 u) + ... = 0` with
    whole numbers n.

    `sympy.lambdify` gives arrays, NaN where there are no more than k roots.
    """

    is_real = True

    def _eval_evalf(self, prec: int) -> sympy.Expr | None:
        if not all(a.is_number for a in self.args):
            return None
        return sympy.Float(float(self._imp_(*(float(a) for a in self.args))), 15)

    @staticmethod
    def _imp_(k: Any, low: Any, high: Any, a0: Any, *terms: Any) -> Any:
        """Values at numbers or arrays, from the polynomial in exp(i u)."""
        a0, *given = np.broadcast_arrays(a0, *terms)
        harmonics = [int(n.flat[0]) for n in given[::3]]
        degree = max(harmonics)
        p = np.zeros((*a0.shape, 2 * degree + 1), dtype=complex)
        p[..., degree] = 2 * a0
        for n, a, b in zip(harmonics, given[1::3], given[2::3], strict=True):
            p[..., degree - n] += a - 1j * b
            p[..., degree + n] += a + 1j * b
        angle = circle_angles(p)
        inside = (angle >= np.asarray(low)[..., None]) & (angle <= np.asarray(high)[..., None])
        return np.sort(np.where(inside, angle, np.nan), axis=-1)[..., int(k)]
