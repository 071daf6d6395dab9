"""Does a candidate hold at every regular configuration? Sought numerically where it would not.

A divisor, or the difference of two branches, may vanish on a set that random and special probes miss.
Gauss-Newton steps from the probes find such configurations; those where the arm itself is regular make
the candidate weak.
"""

from __future__ import annotations

import numpy as np

from ikgen.equations.equation_set import EquationSet
from ikgen.equations.evaluation import evaluate
from ikgen.equations.probes import Probes, arm_size, least_regular, smallest_singular
from ikgen.forms.form import scales
from ikgen.kinematics.fixed_order import product
from ikgen.model.arrays import Array
from ikgen.solver.candidate import Candidate

__all__ = ["conditions", "weak_configurations"]

STARTS = 24
STEPS = 12
REGULAR = 2e-2
"""Smallest singular value of what the task reads above which a configuration usually counts as
regular."""


def conditions(candidate: Candidate, system: EquationSet, values: Array) -> list[Array]:
    """What must not vanish, each (m, N) at configurations `values` (N, dof), in natural units."""
    form = candidate.form
    c, z = list(evaluate(system, form.coefficients, values)), scales(form.coefficients)
    fold = form.fold(c, z, product(values, np.array(candidate.unknown.combination, dtype=float)))
    return [form.divisor(c, z)] if fold is None else [form.divisor(c, z), fold]


def weak_configurations(candidate: Candidate, system: EquationSet, probes: Probes) -> Array:
    """Regular configurations (k, dof) at which the candidate fails."""
    found: list[Array] = []
    size = arm_size(system.dh)
    start = probes.values[: probes.regular]
    count = len(conditions(candidate, system, start[:1]))
    constant = all(e.is_fixed for e in candidate.form.divisor_parts)
    for which in range(1 if constant else 0, count):
        q = _descend(candidate, system, start[:STARTS], which, size)
        rest = np.abs(conditions(candidate, system, q)[which]).max(axis=0)
        zero = np.isfinite(rest) & (rest < 1e-9)
        if zero.any():
            at = q[zero]
            smallest = smallest_singular(
                system.dh, at, size, readable=system.readable, tool=system.tool_on_right
            )
            found.append(at[smallest > least_regular(REGULAR, probes.typical)])
    return np.concatenate(found) if found else np.empty((0, system.dh.dof))


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
