"""Check outputs against their description as it is now."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from ikgen.errors import (
    BadDescriptionError,
    IkgenError,
    UnknownNameError,
    UsageError,
    VerificationError,
)
from ikgen.generation.pipeline import Reading, Request, read
from ikgen.generation.publish import left_over
from ikgen.generation.record import Record, digest
from ikgen.projects.check_findings import Finding, Recheck

if TYPE_CHECKING:
    from ikgen.emit.solver_module import SolverModule
    from ikgen.verify.oracle import Oracle
    from ikgen.verify.verification_report import VerificationReport

__all__ = ["recheck", "request_of"]

_SAME = 1e-9
_SAMPLES = 200


@dataclass(frozen=True, slots=True)
class _Recorded:
    """The part of a `SolverModule` that runners and the verification need, without deriving it."""

    name: str
    dh: Any
    task: str
    free: tuple[int, ...]
    max_solutions: int


def request_of(record: Record, robot: Path | None = None) -> Request:
    """The request that made the outputs, for its own or another description."""
    source = robot or record.robot
    table = source.suffix == ".toml"
    return Request(
        robot=source,
        base=None if table else record.base,
        tip=None if table else record.tip,
        task=record.task,
        free=tuple(record.free.items()),
        locked=record.lock,
        arguments=record.args,
        package_paths=record.package_paths,
        name=record.name,
    )


def recheck(
    record: Record,
    *,
    robot: Path | None = None,
    command: str | None = None,
    samples: int = 1000,
    seed: int = 0,
    progress: Callable[[str, str], None] = lambda stage, detail: None,
) -> Recheck:
    """Expand the description again and check every output against it.

    `command` is what to type to put things right (default: the command that made the outputs).
    Raises `IkgenError` where the description cannot be read.
    """
    fix = command or record.command(robot)
    findings = [*_edited(record, fix), *_left_over(record)]
    progress("read", str(robot or record.robot))
    try:
        reading = read(request_of(record, robot))
    except (UnknownNameError, UsageError) as error:
        if not (robot or record.robot).is_file():
            raise
        message = f"made from another description: {error.message}"
        return Recheck(record.path, record, (*findings, Finding(record.path, message, fix)))
    changed = reading.source.sha256 != record.source_sha256
    notes = ["the text of the description has changed since"] if changed else []
    joints = tuple(joint.name for joint in reading.dh.joints)
    if joints != record.joints:
        was, now = ", ".join(record.joints), ", ".join(joints)
        message = f"made for other joints: {was}; the description has {now}"
        findings.append(Finding(record.path, message, fix))
        return Recheck(record.path, record, tuple(findings), tuple(notes))
    if reading.dh.symbols:
        if changed:  # what cannot run cannot show that only a remark changed
            findings.append(Finding(record.path, "made from an earlier description", fix))
        blanks = ", ".join(reading.dh.symbols)
        notes.append(f"not run: no numbers for {blanks} (give them under [parameters])")
        return Recheck(record.path, record, tuple(findings), tuple(notes))
    reports = _check_outputs(record, reading, fix, findings, (samples, seed), progress)
    return Recheck(record.path, record, tuple(findings), tuple(notes), reports)


def _edited(record: Record, fix: str) -> list[Finding]:
    """Outputs that are gone or differ from what was written."""
    found = []
    for name, expected in record.files.items():
        path = record.folder / name
        actual = digest(path)
        if actual is None:
            found.append(Finding(path, "is recorded but not there", fix))
        elif actual != expected:
            found.append(Finding(path, "was edited after it was generated", fix))
    return found


def _left_over(record: Record) -> list[Finding]:
    """Outputs of an earlier run beside those of the record, which nobody keeps up to date."""
    message = "is of an earlier run and not in the record, so that nothing keeps it right"
    fix = f"remove it, or generate again with --emit {','.join(record.emit)},..."
    found = left_over(record.folder, record.name, record.files)
    return [Finding(path, message, fix) for path in found]


def _check_outputs(
    record: Record,
    reading: Reading,
    fix: str,
    findings: list[Finding],
    sampling: tuple[int, int],
    progress: Callable[[str, str], None],
) -> dict[str, VerificationReport]:
    """Run every output that can be run; appends to `findings`."""
    from ikgen.generation.emitters import find_emitter
    from ikgen.generation.generation import Outputs, oracle_for, verify_one

    oracle = oracle_for(reading)
    free = tuple(i for i, j in enumerate(reading.dh.joints) if j.name in reading.dh.free)
    module = cast(
        "SolverModule",
        _Recorded(record.name, reading.dh, record.task, free, record.max_solutions),
    )
    outputs = Outputs(record.emit, record.folder, *sampling)
    reports: dict[str, VerificationReport] = {}
    first = None
    for name in record.emit:
        file = _file_of(record, name)
        try:
            runner = find_emitter(name).runner(module, record.folder)
            if runner is None:
                continue
            message, deviation = _difference(runner, oracle, reading)
            if message:
                findings.append(Finding(file, message, fix, deviation))
                continue
            reports[name] = verify_one(runner, oracle, module, outputs, progress, peer=first)
        except (BadDescriptionError, VerificationError) as error:
            findings.append(Finding(file, error.message, fix))
            continue
        except IkgenError as error:  # no compiler, a plug-in that fails: not the output's fault
            findings.append(Finding(file, error.message, error.hint, None, error.exit_code))
            continue
        first = first or runner
        if not reports[name].passed:
            findings.append(Finding(file, f"is wrong: {reports[name].worst_case}", fix))
    return reports


def _file_of(record: Record, emitter: str) -> Path:
    """The file to name in messages about an output."""
    suffix = {"python": ".py", "cpp": ".hpp"}.get(emitter, "")
    names = [n for n in record.files if suffix and n.endswith(suffix)]
    return record.folder / names[0] if names else record.path


def _difference(
    runner: Any, oracle: Oracle, reading: Reading
) -> tuple[str, tuple[float, float] | None]:
    """How far the output's forward kinematics are from the description's, in words and in m and
    rad; empty if they agree."""
    import numpy as np

    rng = np.random.default_rng(0)
    limits = [joint.limits for joint in reading.dh.joints]
    low = np.array([max(x.lower, -np.pi) for x in limits])
    high = np.array([min(x.upper, np.pi) for x in limits])
    q = rng.uniform(np.minimum(low, high), np.maximum(low, high), size=(_SAMPLES, len(limits)))
    try:
        ours = runner.forward(q)
    except Exception as error:
        return f"forward raises {type(error).__name__}: {error}", None
    theirs = oracle.forward(q)
    if ours.shape != theirs.shape or not np.isfinite(ours).all():
        return "forward gives no poses", None
    metres = float(np.linalg.norm(ours[:, :3, 3] - theirs[:, :3, 3], axis=1).max())
    turn = np.linalg.norm(ours[:, :3, :3] - theirs[:, :3, :3], axis=(1, 2)).max()
    radians = float(2.0 * np.arcsin(min(1.0, turn / np.sqrt(8.0))))
    if max(metres, radians) <= _SAME:
        return "", None
    metres, radians = (value if value > _SAME else 0.0 for value in (metres, radians))
    return (
        "made from another geometry: its forward kinematics differ from the description's by up to "
        f"{1e3 * metres:.6g} mm and {radians:.6g} rad"
    ), (metres, radians)
