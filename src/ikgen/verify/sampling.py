"""Labelled, seeded sets of configurations and poses to put an arm through.

Each set is drawn from a generator of its own, so that one more set leaves the others as they were.
"""

from __future__ import annotations

import zlib
from dataclasses import dataclass

import numpy as np

from ikgen.model.arrays import Array
from ikgen.verify.arm import FAR_LIMIT, ArmUnderTest
from ikgen.verify.reach import farthest_configuration
from ikgen.verify.singularities import SINGULAR_SIGMA, singular_configurations

__all__ = ["SampleSet", "generator", "sample_sets"]


_SPECIAL = np.array([0.0, np.pi / 2, -np.pi / 2, np.pi, -np.pi])
_NEAR = (1e-2, 1e-4, 1e-6, 1e-8)  # rad: how far from a singular configuration


@dataclass(frozen=True, slots=True)
class SampleSet:
    """Configurations `q` (N, dof) with their poses (N, 4, 4) by the oracle, and their smallest singular
    values `sigma` (N,)."""

    label: str
    q: Array
    poses: Array
    sigma: Array

    def __len__(self) -> int:
        return len(self.q)


def generator(seed: int, label: str) -> np.random.Generator:
    """The random generator of the set `label`."""
    return np.random.default_rng([seed, zlib.crc32(label.encode())])


def _at_limits(arm: ArmUnderTest, n: int, rng: np.random.Generator) -> Array:
    """One or more joints exactly at a bound of the file."""
    q = arm.uniform(rng, n)
    bounds = np.stack([arm.lower, arm.upper])
    bounded = np.flatnonzero(np.all(np.abs(bounds) <= FAR_LIMIT, axis=0))
    if not len(bounded):
        return q[:0]
    chosen = rng.random((n, len(bounded))) < 0.25
    chosen[np.arange(n), rng.integers(len(bounded), size=n)] = True
    ends = bounds[rng.integers(2, size=(n, len(bounded))), bounded]
    q[:, bounded] = np.where(chosen, ends, q[:, bounded])
    return q


def _special(arm: ArmUnderTest, n: int, rng: np.random.Generator) -> Array:
    """Random subsets of the joints at 0, ±90 or 180 degrees where the limits allow; all at 0
    first."""
    q = arm.uniform(rng, n)
    chosen = rng.random((n, arm.dof)) < rng.uniform(0.2, 1.0, size=(n, 1))
    chosen[0] = True
    for j in range(arm.dof):
        values = _SPECIAL if arm.revolute[j] else _SPECIAL[:1]
        allowed = values[(values >= arm.lower[j]) & (values <= arm.upper[j])]
        if len(allowed):
            pick = allowed[rng.integers(len(allowed), size=n)]
            pick[0] = allowed[0]
            q[:, j] = np.where(chosen[:, j], pick, q[:, j])
    return q


def _near(arm: ArmUnderTest, singular: Array, n: int, rng: np.random.Generator) -> Array:
    if not len(singular):
        return singular
    q = singular[np.arange(n) % len(singular)]
    offset = rng.standard_normal(q.shape) * np.resize(_NEAR, n)[:, None]
    q = np.clip(q + offset, arm.lower, arm.upper)
    return np.asarray(q[arm.sigma(q) > SINGULAR_SIGMA])


def _boundary(arm: ArmUnderTest, n: int, rng: np.random.Generator) -> Array:
    """Close to stretched: just inside the boundary of the reach, where that is inside the
    limits."""
    farthest = farthest_configuration(arm, rng)
    if farthest is None:
        return np.empty((0, arm.dof))
    q = farthest + rng.standard_normal((n, arm.dof)) * np.resize((1e-2, 1e-3), n)[:, None]
    return np.asarray(q[arm.within(q)])


def sample_sets(arm: ArmUnderTest, samples: int, seed: int) -> dict[str, SampleSet]:
    """All sets of configurations, by label. All but "outside limits" lie inside the limits."""
    some, few = max(samples // 8, 16), max(samples // 20, 12)

    def rng(label: str) -> np.random.Generator:
        return generator(seed, label)

    special = _special(arm, 2 * some, rng("special"))
    deficient = special[arm.sigma(special) < SINGULAR_SIGMA][:few]
    singular = np.vstack([singular_configurations(arm, few, rng("singular")), deficient])
    outside = arm.uniform(rng("outside limits"), 2 * some, limits=False)
    outside[:, list(arm.free)] = np.clip(outside, arm.low, arm.high)[:, list(arm.free)]
    drawn = {
        "random": arm.uniform(rng("random"), samples),
        "at limits": _at_limits(arm, some, rng("at limits")),
        "special": special,
        "singular": singular,
        "near singular": _near(arm, singular, 2 * few, rng("near singular")),
        "boundary": _boundary(arm, few, rng("boundary")),
        "outside limits": outside[~arm.within(outside)][:some],
    }
    return {label: _sample_set(arm, label, q) for label, q in drawn.items()}


def _sample_set(arm: ArmUnderTest, label: str, q: Array) -> SampleSet:
    poses = arm.oracle.forward(q).reshape(-1, 4, 4)
    return SampleSet(label, q, poses, arm.sigma(q))
