"""What a leaf proposes: the solution of one unknown in closed form, not yet chosen."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from ikgen.algebra.expression import Expr
from ikgen.equations.equation_set import Equation
from ikgen.equations.knowledge import Variable

__all__ = ["Candidate", "Judgement"]


@dataclass(frozen=True, slots=True)
class Judgement:
    """How a candidate did at the probes: `weak` if its divisor vanishes at regular configurations,
    `margin` the smallest relative divisor there, `fragile` the share of singular configurations where
    it vanishes, `cost` of what has to be computed newly. `almost_tangent`: the constant of `A cos + B sin
    = C` is there for rounded constants alone, so the branches lie half a turn apart but for rounding."""

    weak: bool
    margin: float
    fragile: float
    cost: float
    almost_tangent: bool = False


@dataclass(frozen=True, slots=True)
class Candidate:
    """A solution form with its coefficients (known expressions).

    Forms and coefficients, u the unknown angle with cosine c and sine s, x an unknown length:

    - "linear"  (A, B):  A x + B = 0
    - "root"    (A, B, C): A x^2 + B x + C = 0
    - "pair"    (A1, B1, C1, A2, B2, C2): A_i c + B_i s = C_i
    - "sincos"  (A, B, C): A c + B s = C
    - "tangent" (X, Y): K c = X, K s = Y, K an unknown factor of either sign
    - "quartic" (a2, b2, a1, b1, a0): a2 cos 2u + b2 sin 2u + a1 c + b1 s + a0 = 0
    """

    unknown: Variable
    leaf: str
    form: str
    coefficients: tuple[Expr, ...]
    sources: tuple[Equation, ...]
    note: str = ""
    judgement: Judgement | None = field(default=None, compare=False)

    @property
    def is_weak(self) -> bool:
        """Whether it was judged to fail at some regular configuration."""
        return self.judgement is not None and self.judgement.weak

    @property
    def branches(self) -> int:
        """Number of alternatives the form gives."""
        return {"linear": 1, "pair": 1, "root": 2, "sincos": 2, "tangent": 2, "quartic": 4}[
            self.form
        ]

    def divisor(self) -> tuple[NDArray[np.float64], float]:
        """The divisor at the probes, and its natural size."""
        c = [e.probe for e in self.coefficients]
        z = [max(e.scale, 1e-300) for e in self.coefficients]
        if self.form in ("linear", "root"):
            return c[0], z[0]
        if self.form == "pair":
            return c[0] * c[4] - c[1] * c[3], z[0] * z[4] + z[1] * z[3]
        if self.form in ("sincos", "tangent"):
            return np.hypot(c[0], c[1]), max(z[0], z[1])
        size = np.sqrt(sum(x * x for x in c[:4]))
        return size, max(z[:4])

    def discriminant(self) -> NDArray[np.float64] | None:
        """What is under the square root at the probes, relative to its natural size: two branches meet
        where it vanishes. None for forms without one."""
        c = [e.probe for e in self.coefficients]
        with np.errstate(all="ignore"):
            if self.form == "sincos":
                return np.asarray(1.0 - c[2] ** 2 / (c[0] ** 2 + c[1] ** 2))
            if self.form == "root":
                size = c[1] ** 2 + np.abs(4 * c[0] * c[2])
                return np.asarray((c[1] ** 2 - 4 * c[0] * c[2]) / size)
        return None

    def values(self) -> list[tuple[NDArray[np.float64], ...]]:
        """Per branch, the unknown at the probes: (c, s) or (x,). NaN where the divisor vanishes."""
        c = [e.probe for e in self.coefficients]
        with np.errstate(all="ignore"):
            return _VALUES[self.form](c)


Arrays = list[NDArray[np.float64]]


def _linear(c: Arrays) -> list[tuple[NDArray[np.float64], ...]]:
    return [(-c[1] / c[0],)]


def _root(c: Arrays) -> list[tuple[NDArray[np.float64], ...]]:
    w = np.sqrt(np.maximum(c[1] ** 2 - 4 * c[0] * c[2], 0))
    return [((-c[1] + w) / (2 * c[0]),), ((-c[1] - w) / (2 * c[0]),)]


def _pair(c: Arrays) -> list[tuple[NDArray[np.float64], ...]]:
    det = c[0] * c[4] - c[1] * c[3]
    return [((c[2] * c[4] - c[5] * c[1]) / det, (c[0] * c[5] - c[3] * c[2]) / det)]


def _sincos(c: Arrays) -> list[tuple[NDArray[np.float64], ...]]:
    a, b, r = c
    h = a * a + b * b
    w = np.sqrt(np.maximum(h - r * r, 0))
    return [((a * r - k * b * w) / h, (b * r + k * a * w) / h) for k in (1, -1)]


def _tangent(c: Arrays) -> list[tuple[NDArray[np.float64], ...]]:
    h = np.hypot(c[0], c[1])
    return [(k * c[0] / h, k * c[1] / h) for k in (1, -1)]


def _quartic(c: Arrays) -> list[tuple[NDArray[np.float64], ...]]:
    """Roots in theta from the companion matrix of the self-inversive polynomial in exp(i u)."""
    a2, b2, a1, b1, a0 = c
    out = np.full((4, 2, len(a2)), np.nan)
    for n in range(len(a2)):
        p = np.array(
            [
                a2[n] - 1j * b2[n],
                a1[n] - 1j * b1[n],
                2 * a0[n],
                a1[n] + 1j * b1[n],
                a2[n] + 1j * b2[n],
            ]
        )
        if not np.all(np.isfinite(p)) or np.abs(p[0]) < 1e-13 * np.abs(p).max():
            p = p[1:4]
            if abs(p[0]) == 0:
                continue
        z = np.roots(p)
        for k, root in enumerate(z):
            if abs(abs(root) - 1) < 1e-4:
                out[k, :, n] = root.real / abs(root), root.imag / abs(root)
    return [(out[k, 0], out[k, 1]) for k in range(4)]


_VALUES = {
    "linear": _linear,
    "root": _root,
    "pair": _pair,
    "sincos": _sincos,
    "tangent": _tangent,
    "quartic": _quartic,
}
