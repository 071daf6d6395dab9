"""Verify what was emitted, before it is written and later."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from ikgen.derivation.progress import Progress, silent
from ikgen.errors import BadDescriptionError, VerificationError
from ikgen.generation.emitted_arm import EmittedArm
from ikgen.generation.runners_ahead import RunnersAhead
from ikgen.outputs.publish import write_texts
from ikgen.processes.scratch_folder import ScratchFolder
from ikgen.verify.shared_work import SharedWork

if TYPE_CHECKING:
    from ikgen.emit.derivation import Derivation, Reading
    from ikgen.generation.emitters import Emitter
    from ikgen.records.request import Outputs
    from ikgen.verify.oracle import Oracle
    from ikgen.verify.runners.runner import Runner
    from ikgen.verify.verification_report import VerificationReport

__all__ = ["oracle_for", "verify_emitted", "verify_one", "verify_texts", "with_samples"]

Emit = Callable[["Emitter"], Mapping[str, str]]
"""File name -> text of an output."""


def with_samples(derivation: Derivation) -> Derivation:
    """The derivation whose outputs can run: numbers in place of the constants to be filled in."""
    if not derivation.reading.dh.symbols:
        return derivation
    return replace(derivation, module=replace(derivation.module, sample=True))


def verify_emitted(
    derivation: Derivation,
    emitters: Sequence[Emitter],
    emit: Emit,
    outputs: Outputs,
    progress: Progress,
) -> dict[str, VerificationReport]:
    """The verification of what `emit` gives, each language once, of a table without numbers of that with
    samples: `emitters` are of languages that can run."""
    sampled = with_samples(derivation)

    def emit_to_run(emitter: Emitter) -> Mapping[str, str]:
        texts = emit(emitter)
        return texts if sampled is derivation else emitter.emit(sampled)

    return verify_texts(sampled, emitters, emit_to_run, outputs, progress)


def verify_texts(
    derivation: Derivation,
    emitters: Sequence[Emitter],
    emit: Emit,
    outputs: Outputs,
    progress: Progress = silent,
) -> dict[str, VerificationReport]:
    """Emit and verify texts before they are written, each language that can run; raises
    `VerificationError` if one fails."""
    with ScratchFolder("ikgen-") as folder:
        reports = _reports(derivation, folder, emitters, emit, outputs, progress)
    for name, report in reports.items():
        if not report.passed:
            raise VerificationError(
                f"the emitted {name} code failed its verification: {report.worst_case}",
                reports=reports,
                derivation=derivation,
                hint=_hint(derivation.reading),
            )
    return reports


def _hint(reading: Reading) -> str:
    """What to do about code that failed: lengths in mm or angles in degrees are no fault of ikgen's."""
    if not reading.source.warnings:
        return "nothing was written; run with -v for the whole table, and please report it"
    return (
        "nothing was written; see first to what is odd in the file, as the warnings say; if it is meant "
        "so, run with -v for the whole table, and please report it"
    )


def _reports(
    derivation: Derivation,
    folder: Path,
    emitters: Sequence[Emitter],
    emit: Emit,
    outputs: Outputs,
    progress: Progress,
) -> dict[str, VerificationReport]:
    arm = EmittedArm.of(derivation.module)
    reports: dict[str, VerificationReport] = {}
    emitted: set[str] = set()

    def make(emitter: Emitter) -> Runner | None:
        write_texts(folder, emit(emitter))
        emitted.add(emitter.name)
        return emitter.runner(arm, folder)

    first = None
    in_turn = sorted(emitters, key=lambda one: one.compiled)
    before = next((k for k, one in enumerate(in_turn) if one.compiled), 0)
    with RunnersAhead([partial(make, one) for one in in_turn], before) as runners:
        oracle, shared = oracle_for(derivation.reading), SharedWork()
        for emitter in in_turn:
            runner = _taken(runners, emitter, emitted)
            if runner is not None:
                report = verify_one(
                    runner, oracle, arm, outputs, progress, peer=first, shared=shared
                )
                reports[emitter.name] = report
                first = first or runner
    return {one.name: reports[one.name] for one in emitters if one.name in reports}


def _taken(runners: RunnersAhead, emitter: Emitter, emitted: Collection[str]) -> Runner | None:
    """What runs an output: if one of those that were `emitted` cannot be run, ikgen's text is wrong, not
    the user's."""
    try:
        return runners.take()
    except BadDescriptionError as error:
        if emitter.name not in emitted:
            raise
        raise VerificationError(
            f"the emitted {emitter.name} code {error.problem}",
            hint="nothing was written; please report it",
        ) from error


def oracle_for(reading: Reading) -> Oracle:
    """Pinocchio's forward kinematics of what was read."""
    from ikgen.verify.oracle import PinocchioOracle, oracle_from_dh

    dh = reading.dh
    if reading.tree is None:
        return oracle_from_dh(dh)
    names = [joint.name for joint in dh.joints]
    return PinocchioOracle(
        reading.tree, dh.base_link, dh.tip_link, names, locked=dict(dh.locked) or None
    )


def verify_one(
    runner: Runner,
    oracle: Oracle,
    arm: EmittedArm,
    outputs: Outputs,
    progress: Progress,
    *,
    peer: Runner | None = None,
    shared: SharedWork | None = None,
) -> VerificationReport:
    """The verification of one language: what `runner` runs against the oracle, and against the same
    solver in another language, with which it has `shared` work."""
    import numpy as np

    from ikgen.lowering.held_angle import held_angle
    from ikgen.verify.verification import verify

    dh = arm.dh
    return verify(
        runner,
        oracle,
        task=arm.task,
        samples=outputs.samples,
        seed=outputs.seed,
        locked=dict(dh.locked) or None,
        free_joints=dh.held,
        angle=held_angle(dh),
        limits=(
            np.array([j.limits.lower for j in dh.joints]),
            np.array([j.limits.upper for j in dh.joints]),
        ),
        peer=peer,
        progress=lambda stage, done, total: progress("verify", stage),
        shared=shared,
    )
