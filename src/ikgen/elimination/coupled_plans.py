"""Which eliminations suit a chain of six revolute joints of which one turns several axes.

The loop of the other five may be begun at any of them and run backwards. What is coupled must not lie in
the loop's first or last link. The degree of the determinant in the coupled joint's angle follows from
ratios and geometry, and is measured: what rounding leaves of higher harmonics is far below the others.
Where it vanishes at every angle, as right angles make it, half angles of both angles beside the coupled
one are taken.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from itertools import product

import numpy as np
from numpy.typing import NDArray

from ikgen.elimination.crowded_angles import crowded_angles
from ikgen.elimination.loop_frames import over, typical_length
from ikgen.elimination.plan import EliminationPlan, half_hard, ranking
from ikgen.elimination.probing import Probe, distinct_of_runs, joined, probe_of
from ikgen.elimination.routine import Elimination, Plan, first_runs
from ikgen.kinematics.rigid import read_only
from ikgen.model.arrays import Array
from ikgen.runtime.python.arm.chain_kinematics import Chain, Motion, chain_of, forward, jacobian
from ikgen.runtime.python.elimination.coupled_angle import CoupledAngle, coupled_determinants
from ikgen.runtime.python.elimination.coupled_both import CoupledBothAngle, tall_determinants
from ikgen.runtime.python.elimination.coupled_loop import coupled_and_others, neighbours

__all__ = ["choose_coupled"]

_ALL_TURN = (True,) * 6
_MOST_DEGREE = 40
_NODES = 128
_POSES = 8
_PROBES = 24
_ROUNDING = 1e-12
"""Harmonics below it, of the largest, are none."""


def choose_coupled(frames: Array, motions: tuple[Motion, ...]) -> EliminationPlan | None:
    """The best eliminations for a chain of six revolute joints, frames (n + 1, 4, 4) with n > 6 motions, or
    for all of a family (m, n + 1, 4, 4): those of the least degree that find all solutions, else those that
    find most; by half angles of both angles beside the coupled one where one alone does not do. None where
    no elimination applies."""
    family = frames[None] if frames.ndim == 3 else frames
    rng, length = np.random.default_rng(0), typical_length(family[0])
    chains = [chain_of(member, motions, 6) for member in over(family, length)]
    probes = [_configurations(chain, max(_PROBES // len(family), 4), rng) for chain in chains]
    if not sum(map(len, probes)):
        return None  # singular everywhere
    poses, first = forward(chains[0], rng.uniform(-np.pi, np.pi, (_POSES, 6))), read_only(family[0])
    best: EliminationPlan | None = None
    for both, crowded, group in _eliminations(chains[0], poses):
        find = (CoupledBothAngle if both else CoupledAngle)(motions, crowded)
        plans = [Plan(length, (e,), _ALL_TURN, find, motions=motions) for e in group]
        parts = [_probe(*known, plans) for known in zip(family, chains, probes, strict=True)]
        every = joined(parts)
        order = ranking(every.hits, every.rough, every.enough)
        recall = float(every.hits[order[0]].mean()) if every.hits.size else 0.0
        if best is None or recall > best.recall:
            chosen = tuple(group[k] for k in order)
            best = EliminationPlan(
                first, length, chosen, recall, motions=motions, crowded=crowded, both=both
            )
        if best.usable:
            break
    return best


def _probe(frames: Array, chain: Chain, q: Array, plans: list[Plan]) -> Probe:
    """What plans find at the poses of configurations q (n, 6); the chain is the frames' in lengths over the
    plans'. There are no resultants."""
    poses = forward(chain, q)
    poses[:, :3, 3] *= plans[0].length
    runs = first_runs(frames, plans, poses)
    every = [[*(run.rows[i] for run in runs), row[None]] for i, row in enumerate(q)]
    hits = [distinct_of_runs(rows, _ALL_TURN)[:-1] for rows in every]
    none = np.zeros((len(plans), 0), dtype=bool)
    return probe_of(runs, np.concatenate([none, *hits], axis=1), np.zeros(0))


_Crowded = tuple[tuple[float, int], ...]
_Group = tuple[bool, _Crowded, list[Elimination]]


def _eliminations(chain: Chain, poses: Array) -> Iterator[_Group]:
    """The eliminations that apply, each with its degree, in groups of one degree and the same crowded
    angles, the least degree first; then those by half angles of both angles."""
    nodes: Array = 2.0 * np.pi / _NODES * np.arange(_NODES, dtype=float)
    joints = [motion[0] for motion in chain.motions]
    coupled, singles = coupled_and_others(chain.motions)
    one = chain.motions, [*chain.frames[:, None]]
    for both, vanishing in ((False, coupled_determinants), (True, tall_determinants)):
        found: dict[tuple[int, _Crowded], list[Elimination]] = {}
        for reverse, start in product((0, 1), range(5)):
            at = joints.index(singles[start])
            if coupled in (joints[at - 1], joints[(at + 1) % len(joints)]):
                continue
            determinants = partial(vanishing, *one, poses, (start, reverse, 0))
            degree = _degree(determinants(nodes))
            if 0 < degree <= _MOST_DEGREE:
                crowded = crowded_angles(
                    partial(neighbours, *one, (start, reverse, 0)), determinants
                )
                found.setdefault((degree, crowded), []).append((start, reverse, degree))
        for degree, crowded in sorted(found):
            yield both, crowded, found[degree, crowded]


def _degree(values: NDArray[np.float64]) -> int:
    """The degree of trigonometric polynomials with values (N, n) at equidistant nodes."""
    spectrum = np.abs(np.fft.fft(values, axis=1))
    relative = (spectrum / np.maximum(spectrum.max(axis=1, keepdims=True), 1e-300)).max(axis=0)
    large = np.flatnonzero(relative[: _NODES // 2] > _ROUNDING)
    return int(large[-1]) if len(large) else 0


def _configurations(chain: Chain, count: int, rng: np.random.Generator) -> Array:
    """`half_hard` of many."""
    drawn = rng.uniform(-np.pi, np.pi, (12 * count, 6))
    size = np.asarray(np.linalg.svd(jacobian(chain, drawn), compute_uv=False)[:, -1], dtype=float)
    return half_hard(drawn, size, count)
