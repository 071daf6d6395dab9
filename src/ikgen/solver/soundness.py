"""Does a candidate hold at every regular configuration? Sought numerically where it would not.

A divisor, or the difference of two branches, may vanish on a set that random and special probes miss.
Gauss-Newton steps from the probes find such configurations; those where the arm itself is regular make
the candidate weak.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ikgen.algebra.expression import Expr
from ikgen.equations.equation_set import EquationSet
from ikgen.equations.evaluation import evaluate
from ikgen.equations.probes import Probes, arm_size, smallest_singular
from ikgen.solver.candidate import Candidate

__all__ = ["conditions", "weak_configurations"]

Array = NDArray[np.float64]
STARTS = 24
STEPS = 12
REGULAR = 2e-2
"""Smallest singular value of the pose's derivative above which a configuration counts as regular."""


def conditions(candidate: Candidate, system: EquationSet, values: Array) -> list[Array]:
    """What must not vanish, each (m, N) at configurations `values` (N, dof), in natural units."""
    c = evaluate(system, candidate.coefficients, values)
    z = [max(e.scale, 1e-300) for e in candidate.coefficients]
    out: list[Array] = []
    if candidate.form in ("linear", "root"):
        out.append(c[:1] / z[0])
    elif candidate.form == "pair":
        size = z[0] * z[4] + z[1] * z[3]
        out.append((c[0] * c[4] - c[1] * c[3])[None] / size)
    else:
        out.append(c[: 2 if candidate.form != "quartic" else 4] / max(z[:2]))
    if candidate.form == "sincos":
        u = values @ np.array(candidate.unknown.key, dtype=float)
        out.append((c[0] * np.sin(u) - c[1] * np.cos(u))[None] / max(z[:2]))
    return out


def weak_configurations(candidate: Candidate, system: EquationSet, probes: Probes) -> Array:
    """Regular configurations (k, dof) at which the candidate fails."""
    found: list[Array] = []
    if all(e.is_fixed for e in _divisor_parts(candidate)) and candidate.form != "sincos":
        return np.empty((0, system.dh.dof))
    size = arm_size(system.dh)
    start = probes.values[: probes.regular]
    count = len(conditions(candidate, system, start[:1]))
    for which in range(count):
        q = _descend(candidate, system, start[:STARTS], which, size)
        rest = np.abs(conditions(candidate, system, q)[which]).max(axis=0)
        zero = np.isfinite(rest) & (rest < 1e-9)
        if zero.any():
            at = q[zero]
            found.append(at[smallest_singular(system.dh, at, size) > REGULAR])
    return np.concatenate(found) if found else np.empty((0, system.dh.dof))


def _divisor_parts(candidate: Candidate) -> Sequence[Expr]:
    c = candidate.coefficients
    if candidate.form == "pair":
        return (c[0], c[1], c[3], c[4])
    return c[:1] if candidate.form in ("linear", "root") else c[:2]


def _descend(
    candidate: Candidate, system: EquationSet, start: Array, which: int, size: float
) -> Array:
    """Minimum-norm Gauss-Newton steps towards a zero of one condition."""
    q = start.copy()
    n, dof = q.shape
    h = 1e-6
    revolute = np.array([row.revolute for row in system.variables.primary])
    unit = np.where(revolute, 1.0, size)
    for _ in range(STEPS):
        shifted = np.concatenate([q, *(q + h * unit * np.eye(dof)[j] for j in range(dof))])
        with np.errstate(all="ignore"):
            f = conditions(candidate, system, shifted)[which].reshape(-1, dof + 1, n)
        J = ((f[:, 1:] - f[:, :1]) / h).transpose(2, 0, 1)
        if not np.isfinite(J).all():
            break
        step = np.linalg.pinv(J, rcond=1e-8) @ f[:, 0].T[:, :, None]
        q = q - np.clip(step[:, :, 0], -0.5, 0.5) * unit
    return np.asarray(q)
