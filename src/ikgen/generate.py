"""Generate: derive, emit, verify, and write all outputs or none."""

from __future__ import annotations

import json
import os
import shutil
import tempfile
import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ikgen.errors import VerificationError
from ikgen.pipeline import Derivation, Progress, Reading, Request, derive

if TYPE_CHECKING:
    from ikgen.emit.module import SolverModule
    from ikgen.verify.oracle import Oracle
    from ikgen.verify.report import VerificationReport

__all__ = ["Generation", "Outputs", "generate", "oracle_for", "verify_files"]


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
    """The main job. Raises `VerificationError` (and writes nothing) if a check fails."""
    from ikgen.emit.registry import find_emitter

    started = time.perf_counter()
    emitters = [find_emitter(name) for name in outputs.emit]
    derivation = derive(request, progress)
    texts: dict[str, str] = {}
    for emitter in emitters:
        progress("emit", emitter.name)
        texts |= emitter.emit(derivation)
    manifest = _manifest(request, outputs, derivation, texts)
    texts[f"{derivation.module.name}_ik.json"] = manifest
    outputs.out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=".ikgen-", dir=outputs.out) as folder:
        staging = Path(folder)
        for name, text in texts.items():
            path = staging / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text, encoding="utf-8", newline="\n")
        reports: dict[str, VerificationReport] = {}
        if outputs.verify:
            reports = verify_files(derivation, staging, outputs, progress)
        files = _publish(staging, outputs.out, texts)
    return Generation(derivation, files, reports, time.perf_counter() - started)


def _publish(staging: Path, out: Path, texts: Mapping[str, str]) -> tuple[Path, ...]:
    """Move finished files into place, each in one step; unchanged ones keep their time."""
    files: list[Path] = []
    for name, text in texts.items():
        target = out / name
        files.append(target)
        if target.is_file() and target.read_text(encoding="utf-8") == text:
            continue
        target.parent.mkdir(parents=True, exist_ok=True)
        os.replace(staging / name, target)
    shutil.rmtree(staging, ignore_errors=True)
    staging.mkdir(exist_ok=True)
    return tuple(files)


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


def verify_files(
    derivation: Derivation, folder: Path, outputs: Outputs, progress: Progress = _silent
) -> dict[str, VerificationReport]:
    """Verify every emitted language in a folder; raises `VerificationError` if one fails."""
    from ikgen.emit.registry import find_emitter

    oracle = oracle_for(derivation.reading)
    reports: dict[str, VerificationReport] = {}
    for name in outputs.emit:
        runner = find_emitter(name).runner(derivation.module, folder)
        if runner is not None:
            reports[name] = _verify_one(runner, oracle, derivation.module, outputs, progress)
    for name, report in reports.items():
        if not report.passed:
            raise VerificationError(
                f"the emitted {name} code failed its verification: {report.worst_case}",
                reports=reports,
                hint="nothing was written; run with -v for the whole table, and please report it",
            )
    return reports


def _verify_one(
    runner: Any, oracle: Oracle, module: SolverModule, outputs: Outputs, progress: Progress
) -> VerificationReport:
    import numpy as np

    from ikgen.verify.run import verify

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
        progress=lambda stage, done, total: progress("verify", stage),
    )


def _manifest(
    request: Request, outputs: Outputs, derivation: Derivation, texts: Mapping[str, str]
) -> str:
    """What the outputs were made from: enough to make and to verify them again."""
    import hashlib

    module = derivation.module
    record = {
        "generator": "ikgen",
        "version": module.generator_version,
        "name": module.name,
        "robot": os.path.relpath(request.robot.resolve(), outputs.out.resolve()),
        "source_sha256": module.source_sha256,
        "base": module.dh.base_link,
        "tip": module.dh.tip_link,
        "task": module.task,
        "free": {n: v for n, v in request.free},
        "lock": dict(request.locked),
        "args": dict(request.arguments),
        "package_paths": [
            os.path.relpath(p.resolve(), outputs.out.resolve()) for p in request.package_paths
        ],
        "emit": list(outputs.emit),
        "files": {
            name: hashlib.sha256(text.encode()).hexdigest() for name, text in sorted(texts.items())
        },
    }
    return json.dumps(record, indent=2) + "\n"
