"""Tolerances of `solve` lie in the order that their uses need."""

from __future__ import annotations

import math
from itertools import pairwise

from ikgen.program.policy import REFINEMENT, SolvePolicy
from ikgen.verify.checks import CLOSURE_TOLERANCE


def test_tolerances_are_ordered() -> None:
    p = SolvePolicy()
    chains = (
        (0.0, p.orthonormal, p.halfway, p.converged, p.exact, p.arrived, p.coincident, p.meeting,
         p.neighbouring, 1.0),
        (0.0, p.singular_below, p.fold_reach, p.continuum_below, p.fold, 1.0),
        (0.0, p.limit_tolerance, p.limit_reach, p.coincident * 100.0),
        (0.0, p.least_damping, p.damping, p.largest_step, p.progress, 1.0),
        (0.0, p.least_miss, p.near, p.farthest_start, p.contraction, 1.0),
    )  # fmt: skip
    for chain in chains:
        assert all(a < b for a, b in pairwise(chain)), chain
    assert 2.0 * p.limit_tolerance + p.arrived < CLOSURE_TOLERANCE  # two joints put on their limits
    assert 0.0 < p.rough_square < p.arrived**2
    assert p.tries * p.try_step == 2.0 * math.pi


def test_stages_take_more_steps_for_what_is_more_promising() -> None:
    steps = [stage.steps for stage in REFINEMENT]
    assert steps == sorted(steps) and all(a < b for a, b in pairwise(steps))
    assert all(a.promising > b.promising and a.fine >= b.fine for a, b in pairwise(REFINEMENT))
