"""Poses through the emitted Python module of one arm, as `benchmarks.soak` puts them through a header.

Every pose is judged by `ikgen.verify.completeness`, with Pinocchio's kinematics. All go through
`solve_batch`, those whose configuration it misses, and a share of the others, through `solve` as well: what
one of the two misses is missed.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from benchmarks.collection import urdf_of
from benchmarks.command_line import Emitted
from benchmarks.soak_counts import DECADES, Soak
from ikgen.derivation.read import read
from ikgen.generation.emitted_checks import oracle_for
from ikgen.records.request import Request
from ikgen.tasks import find_task
from ikgen.verify.arm import ArmUnderTest, arm_under_test
from ikgen.verify.checks import CLOSURE_TOLERANCE
from ikgen.verify.completeness import survey
from ikgen.verify.runners.python_module import PythonModule
from ikgen.verify.runners.runner import Rows
from ikgen.verify.sampling import SampleSet
from ikgen.verify.singularities import singular_configurations
from ikgen.verify.task_space import task_space
from ikgen.verify.trials import Trial

__all__ = ["soak_module"]

Array = NDArray[np.float64]

CHUNK = 4096
EACH = 10
"""Poses beside each singular configuration, and the share that `solve` gets too: one in so many."""
SHOWN = 5


def soak_module(made: Emitted, poses: int, near: int, *, seed: int = 1) -> Soak:
    """Random poses, and poses beside singularities: half of them around configurations found by descending
    on the smallest singular value, half with some joints beside multiples of 90 degrees. Every other one of
    them is solved without limits."""
    assert made.module is not None
    runner = PythonModule(made.module)
    arm = _arm_of(made, runner)
    rng = np.random.default_rng(seed)
    counts = np.zeros((DECADES, 2, 3), dtype=int)
    rows = wrong = 0
    cases: list[str] = []
    beside = _beside(arm, near, rng)
    asked = (0, True, arm.uniform(rng, poses)), (1, True, beside[::2]), (1, False, beside[1::2])
    for kind, limits, q in asked:
        for start in range(0, len(q), CHUNK):
            part = _put(arm, runner, q[start : start + CHUNK], limits)
            rows, wrong = rows + part.rows, wrong + part.wrong
            counts[:, kind] += np.array(part.decades)[:, :3]
            cases += part.cases
    return Soak(rows, wrong, tuple(tuple(d.ravel().tolist()) for d in counts), tuple(cases[:SHOWN]))


def _arm_of(made: Emitted, runner: PythonModule) -> ArmUnderTest:
    """The arm that the file says, held and locked joints as in the module."""
    constants, source = runner.constants, made.source
    assert made.module is not None
    file = source.file or made.module.parent / f"{source.row['name']}.urdf"
    if not file.exists():
        file.write_text(urdf_of(source.row), encoding="utf-8")
    ends = (
        {} if file.suffix == ".toml" else {"base": constants.base_link, "tip": constants.tip_link}
    )
    locked = dict(made.answer.get("locked") or {})
    oracle = oracle_for(read(Request(Path(file), name="arm", lock=locked, **ends)))
    limits = constants.lower, constants.upper
    space = task_space(find_task(constants.task))
    return arm_under_test(oracle, space, limits, constants.free_joints)


def _beside(arm: ArmUnderTest, count: int, rng: np.random.Generator) -> Array:
    """Configurations (n, dof) inside the limits, 10^-1 to 10^-12 (rad, m) off singular ones."""
    half = count // 2
    singular = singular_configurations(arm, half // EACH + 1, rng)
    around = singular[np.arange(half) % len(singular)] if len(singular) else arm.uniform(rng, 0)
    around = around + rng.normal(size=around.shape) * _distances(rng, len(around))
    right = arm.uniform(rng, count - half)
    turned = np.round(right / (np.pi / 2)) * (np.pi / 2) * arm.revolute
    some = rng.random(right.shape) < 1.5 / arm.dof
    some[np.arange(len(right)), rng.integers(arm.dof, size=len(right))] = True
    turned = turned + rng.normal(size=right.shape) * _distances(rng, len(right))
    return np.clip(np.concatenate([around, np.where(some, turned, right)]), arm.low, arm.high)


def _distances(rng: np.random.Generator, count: int) -> Array:
    return np.asarray(10.0 ** -rng.uniform(1.0, 12.0, size=(count, 1)))


def _put(arm: ArmUnderTest, runner: PythonModule, q: Array, limits: bool) -> Soak:
    """Some poses, solved with limits or without: what came of them."""
    T = arm.oracle.forward(q).reshape(-1, 4, 4)
    sample = SampleSet("soak", q, T, arm.sigma(q))
    batch = runner.solve_batch(T, limits=limits, free=arm.held_values(q, T))
    assert batch is not None
    missed = survey(arm, runner, [Trial(sample, batch, limits=limits, seeded=False)]).missed
    again = np.flatnonzero(missed | (np.arange(len(q)) % EACH == 0))
    some = SampleSet("soak", q[again], T[again], sample.sigma[again])
    alone = runner.solve_many(some.poses, free=arm.held_values(some.q, some.poses), limits=limits)
    flagged = np.zeros_like(batch.singular)
    flagged[again] = alone.singular.any(axis=1)[:, None]
    part = Rows(batch.q[again], batch.count[again], ("OK",) * len(again), flagged[again])
    twice = survey(
        arm, runner, [Trial(some, rows, limits=limits, seeded=False) for rows in (part, alone)]
    )
    n = len(again)
    lost, empty = np.zeros((2, len(q)), dtype=bool)
    empty[:] = batch.count == 0
    lost[again], empty[again] = (
        twice.missed[:n] | twice.missed[n:],
        twice.unanswered[:n] | twice.unanswered[n:],
    )
    wrong = [_wrong(arm, rows, at) for rows, at in ((batch, T), (alone, some.poses))]
    decade = _decades(sample.sigma)
    decades = np.zeros((DECADES, 3), dtype=int)
    for k, flags in enumerate((np.ones(len(q), dtype=bool), lost, empty)):
        np.add.at(decades[:, k], decade[flags], 1)
    cases = [*_cases("missed", sample, lost), *_cases("unanswered", sample, empty)]
    return Soak(
        int(batch.count.sum() + alone.count.sum()),
        sum(wrong),
        tuple(map(tuple, decades.tolist())),
        tuple(cases),
    )


def _wrong(arm: ArmUnderTest, rows: Rows, poses: Array) -> int:
    """How many rows do not lead to their pose."""
    index, q, _ = rows.flat()
    if not len(q):
        return 0
    position, rotation = arm.task.errors(arm.oracle.forward(q), poses[index])
    error = np.maximum(position / arm.size_of(q), rotation)
    return int((~(error <= CLOSURE_TOLERANCE)).sum())


def _decades(sigma: Array) -> NDArray[np.int64]:
    powers = np.floor(-np.log10(np.maximum(sigma, 1e-300)))
    return np.clip(powers, 0, DECADES - 1).astype(np.int64)


def _cases(word: str, sample: SampleSet, flags: NDArray[np.bool_]) -> Iterator[str]:
    for k in np.flatnonzero(flags)[:SHOWN]:
        yield f"{word} {sample.sigma[k]:.3e} " + " ".join(map(repr, sample.q[k].tolist()))
