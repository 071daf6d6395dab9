"""Which loops of a chain have two parallel axes beside links of a kind that shrinks the elimination.

The parallel axes are the second and the third of the loop; both angles that are left beside them and their
neighbours' may be hidden, by running the loop backwards.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import IntEnum

import numpy as np

from ikgen.elimination.loop_frames import forward, over, typical_length
from ikgen.elimination.routine import Elimination, Plan, Turning, six_joints_batch
from ikgen.model.arrays import Array
from ikgen.runtime.python.elimination.general_6r import Candidates
from ikgen.runtime.python.elimination.loop_equations import loop_constants
from ikgen.runtime.python.elimination.parallel_axes import parallel_candidates
from ikgen.runtime.python.elimination.parallel_links import (
    MEETING,
    PLAIN,
    UPRIGHT,
    deviation,
    links_of,
    parallel_links,
)

__all__ = [
    "ParallelKind",
    "ParallelPlan",
    "choose_parallel",
    "parallel_plans",
    "settled_share",
    "with_parallel",
]

_MOST_DEVIATION = 2e-5
"""How far a kind's links may be from the chain's (rad, lengths over the arm's): three right angles of four
digits behind the point are within it. Candidates are as far off the pose, and take Newton steps."""

_EXACT = 1e-8

_APART = 1e-3
"""Least sine between the axes beside and the parallel ones, and least distance of these over the arm's."""

_LOOPS = ((0, 0), (1, 0), (2, 0), (3, 1), (4, 1), (5, 1))
"""Those whose links beside the second and third axis do not contain the pose: joints 2 and 3 are parallel,
3 and 4, or 4 and 5, forwards and backwards."""

_PROBES = 200
_NEARLY = 0.1  # shares that differ by less are the same: rounding is another on every processor
_WORTH = 0.3  # of the poses: with fewer solved at once the attempt costs more than it saves


class ParallelKind(IntEnum):
    """The kinds of links beside the parallel axes, by the numbers that the runtime knows them by."""

    PLAIN = PLAIN
    UPRIGHT = UPRIGHT
    MEETING = MEETING


@dataclass(frozen=True, slots=True)
class ParallelPlan:
    """loop: (start, reverse), of which the second and third axes are parallel. kind: of the links beside
    these. deviation: how far the chain's links are from those of the kind (rad, lengths over the arm's)."""

    loop: tuple[int, int]
    kind: ParallelKind
    deviation: float

    @property
    def elimination(self) -> Elimination:
        """What `parallel_candidates` goes by."""
        return *self.loop, self.kind.value

    @property
    def error(self) -> float:
        """How far off the pose (rad, over the arm's length) exact roots' candidates may be."""
        return 1e-7 + 5.0 * self.deviation

    @property
    def bounded(self) -> bool:
        """Whether bounds of what the deviation does to the polynomial leave few poses in doubt."""
        return self.kind is ParallelKind.PLAIN or self.deviation < _EXACT


def choose_parallel(family: Array) -> ParallelPlan | None:
    """The first of those that settle most poses of a family of chains (m, 7, 4, 4), six revolute joints;
    None where no two axes are parallel beside links of a kind."""
    length, rng = typical_length(family[0]), np.random.default_rng(0)
    every = parallel_plans(family)
    if not every:
        return None
    shares = np.zeros(len(every))
    for frames in family:
        q = rng.uniform(-np.pi, np.pi, (_PROBES, 6))
        poses = forward(frames, q)
        shares += [settled_share(frames, length, one, poses) for one in every]
    best = float(shares.max())
    first = next(k for k, share in enumerate(shares) if share > best - _NEARLY * len(family))
    return every[first] if best > _WORTH * len(family) else None


def parallel_plans(family: Array) -> tuple[ParallelPlan, ...]:
    """All that suit every chain of the family (m, 7, 4, 4), of each loop the one of the least degree."""
    parts = [_deviations(member) for member in family]
    every = {e: max(part[e] for part in parts) for e in parts[0] if all(e in p for p in parts)}
    found = [min((e for e in every if e[:2] == loop), default=None) for loop in _LOOPS]
    return tuple(ParallelPlan(e[:2], ParallelKind(e[2]), every[e]) for e in found if e is not None)


def _deviations(frames: Array) -> dict[Elimination, float]:
    """How far each loop's links in a chain (7, 4, 4) are off each kind that they nearly are."""
    length = typical_length(frames)
    scaled = over(frames, length)
    out: dict[Elimination, float] = {}
    for start, reverse in _LOOPS:
        _, C = loop_constants([*scaled[:, None]], np.eye(4)[None], start, reverse)
        links = links_of(parallel_links(C))
        if min(1.0 - links.c1**2, 1.0 - links.c3**2, links.a2**2) < _APART**2:
            continue
        for kind in ParallelKind:
            off = float(deviation(kind, links)[0, 0])
            if off <= _MOST_DEVIATION:
                out[start, reverse, kind] = off
    return out


def with_parallel(plan: Plan, parallel: ParallelPlan | None) -> Plan:
    """The plan of six revolute joints with the parallel elimination before its own."""
    if parallel is None:
        return plan
    return replace(plan, direct=((parallel_candidates, parallel.elimination, parallel.error),))


def settled_share(frames: Array, length: float, parallel: ParallelPlan, poses: Array) -> float:
    """The share of poses (N, 4, 4) that the parallel elimination solves alone; frames (7, 4, 4)."""
    left = [0]

    def rest(_: Sequence[Array], T: Array, one: Elimination, turning: Turning) -> Candidates:
        left.append(len(T))
        nothing = np.zeros(len(T), dtype=np.intp)
        return nothing[:0], np.zeros((0, 6)), nothing, nothing > 0

    plan = Plan(length, ((0, 0, 0),), (True,) * 6, rest)
    six_joints_batch(frames, with_parallel(plan, parallel), poses)
    return 1.0 - max(left) / max(len(poses), 1)
