"""Generate: derive, emit, verify, and write all outputs or none."""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from ikgen.derivation.derive import derive
from ikgen.derivation.progress import Progress, silent
from ikgen.derivation.read import default_name, read
from ikgen.errors import IkgenError, UnsolvedChainError, VerificationError
from ikgen.generation.emitted_checks import verify_emitted
from ikgen.generation.emitters import Emitter, find_emitter, solver_files
from ikgen.outputs.earlier import earlier_outputs
from ikgen.outputs.journal import complete_folder
from ikgen.outputs.new_records import record_texts
from ikgen.outputs.publish import check_folder, left_over, publish
from ikgen.tasks import find_task

if TYPE_CHECKING:
    from ikgen.emit.derivation import Derivation, Reading
    from ikgen.records.request import Outputs, Request
    from ikgen.verify.verification_report import VerificationReport

__all__ = ["Generation", "Made", "generate", "make_texts"]


@dataclass(frozen=True, slots=True)
class Generation:
    """What was made: the derivation, the files and the verification of each language. `kept` are outputs
    that an earlier run had made and that were made again, `removed` its files that no output is any more,
    `left` solvers of that name that no record knows."""

    derivation: Derivation
    files: tuple[Path, ...]
    reports: Mapping[str, VerificationReport] = field(default_factory=dict)
    seconds: float = 0.0
    kept: tuple[str, ...] = ()
    removed: tuple[Path, ...] = ()
    left: tuple[Path, ...] = ()


def generate(request: Request, outputs: Outputs, progress: Progress = silent) -> Generation:
    """The main job. Raises `VerificationError` (and writes nothing) if a check fails, `UsageError` where
    outputs of another robot, chain or task, or files that ikgen did not write, would be replaced."""
    started = time.perf_counter()
    check_folder(outputs.out)
    asked = [find_emitter(name) for name in outputs.emit]
    progress("read", request.robot.name)
    reading = read(request)
    complete_folder(outputs.out)  # first: it tells what is there
    earlier = earlier_outputs(outputs.out, request.name or default_name(reading))
    same_arm_only = not (outputs.force or outputs.ours)
    if same_arm_only:
        earlier.check(request, reading, _task_name(request))
    kept = () if outputs.only else tuple(n for n in earlier.emit if n not in outputs.emit)
    emitters = [*_again(kept), *asked]
    try:
        made = make_texts(request, reading, emitters, outputs, progress)
    except IkgenError as error:
        error.warnings = reading.source.warnings
        raise
    derivation = made.derivation
    if same_arm_only:
        earlier.check(request, reading, derivation.task.name)
    texts = made.files | record_texts(request, outputs, derivation, made.texts)
    if not outputs.force:
        earlier.check_files(outputs.out, texts, edited=outputs.ours)
    removed = tuple(earlier.outdated([outputs.out / name for name in texts]))
    files = publish(outputs.out, texts, removed)
    seconds = time.perf_counter() - started
    solvers = (outputs.out / name for name in solver_files(derivation.module.name))
    left = left_over(solvers, files)
    return Generation(derivation, files, made.reports, seconds, kept, removed, left)


def _task_name(request: Request) -> str | None:
    """The name of the task that is asked for; None where none is."""
    name = request.named_task
    return find_task(name).name if name else None


def _again(kept: Sequence[str]) -> list[Emitter]:
    """The emitters of an earlier run's outputs."""
    try:
        return [find_emitter(name) for name in kept]
    except IkgenError as error:
        error.hint = f"an earlier run made it here; --only leaves it out. {error.hint}".strip()
        raise


_REFUSED = 2
"""How many choices of joints to hold may fail the verification before it ends the run."""


@dataclass(frozen=True, slots=True)
class Made:
    """Texts that are not written yet: `texts` by output and file name, the derivation, the verification of
    each language, and tasks that were `passed_over` because what they gave failed it."""

    texts: Mapping[str, dict[str, str]]
    derivation: Derivation
    reports: Mapping[str, VerificationReport]
    passed_over: tuple[str, ...] = ()

    @property
    def files(self) -> dict[str, str]:
        """File name -> text of all outputs."""
        return {name: text for one in self.texts.values() for name, text in one.items()}


def make_texts(
    request: Request,
    reading: Reading,
    emitters: Sequence[Emitter],
    outputs: Outputs,
    progress: Progress = silent,
) -> Made:
    """Derive, emit and verify; nothing is written. Raises `VerificationError` if a check fails,
    `UnsolvedChainError` where rows are missing of a form that was known not to have all.

    Where what was chosen for the arm fails, the next choice is taken: of joints to hold, of the tool's
    axis, and in the end the whole pose. Where no other is left or solved, the last failure is told.
    """
    tasks: list[str] = []
    held: list[tuple[str, ...]] = []
    failed: VerificationError | None = None
    while True:
        try:
            derivation = derive(request, progress, tasks, reading, held)
        except UnsolvedChainError:
            if failed is None:
                raise
            raise _incomplete(failed, request) from None
        try:
            made, reports = _emitted(derivation, emitters, outputs, progress)
            break
        except VerificationError as error:
            failed = error
        if derivation.held is not None and derivation.held.others and len(held) < _REFUSED:
            held.append(derivation.held.joints)
        elif derivation.chosen and not derivation.task.whole_pose:
            tasks.append(derivation.task.name)
        else:
            raise _incomplete(failed, request) from None
    for emitter in emitters:
        if emitter.tells_verification:
            progress("emit", emitter.name)
            made[emitter.name] = emitter.emit(derivation, reports)
    return Made(made, derivation, reports, tuple(tasks))


def _incomplete(failed: VerificationError, request: Request) -> IkgenError:
    """What a failed verification tells in the end."""
    from ikgen.derivation.unsolved import incomplete_error  # it brings the report along

    return incomplete_error(failed, request)


def _emitted(
    derivation: Derivation, emitters: Sequence[Emitter], outputs: Outputs, progress: Progress
) -> tuple[dict[str, dict[str, str]], dict[str, VerificationReport]]:
    """The texts of all outputs but those that tell the verification, and the verification: where none of
    them runs, that of a Python module which is not written."""
    made: dict[str, dict[str, str]] = {}

    def emit(emitter: Emitter) -> dict[str, str]:
        progress("emit", emitter.name)
        made[emitter.name] = emitter.emit(derivation)
        return made[emitter.name]

    run: list[Emitter] = []
    other: list[Emitter] = []
    for emitter in emitters:
        if not emitter.tells_verification:
            (run if outputs.verify and emitter.runner_target else other).append(emitter)
    for emitter in other:
        emit(emitter)
    if outputs.verify and not run:
        run.append(find_emitter("python"))
    reports = verify_emitted(derivation, run, emit, outputs, progress) if run else {}
    return {one.name: made[one.name] for one in emitters if one.name in made}, reports
