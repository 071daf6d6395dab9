"""Puts all sampled poses to emitted code once; the checks then share the answers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ikgen.model.arrays import Array
from ikgen.verify.arm import ArmUnderTest
from ikgen.verify.reach import unreachable_poses
from ikgen.verify.runners.runner import Runner
from ikgen.verify.sampling import SampleSet, generator, sample_sets
from ikgen.verify.shared_work import SharedWork
from ikgen.verify.trials import Question, Trial, ask_all, run_trial

__all__ = ["Answers", "collect_answers"]


_INSIDE_SETS = ("at limits", "special")
_SINGULAR_SETS = ("singular", "special")
_BESIDE_SETS = ("near singular", "boundary")
_ORDERED = 100  # poses solved again with a random seed
_REPEATED = 20
_SEARCHED = 16  # poses that are searched numerically
_UNREACHABLE = 12  # poses of each kind out of reach


@dataclass(frozen=True, slots=True)
class Answers:
    """`limited`, `unlimited`: the random poses with limits by `solve`, and without by `solve_batch` where
    there is one, unseeded; `inside`: further
    sets with configurations inside the limits, unseeded; `outside`: a (with, without) limits pair
    of configurations outside; `seeded`: singular sets with limits, and what is beside them without, as
    there rows may come that limits mostly hide, seeded with the generating configuration;
    `ordered`: random poses with random `seeds`; `searched`: a slice of `unlimited`; `unreachable`:
    poses without solution; `repeated`: a few of `limited` twice again."""

    limited: Trial
    unlimited: Trial
    inside: tuple[Trial, ...]
    outside: tuple[Trial, Trial]
    seeded: tuple[Trial, ...]
    ordered: Trial
    seeds: Array
    searched: Trial
    unreachable: tuple[Trial, ...]
    repeated: tuple[Trial, Trial]

    @property
    def reachable(self) -> tuple[Trial, ...]:
        """All trials whose poses come from a configuration that is the sample's."""
        return (
            self.limited, self.unlimited, *self.inside, *self.outside, *self.seeded, self.ordered,
        )  # fmt: skip

    @property
    def standing(self) -> tuple[Trial, ...]:
        """The trials at whose poses the arm stands: each generating configuration must be among the
        rows."""
        return (self.limited, self.unlimited, *self.inside, self.outside[1], *self.seeded)


def _first(sample: SampleSet, n: int) -> SampleSet:
    return SampleSet(sample.label, sample.q[:n], sample.poses[:n], sample.sigma[:n])


def _slice(trial: Trial, n: int) -> Trial:
    rows = trial.rows.at(np.arange(n)[: len(trial.sample)])
    return Trial(_first(trial.sample, n), rows, trial.limits, trial.seeded)


def _unreachable(arm: ArmUnderTest, seed: int) -> list[SampleSet]:
    """Poses of each kind, with values for held joints."""
    rng = generator(seed, "unreachable")
    sets = []
    for label, poses in unreachable_poses(arm, _UNREACHABLE, rng).items():
        held = arm.uniform(rng, len(poses))
        sets.append(SampleSet(label, held, poses, arm.sigma(held)))
    return sets


def _in_batch(runner: Runner, arm: ArmUnderTest, limited: Trial) -> Trial:
    """The poses of `limited` without limits, in one call: a miss of either function shows, and each
    takes half of the poses. Batches flag no rows, so poses with flagged ones, or none, are solved one by
    one."""
    sample = limited.sample
    held = arm.held_values(sample.q, sample.poses)
    try:
        rows = runner.solve_batch(sample.poses, limits=False, free=held)
    except Exception:  # the check of `solve_batch` tells
        rows = None
    if rows is None or rows.q.ndim != 3 or rows.q.shape[::2] != limited.rows.q.shape[::2]:
        return run_trial(runner, arm, sample, limits=False)
    alone = np.flatnonzero(limited.rows.singular.any(axis=1) | (limited.rows.count == 0))
    if len(alone):
        one = runner.solve_many(
            sample.poses[alone], free=None if held is None else held[alone], limits=False
        )
        rows = rows.with_answers(alone, one)
    return Trial(sample, rows, False, False)


def collect_answers(
    runner: Runner, arm: ArmUnderTest, samples: int, seed: int, shared: SharedWork | None = None
) -> Answers:
    """Draw all sets and solve them; whatever the emitted code raises passes through."""
    sets = (shared or SharedWork()).once("samples", lambda: sample_sets(arm, samples, seed))
    some, few = (_first(sets["random"], n) for n in (_ORDERED, _REPEATED))
    seeds = arm.uniform(generator(seed, "seeds"), len(some))
    plain = [sets[label] for label in ("random", *_INSIDE_SETS, "outside limits")]
    asked = {
        "singular": Question([sets[label] for label in _SINGULAR_SETS], True, seeded=True),
        "beside": Question([sets[label] for label in _BESIDE_SETS], False, seeded=True),
        "plain": Question(plain, True),
        "outside": Question(plain[-1:], False),
        "ordered": Question([some], True, seeded=True, seeds=seeds),
        "unreachable": Question(_unreachable(arm, seed), True),
        "once": Question([few], True),
        "again": Question([few], True),
    }
    found = dict(zip(asked, ask_all(runner, arm, list(asked.values())), strict=True))
    limited, *inside, outside = found["plain"]
    unlimited = _in_batch(runner, arm, limited)
    return Answers(
        limited=limited,
        unlimited=unlimited,
        inside=tuple(inside),
        outside=(outside, found["outside"][0]),
        seeded=(*found["singular"], *found["beside"]),
        ordered=found["ordered"][0],
        seeds=seeds,
        searched=_slice(unlimited, _SEARCHED),
        unreachable=found["unreachable"],
        repeated=(found["once"][0], found["again"][0]),
    )
