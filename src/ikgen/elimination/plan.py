"""Which elimination suits an arm: probing all of them at random and at nearly singular
configurations.

The closed loop `R_1 C_1 ... R_6 C_6 = 1` may be begun at any joint and run backwards, and either of
the two angles next to the hidden one be raised to the second degree in Raghavan and Roth's
elimination (1990): 24 eliminations. Parallel or intersecting axes make some of them rank-deficient,
others leave solutions that share the hidden angle; which ones is a property of the arm, hence found
at generation time. A slide has to be the first of the loop's joints or the second: eight eliminations. With
two slides one of the four angles is hidden; with three the rotation gives all angles.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import product

import numpy as np

from ikgen.elimination.elimination_table import (
    EliminationRoutine,
    elimination_routine,
    finder,
)
from ikgen.elimination.loop_frames import forward, jacobian, over, typical_length
from ikgen.elimination.parallel_plans import ParallelPlan, choose_parallel
from ikgen.elimination.probing import Probe, distinct_of_runs, joined, probe_of
from ikgen.elimination.resultant import RESULTANTS, Resultant, root_shifts, roots_shared
from ikgen.elimination.routine import Elimination, Plan, Turning, first_runs
from ikgen.kinematics.rigid import read_only
from ikgen.model.arrays import Array
from ikgen.runtime.python.arm.chain_kinematics import Motion
from ikgen.runtime.python.elimination.coupled_loop import coupled_and_others

__all__ = [
    "EliminationPlan",
    "choose_plan",
    "eliminations",
    "half_hard",
    "ranking",
]

_ALL: tuple[Elimination, ...] = tuple(
    (start, reverse, swap) for swap, reverse, start in product((0, 1), (0, 1), range(6))
)
_REVOLUTE: Turning = (True,) * 6
_REGULAR = 1e-3
_BLURRED = 1.5e-2  # rad; roots that move further are not worth a resultant
_ALIKE = 0.4  # digits lost on average, which rounding moves by less than a tenth
_AS_OFTEN = 0.2  # of poses: more than rounding decides
_NEARLY_ALL = 0.98  # of the solutions: runs that agree make up for the rest
_HIGH = 40  # degree from which on they do not
_KEPT = 2
_SPECIAL_PROBES = 3


@dataclass(frozen=True, slots=True)
class EliminationPlan:
    """What is embedded for one arm.

    frames: (7, 4, 4) read-only, `T = F_0 M(v_1) F_1 ... M(v_6) F_6`. length: the arm's scale (m).
    eliminations: in order of preference. recall: fraction of all solutions met in probing that the first
    of them finds alone. resultants: (start, reverse) of hidden angles whose polynomial has separate roots,
    in order of preference; may be none. turning: which of the six joints turn, the others slide. parallel:
    the elimination about two parallel axes, which is tried first; None where they are not, or where it
    settles few poses. motions: those of the axes in their order along the chain where a joint turns
    several; frames is then (n + 1, 4, 4); near `crowded` angles (rad) of that joint determinants are
    looked at closely. tool: the tool's axis (0: x) that the last joint turns about, where the task leaves
    that turn open; it is none of the arm's joints. steady: whether a resultant has separate roots at the
    held joints' special values too, among which their defaults often are; without one the eigenproblem
    serves there, at twenty times the cost. both: whether both angles beside the hidden one are taken by
    half angles, as either alone leaves no rank. share: how many solutions may share a value of the joint
    that turns several axes; bound: how many there are at most, where they do.
    """

    frames: Array
    length: float
    eliminations: tuple[Elimination, ...]
    recall: float
    resultants: tuple[Resultant, ...] = ()
    turning: Turning = _REVOLUTE
    parallel: ParallelPlan | None = None
    motions: tuple[Motion, ...] = ()
    crowded: tuple[tuple[float, int], ...] = ()
    tool: int | None = None
    steady: bool = True
    both: bool = False
    share: int = 1
    bound: int = 0

    @property
    def routine(self) -> EliminationRoutine:
        """Which elimination it is."""
        return elimination_routine(
            self.turning.count(False),
            both=self.both,
            coupled=bool(self.motions),
            shared=self.share > 1,
        )

    @property
    def coupled(self) -> int:
        """The joint that turns several axes, among those that move."""
        return coupled_and_others(self.motions)[0]

    @property
    def degree(self) -> int:
        """In the angle of a joint that turns several axes; 0 where none does."""
        _, _, degree = self.eliminations[0]
        return degree if self.motions else 0

    @property
    def most(self) -> int:
        """Solutions at most, a power of two."""
        return self.routine.most or 1 << ((self.bound or 2 * self.degree) - 1).bit_length()

    @property
    def usable(self) -> bool:
        """Whether the arm has a finite number of solutions and the plan finds nearly all of
        them; where its polynomial is of a high degree all."""
        return self.recall == 1.0 or (self.recall > _NEARLY_ALL and self.degree <= _HIGH)


def eliminations(turning: Turning, *, both: bool = False) -> tuple[Elimination, ...]:
    """All that there are for six joints of which some slide; those by half angles of `both` angles, which
    swapping leaves as they are."""
    if both:
        return tuple(e for e in eliminations(turning) if not e[2])
    slides = turning.count(False)
    if slides == 0:
        return _ALL
    if slides == 1:
        return tuple(e for e in _ALL if not (turning[e[0]] and turning[(e[0] + 1 - 2 * e[1]) % 6]))
    return tuple((start, 0, 0) for start in range(6) if turning[start])


def choose_plan(
    frames: Array,
    turning: Turning = _REVOLUTE,
    special: Sequence[Array] = (),
    *,
    probes: int = 24,
) -> EliminationPlan:
    """The best eliminations for a chain of six joints, at most three of them slides, frames
    (7, 4, 4), or for all of a family (m, 7, 4, 4) that differs by a held joint's value (the plan
    then carries the first one's frames).

    special: members at whose values some eliminations lose rank; the plan serves them as well as it can.
    Raises ValueError for other shapes.
    """
    family = np.asarray(frames, dtype=np.float64)
    family = family[None] if family.ndim == 3 else family
    if family.ndim != 4 or family.shape[1:] != (7, 4, 4):
        raise ValueError(f"frames of six joints are (7, 4, 4), not {np.shape(frames)}")
    plan = _chosen(family, turning, special, probes)
    if not plan.usable and turning.count(False) == 1:
        plan = max(
            plan, _chosen(family, turning, special, probes, both=True), key=lambda p: p.recall
        )
    return plan


def _chosen(
    family: Array,
    turning: Turning,
    special: Sequence[Array],
    probes: int,
    *,
    both: bool = False,
) -> EliminationPlan:
    """The best eliminations of one sort for a family (m, 7, 4, 4)."""
    rng, ways = np.random.default_rng(0), eliminations(turning, both=both)
    each = max(probes // len(family), 2)

    def probed(member: Array, count: int) -> Probe:
        length, find = typical_length(member, turning), finder(turning, both=both)
        return _probe(member, [Plan(length, (e,), turning, find) for e in ways], count, rng)

    plain = joined([probed(member, each) for member in family])
    every = joined([plain, *(probed(member, _SPECIAL_PROBES) for member in special)])
    opposite = 2 if turning.count(False) == 2 else 0
    order = ranking(every.hits, every.rough, plain.enough, opposite=opposite)
    everywhere, elsewhere = _separate(every.shifts), _separate(plain.shifts)
    separate = dict.fromkeys([*everywhere, *elsewhere])
    first = read_only(family[0])
    return EliminationPlan(
        frames=first,
        length=typical_length(first, turning),
        eliminations=tuple(ways[k] for k in order),
        recall=float(plain.hits[order[0]].mean()) if plain.hits.size else 0.0,
        resultants=tuple(RESULTANTS[k] for k in [*separate][:_KEPT]),
        turning=turning,
        parallel=choose_parallel(family) if all(turning) else None,
        steady=bool(everywhere) or not elsewhere,
        both=both,
    )


def ranking(hits: Array, rough: Array, enough: Array, opposite: int = 0) -> list[int]:
    """The eliminations to keep: most solutions together with those before, then those that are `enough` by
    themselves most often, then the first of the best conditioned. One that loses a digit counts as if it
    had lost one solution in a hundred. Of two that are `opposite` places apart (0: none are) one is kept,
    as the other is no better where it fails."""
    order: list[int] = []
    covered = np.zeros(hits.shape[1], dtype=bool)
    for _ in range(min(_KEPT, len(hits))):
        rest = [k for k in range(len(hits)) if not {k, k - opposite, k + opposite} & {*order}]
        found = {k: int((covered | hits[k]).sum()) for k in rest}
        best = max(rest, key=lambda k: found[k] - 0.01 * rough[k] * hits.shape[1])
        as_many = [k for k in rest if found[k] >= found[best]]
        most = max(enough[k] for k in as_many) - _AS_OFTEN
        quick = [k for k in as_many if enough[k] >= most]
        least = min(rough[k] for k in quick)
        order.append(next(k for k in quick if rough[k] < least + _ALIKE))
        covered |= hits[order[-1]]
    return order


def _separate(shifts: Array) -> list[int]:
    """The resultants to keep: the first of those whose roots rounding moves least, but for a digit."""
    order: list[int] = []
    for _ in range(_KEPT):
        rest = [k for k in range(len(shifts)) if k not in order and shifts[k] < _BLURRED]
        if rest:
            order.append(next(k for k in rest if shifts[k] < 10.0 * shifts[rest].min()))
    return order


def _probe(frames: Array, every: Sequence[Plan], count: int, rng: np.random.Generator) -> Probe:
    length, turning = every[0].length, every[0].turning
    q = _configurations(frames, turning, count, rng)
    if not len(q):  # singular everywhere: two axes on one line, or four that keep parallel
        hits = np.zeros((len(every), 0), dtype=bool)
        none = np.zeros(len(every))
        return Probe(hits, none, none, np.ones(len(RESULTANTS)))
    poses = forward(frames, q, turning)
    runs = first_runs(frames, every, poses)
    rows = [[run.rows[i] for run in runs] for i in range(len(poses))]
    unions = [distinct_of_runs(each, turning) for each in rows]
    shifts = np.ones((len(RESULTANTS), 1))
    if all(turning):
        shifts = root_shifts(over(frames, length), over(poses, length), q)
        shifts[roots_shared([np.concatenate(each) for each in rows])] = 1.0
    hits = np.concatenate(unions, axis=1)
    return probe_of(runs, hits, np.quantile(shifts, 0.75, axis=1))


def _configurations(frames: Array, turning: Turning, count: int, rng: np.random.Generator) -> Array:
    """`half_hard` of many; slides are drawn within the typical length."""
    reach = np.where(turning, np.pi, typical_length(frames, turning))
    drawn = rng.uniform(-reach, reach, (12 * count, 6))
    size = np.linalg.svd(jacobian(frames, drawn, turning), compute_uv=False)[:, -1]
    return half_hard(drawn, np.asarray(size), count)


def half_hard(drawn: Array, size: Array, count: int) -> Array:
    """Regular ones, `count` of configurations (n, 6) with these smallest singular values (n,): half of them
    the first, half the nearest to singular ones."""
    regular = np.flatnonzero(size > _REGULAR)
    hard = regular[np.argsort(size[regular])][: count // 2]
    plain = np.setdiff1d(regular, hard)[: count - len(hard)]
    return np.asarray(drawn[np.concatenate([plain, hard])])
