"""Which eliminations suit a chain of six revolute joints of which one turns several axes.

The loop of the other five may be begun at any of them and run backwards. What is coupled must not lie in
the loop's first or last link. The degree of the determinant in the coupled joint's angle follows from
ratios and geometry, and is measured: what rounding leaves of higher harmonics is far below the others.
Where several solutions share each value of the coupled angle, which is measured too, so many sums of the
equations are taken that one solution takes their rank. Where all vanishes at every angle, as right angles
make it, half angles of both angles beside the coupled one are taken.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from itertools import product
from typing import NamedTuple

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
from ikgen.runtime.python.elimination.coupled_loop import (
    CoupledLoop,
    coupled_and_others,
    neighbours,
)
from ikgen.runtime.python.elimination.coupled_shared import (
    CoupledSharedAngle,
    shared_determinants,
)
from ikgen.runtime.python.elimination.hidden_angle import lift

__all__ = ["MOST_DEGREE", "choose_coupled", "least_degree"]

MOST_DEGREE = 60
"""In the coupled joint's angle; beyond it rounding leaves too little of the roots."""

_ALL_TURN = (True,) * 6
_ROUND: Array = 2.0 * np.pi / 256 * np.arange(256, dtype=float)
"""Angles (rad) by which degrees are measured."""
_POSES = 8
_PROBES = 24
_EQUATIONS = 12
_ROUNDING = 1e-12
"""Harmonics below it, of the largest, are none."""
_NO_RANK = 1e-10
"""Singular values below it, of the largest, are none."""


class _Way(NamedTuple):
    """What an elimination takes the roots of: half angles of `both` angles or of one; how many sums of the
    equations, all where that is 12; of which `degree` their determinant is, and where it has roots at every
    pose (`crowded`). `bound`: of how many solutions there can be."""

    both: bool
    size: int
    degree: int
    crowded: tuple[tuple[float, int], ...]
    bound: int

    @property
    def share(self) -> int:
        """How many solutions share a root at most."""
        return 1 if self.both else _EQUATIONS + 1 - self.size

    def finder(self, motions: tuple[Motion, ...]) -> CoupledAngle:
        """What finds candidates."""
        if self.share > 1:
            return CoupledSharedAngle(motions, self.crowded, self.share)
        return (CoupledBothAngle if self.both else CoupledAngle)(motions, self.crowded)


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
    ways = [*_eliminations(chains[0], poses, probes[0])]
    bound = min((way.bound for way, _ in ways), default=0)
    for way, group in ways:
        if way.degree > MOST_DEGREE:
            continue
        find = way.finder(motions)
        plans = [Plan(length, (e,), _ALL_TURN, find, motions=motions) for e in group]
        parts = [_probe(*known, plans) for known in zip(family, chains, probes, strict=True)]
        every = joined(parts)
        order = ranking(every.hits, every.rough, every.enough)
        recall = float(every.hits[order[0]].mean()) if every.hits.size else 0.0
        if best is None or recall > best.recall:
            best = EliminationPlan(
                first,
                length,
                tuple(group[k] for k in order),
                recall,
                motions=motions,
                crowded=way.crowded,
                both=way.both,
                share=way.share,
                bound=bound if way.share > 1 else 0,
            )
        if best.usable:
            break
    return best


def least_degree(frames: Array, motions: tuple[Motion, ...]) -> int | None:
    """The least degree in the coupled joint's angle that an elimination of the chain has, frames
    (n + 1, 4, 4); None where there is none."""
    rng = np.random.default_rng(0)
    chain = chain_of(over(frames, typical_length(frames)), motions, 6)
    known = _configurations(chain, _PROBES, rng)
    poses = forward(chain, rng.uniform(-np.pi, np.pi, (_POSES, 6)))
    ways = [way for way, _ in _eliminations(chain, poses, known)] if len(known) else []
    return min((way.degree for way in ways), default=None)


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


def _eliminations(
    chain: Chain, poses: Array, known: Array
) -> Iterator[tuple[_Way, list[Elimination]]]:
    """The eliminations that apply, in groups of one way: those of which a root stands for most solutions
    first, of these the least degree first; then those by half angles of both angles. `known` (n, 6) are
    regular configurations."""
    joints = [motion[0] for motion in chain.motions]
    coupled, singles = coupled_and_others(chain.motions)
    for both in (False, True):
        found: dict[_Way, list[Elimination]] = {}
        for reverse, start in product((0, 1), range(5)):
            at = joints.index(singles[start])
            if coupled in (joints[at - 1], joints[(at + 1) % len(joints)]):
                continue
            way = _way(chain, poses, known, (start, reverse, 0), both=both)
            if way is not None:
                found.setdefault(way, []).append((start, reverse, way.degree))
        for way in sorted(found):
            yield way, found[way]


def _way(
    chain: Chain, poses: Array, known: Array, elimination: Elimination, *, both: bool
) -> _Way | None:
    """What an elimination takes the roots of; None where that vanishes at every angle."""
    one = chain.motions, [*chain.frames[:, None]]
    size, full = (_EQUATIONS, True) if both else _size(chain, known, elimination)
    shared = partial(shared_determinants, size, *one, poses, elimination)
    every = partial(coupled_determinants, *one, poses, elimination)
    tall = partial(tall_determinants, *one, poses, elimination)
    determinants = tall if both else every if size == _EQUATIONS else shared
    degree = _degree(determinants(_ROUND)) if size else 0
    if not degree:
        return None
    crowded = crowded_angles(partial(neighbours, *one, elimination), determinants)
    roots = degree * (_EQUATIONS + 1 - size)
    if size < _EQUATIONS and full:
        roots = min(roots, _degree(every(_ROUND)))
    return _Way(both, size, degree, crowded, 2 * roots)


def _size(chain: Chain, known: Array, elimination: Elimination) -> tuple[int, bool]:
    """How many of the twelve equations tell a solution: as many as keep rank at regular configurations
    (n, 6), and one; 0 where they have no more at other angles of the coupled joint. Whether all have full
    rank there."""
    loop = CoupledLoop(chain.motions, [*chain.frames[:, None]], elimination)
    q = known[:_POSES]
    at = loop.equations(forward(chain, q), q[:, loop.coupled, None] + np.array([0.0, 1.0]))
    sigma = np.linalg.svd(lift(at.A), compute_uv=False)
    rank, elsewhere = (sigma > _NO_RANK * sigma[..., :1]).sum(axis=2).max(axis=0)
    return int(rank) + 1 if rank < elsewhere else 0, bool(elsewhere == _EQUATIONS)


def _degree(values: NDArray[np.float64]) -> int:
    """The degree of trigonometric polynomials with values (N, n) at equidistant nodes."""
    spectrum = np.abs(np.fft.fft(values, axis=1))
    relative = (spectrum / np.maximum(spectrum.max(axis=1, keepdims=True), 1e-300)).max(axis=0)
    large = np.flatnonzero(relative[: len(_ROUND) // 2] > _ROUNDING)
    return int(large[-1]) if len(large) else 0


def _configurations(chain: Chain, count: int, rng: np.random.Generator) -> Array:
    """`half_hard` of many."""
    drawn = rng.uniform(-np.pi, np.pi, (12 * count, 6))
    size = np.asarray(np.linalg.svd(jacobian(chain, drawn), compute_uv=False)[:, -1], dtype=float)
    return half_hard(drawn, size, count)
