"""The roots of a trigonometric polynomial of degree two, as a function that SymPy knows."""

from __future__ import annotations

from typing import Any

import numpy as np
import sympy

from ikgen.symbolic.circle_angles import circle_angles

__all__ = ["TrigQuarticRoot"]


class TrigQuarticRoot(sympy.Function):
    """`TrigQuarticRoot(a2, b2, a1, b1, a0, k)`: the k-th real root u (from 0, in the order of their
    values in (-pi, pi]) of `a2 cos 2u + b2 sin 2u + a1 cos u + b1 sin u + a0 = 0`. There are four at
    most.

    With `z = exp(i u)` they are the roots of `polynomial` on the unit circle. `sympy.lambdify` gives
    arrays, NaN where there are no more than k roots.
    """

    nargs = 6
    is_real = True

    def polynomial(self, z: sympy.Expr) -> sympy.Expr:
        """The polynomial in `z = exp(i u)`, of degree four."""
        a2, b2, a1, b1, a0, _ = self.args
        i = sympy.I
        low = (a2 - i * b2) * z**4 + (a1 - i * b1) * z**3
        return low + 2 * a0 * z**2 + (a1 + i * b1) * z + (a2 + i * b2)

    def _eval_evalf(self, prec: int) -> sympy.Expr | None:
        if not all(a.is_number for a in self.args):
            return None
        value = self._imp_(*(float(a) for a in self.args))
        return sympy.Float(float(value), 15)

    @staticmethod
    def _imp_(a2: Any, b2: Any, a1: Any, b1: Any, a0: Any, k: Any) -> Any:
        """Values at numbers or arrays."""
        a2, b2, a1, b1, a0 = np.broadcast_arrays(a2, b2, a1, b1, a0)
        p = np.stack([a2 - 1j * b2, a1 - 1j * b1, 2 * a0 + 0j, a1 + 1j * b1, a2 + 1j * b2], axis=-1)
        return np.sort(circle_angles(p), axis=-1)[..., int(k)]
