"""Generate: derive, emit, verify, and write all outputs or none."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ikgen.errors import BadDescriptionError, VerificationError
from ikgen.generation.manifest import manifest
from ikgen.generation.pipeline import Derivation, Progress, Reading, Request, derive
from ikgen.generation.publish import publish, write_texts

if TYPE_CHECKING:
    from ikgen.emit.solver_module import SolverModule
    from ikgen.generation.emitters import Emitter
    from ikgen.verify.oracle import Oracle
    from ikgen.verify.verification_report import VerificationReport

__all__ = [
    "Generation",
    "Outputs",
    "generate",
    "oracle_for",
    "verify_files",
    "verify_one",
    "verify_texts",
    "with_samples",
]


@dataclass(frozen=True, slots=True)
class Outputs:
    """What to write and how to check it. `samples` random poses are drawn from `seed`."""

    emit: tuple[str, ...] = ("python",)
    out: Path = Path()
    samples: int = 1000
    seed: int = 0
    verify: bool = True


@dataclass(frozen=True, slots=True)
class Generation:
    """What was made: the derivation, the files and the verification of each language."""

    derivation: Derivation
    files: tuple[Path, ...]
    reports: Mapping[str, VerificationReport] = field(default_factory=dict)
    seconds: float = 0.0


def _silent(stage: str, detail: str) -> None:
    """No progress."""


def generate(request: Request, outputs: Outputs, progress: Progress = _silent) -> Generation:
    """The main job. Raises `VerificationError` (and writes nothing) if a check fails.

    Where the task was chosen to fit the arm, and its closed form has a weak step and fails, the next one
    is taken: the whole pose.
    """
    from ikgen.generation.emitters import find_emitter

    started = time.perf_counter()
    emitters = [find_emitter(name) for name in outputs.emit]
    derivation = derive(request, progress)
    try:
        texts, reports = _made(derivation, emitters, outputs, progress)
    except VerificationError:
        if not derivation.chosen or derivation.graph.sound or derivation.task.whole_pose:
            raise
        derivation = derive(request, progress, passed_over={derivation.task.name})
        texts, reports = _made(derivation, emitters, outputs, progress)
    for emitter in emitters:
        if emitter.tells_verification:
            progress("emit", emitter.name)
            texts |= emitter.emit(derivation, reports)
    record = manifest(request, outputs, derivation, texts)
    texts[f"{derivation.module.name}_ik.json"] = record
    files = publish(outputs.out, texts)
    return Generation(derivation, files, reports, time.perf_counter() - started)


def _made(
    derivation: Derivation, emitters: Sequence[Emitter], outputs: Outputs, progress: Progress
) -> tuple[dict[str, str], dict[str, VerificationReport]]:
    """The texts of all outputs but those that tell the verification, and the verification."""
    texts: dict[str, str] = {}
    for emitter in emitters:
        if not emitter.tells_verification:
            progress("emit", emitter.name)
            texts |= emitter.emit(derivation)
    if not outputs.verify:
        return texts, {}
    return texts, _verified(derivation, texts, emitters, outputs, progress)


def _verified(
    derivation: Derivation,
    texts: Mapping[str, str],
    emitters: Sequence[Emitter],
    outputs: Outputs,
    progress: Progress,
) -> dict[str, VerificationReport]:
    """The verification of what was emitted: of a table without numbers that with samples."""
    sampled = with_samples(derivation)
    if sampled is not derivation:
        texts = {}
        for emitter in emitters:
            if emitter.runner_target is not None:
                texts |= emitter.emit(sampled)
    return verify_texts(sampled, texts, outputs, progress)


def with_samples(derivation: Derivation) -> Derivation:
    """The derivation whose outputs can run: numbers in place of the constants to be filled in."""
    if not derivation.reading.dh.symbols:
        return derivation
    return replace(derivation, module=replace(derivation.module, sample=True))


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


def verify_texts(
    derivation: Derivation, texts: Mapping[str, str], outputs: Outputs, progress: Progress = _silent
) -> dict[str, VerificationReport]:
    """Verify emitted texts (name -> text) before they are written; raises `VerificationError`."""
    with tempfile.TemporaryDirectory(prefix="ikgen-", ignore_cleanup_errors=True) as name:
        write_texts(Path(name), texts)
        return verify_files(derivation, Path(name), outputs, progress)


def verify_files(
    derivation: Derivation, folder: Path, outputs: Outputs, progress: Progress = _silent
) -> dict[str, VerificationReport]:
    """Verify every emitted language in a folder; raises `VerificationError` if one fails."""
    from ikgen.generation.emitters import find_emitter

    oracle = oracle_for(derivation.reading)
    reports: dict[str, VerificationReport] = {}
    first = None
    for name in outputs.emit:
        runner = _runner(find_emitter(name), derivation.module, folder)
        if runner is not None:
            module = derivation.module
            reports[name] = verify_one(runner, oracle, module, outputs, progress, peer=first)
            first = first or runner
    for name, report in reports.items():
        if not report.passed:
            raise VerificationError(
                f"the emitted {name} code failed its verification: {report.worst_case}",
                reports=reports,
                hint="nothing was written; run with -v for the whole table, and please report it",
            )
    return reports


def _runner(emitter: Emitter, module: SolverModule, folder: Path) -> Any | None:
    """What runs an output that was just emitted: if it cannot be run, ikgen's text is wrong, not the
    user's."""
    try:
        return emitter.runner(module, folder)
    except BadDescriptionError as error:
        raise VerificationError(
            f"the emitted {emitter.name} code {error.problem}",
            hint="nothing was written; please report it",
        ) from error


def verify_one(
    runner: Any,
    oracle: Oracle,
    module: SolverModule,
    outputs: Outputs,
    progress: Progress,
    *,
    peer: Any | None = None,
) -> VerificationReport:
    """The verification of one language: what `runner` runs against the oracle, and against the same
    solver in another language."""
    import numpy as np

    from ikgen.verify.verification import verify

    dh = module.dh
    return verify(
        runner,
        oracle,
        task=module.task,
        samples=outputs.samples,
        seed=outputs.seed,
        locked=dict(dh.locked) or None,
        free_joints=[dh.joints[j].name for j in module.free],
        limits=(
            np.array([j.limits.lower for j in dh.joints]),
            np.array([j.limits.upper for j in dh.joints]),
        ),
        peer=peer,
        progress=lambda stage, done, total: progress("verify", stage),
    )
