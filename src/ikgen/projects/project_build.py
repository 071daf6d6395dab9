"""Generate the arms of a config that are stale, several at a time in processes of their own."""

from __future__ import annotations

import traceback
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from ikgen.derivation.progress import Progress, Stage, Steps, silent
from ikgen.errors import INTERNAL_ERROR, IkgenError, place_in, told
from ikgen.outputs.journal import complete_folder
from ikgen.processes.executors import Workers
from ikgen.projects.config import ArmConfig
from ikgen.projects.entry_words import EntryWords
from ikgen.projects.stale import stale_reasons
from ikgen.records.record import read_record

if TYPE_CHECKING:
    from concurrent.futures import Executor, Future

    from ikgen.generation.generate import Generation

    WorkWords = Callable[[Generation | IkgenError], str]

__all__ = ["Outcome", "build_arms"]


@dataclass(frozen=True, slots=True)
class Outcome:
    """What happened to one arm: `reason` it was stale (empty: fresh, left alone), its files, and
    the error if it failed (`exit_code` then is not 0); `trace` is that of an internal error, `warnings`
    are what has to be told of the file and of what was generated, `solutions` how many a pose has at
    most, `missed` in words what the verification of each output missed, empty where that is nothing;
    `told` are lines on what was chosen: a task, joints to hold, what these answer by default; `steps` are
    what the work told while it ran and `work` how it went, where that was asked for. `place` is what the
    error is about in the config, as messages begin with it ("": nothing that can be told)."""

    name: str
    reason: str
    files: tuple[Path, ...] = ()
    seconds: float = 0.0
    message: str = ""
    hint: str = ""
    exit_code: int = 0
    trace: str = ""
    warnings: tuple[str, ...] = ()
    solutions: int = 0
    missed: str = ""
    told: tuple[str, ...] = ()
    steps: tuple[tuple[Stage, str], ...] = ()
    work: str = ""
    place: str = ""

    @property
    def error(self) -> str:
        """The message, with whose it is."""
        return f"{self.place}{self.name}: {self.message}"


@dataclass(frozen=True, slots=True)
class _Job:
    """One arm to generate: why, whether to verify it, and what puts its work in words, if anything."""

    arm: ArmConfig
    reason: str
    verify: bool
    words: WorkWords | None


def build_arms(
    arms: Sequence[ArmConfig],
    *,
    force: bool = False,
    verify: bool = True,
    workers: Workers | None = None,
    progress: Progress = silent,
    words: WorkWords | None = None,
) -> Iterator[Outcome]:
    """Bring every arm up to date by `workers` (None: a process a core); outcomes in the order of the
    config, with their steps and their work in `words` (a function that workers can import) if given."""
    for out in {arm.outputs.out for arm in arms}:
        complete_folder(out)
    reasons = [
        reason or ("asked for" if force else "") for reason in stale_reasons(arms, verify=verify)
    ]
    work = [
        _Job(arm, reason, verify, words)
        for arm, reason in zip(arms, reasons, strict=True)
        if reason
    ]
    for arm, reason in zip(arms, reasons, strict=True):
        progress("build", f"{arm.name}: {reason or 'up to date'}")
    made = _run(work, workers or Workers())
    for arm, reason in zip(arms, reasons, strict=True):
        yield next(made) if reason else Outcome(arm.name, "", _files(arm))
    yield from made  # none is left: the workers are let go


def _run(work: Sequence[_Job], workers: Workers) -> Iterator[Outcome]:
    """The outcomes in the order of the work."""
    count = min(len(work), workers.processes)
    if count <= 1 and workers.executor == "process":
        yield from map(_build_one, work)
        return
    with replace(workers, count=max(count, 1)).open() as pool:
        waiting = [(job, _submit(pool, job)) for job in work]
        for job, answer in waiting:
            try:
                yield answer.result()
            except Exception:  # what goes wrong in the work is in its outcome: the worker was lost
                yield _killed(job.arm.name, job.reason)


def _submit(pool: Executor, job: _Job) -> Future[Outcome]:
    """The answer to come; a pool whose worker was killed refuses further jobs."""
    from concurrent.futures import BrokenExecutor, Future

    try:
        return pool.submit(_build_one, job)
    except BrokenExecutor as error:
        refused: Future[Outcome] = Future()
        refused.set_exception(error)
        return refused


def _killed(name: str, reason: str) -> Outcome:
    """The outcome of an arm that got no answer."""
    return Outcome(
        name,
        reason,
        message="not generated: a worker process was killed or could not start",
        hint="too little memory? --jobs 1 generates one arm at a time",
        exit_code=INTERNAL_ERROR,
    )


def _build_one(job: _Job) -> Outcome:
    """Generate one arm; errors become part of the outcome, since they must cross processes."""
    from ikgen.generation.generate import generate

    outputs = replace(
        job.arm.outputs, verify=job.verify, only=True, ours=True
    )  # the config's alone
    steps = Steps()
    work = ""
    try:
        made = generate(job.arm.request, outputs, steps)
        outcome = _made(job, made)
        work = job.words(made) if job.words else ""
    except Exception as error:
        outcome = _failed(job, error)
        work = job.words(error) if job.words and isinstance(error, IkgenError) else ""
    if job.words:
        outcome = replace(outcome, steps=tuple(steps.told), work=work)
    return _in_config_words(outcome, job.arm)


def _in_config_words(outcome: Outcome, arm: ArmConfig) -> Outcome:
    """What is told of an arm that a config lists: of its entries, and where the error's stands."""
    if arm.place is None:
        return outcome
    said = EntryWords(arm.request)
    outcome = replace(
        outcome,
        hint=said.words(outcome.hint),
        told=tuple(map(said.words, outcome.told)),
        warnings=tuple(map(said.words, outcome.warnings)),
    )
    if not outcome.message or outcome.exit_code == INTERNAL_ERROR:
        return outcome
    line = arm.place.line_about(said.names_in(outcome.message))
    place = place_in(arm.place.file.as_posix(), line)
    return replace(outcome, message=said.words(outcome.message), place=place)


def _failed(job: _Job, error: Exception) -> Outcome:
    """The outcome of an arm that cannot be generated."""
    message, hint, code = told(error, traced=job.words is not None)
    return Outcome(
        job.arm.name,
        job.reason,
        message=message,
        hint=hint,
        exit_code=code,
        trace="".join(traceback.format_exception(error)) if code == INTERNAL_ERROR else "",
        warnings=error.warnings if isinstance(error, IkgenError) else (),
    )


def _made(job: _Job, made: Generation) -> Outcome:
    """The outcome of an arm that was generated."""
    from ikgen.derivation.announcements import announcements

    missed = "; ".join(f"{n} {r.missed_words}" for n, r in made.reports.items() if r.missed)
    return Outcome(
        job.arm.name,
        job.reason,
        made.files,
        made.seconds,
        warnings=announcements(made.derivation),
        solutions=made.derivation.module.max_solutions,
        missed=missed,
        told=_told(made),
    )


def _told(made: Generation) -> tuple[str, ...]:
    """Lines on what was chosen, and on what held joints answer by default."""
    from ikgen.generation.result import default_words, task_words

    derivation, task = made.derivation, task_words(made.derivation)
    held = derivation.held.words if derivation.held is not None else ""
    chosen = task if task != derivation.task.words else ""
    return tuple(filter(None, (chosen, held, default_words(made, "random poses"))))


def _files(arm: ArmConfig) -> tuple[Path, ...]:
    """The files of a fresh arm, from its records."""
    records = [read_record(path) for path in arm.records]
    outputs = (record.folder / name for record in records for name in record.files)
    return (*outputs, *arm.records)
