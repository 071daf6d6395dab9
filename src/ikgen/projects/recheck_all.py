"""Check all the outputs that a config lists or that lie in a folder."""

from __future__ import annotations

import os
from collections import Counter
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from ikgen.derivation.progress import Progress, silent
from ikgen.errors import IkgenError, UsageError
from ikgen.outputs.journal import interrupted
from ikgen.projects.check import mending
from ikgen.projects.check_findings import HALF_IN_PLACE, Finding, Recheck, unchecked
from ikgen.projects.config import default_config, load_config
from ikgen.projects.proofs import proved
from ikgen.projects.recheck import recheck
from ikgen.records.record import SUFFIX, find_records, read_record

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from ikgen.processes.executors import Workers
    from ikgen.verify.verification_report import CheckResult

__all__ = ["recheck_all", "write_junit"]


def recheck_all(
    target: Path | None,
    *,
    robot: Path | None = None,
    samples: int = 1000,
    seed: int = 0,
    trust: bool = False,
    prove: bool = False,
    workers: Workers | None = None,
    progress: Progress = silent,
    done: Callable[[int, int], None] = lambda ready, total: None,
) -> list[Recheck]:
    """Check everything that is meant, in order: the outputs of a config, those below a folder, or those of
    one record; with `prove` also prove their derivations. What keeps one from being checked is its finding,
    so that the others are checked too. `workers` and `done` are for many samples, as in `recheck`."""
    results = []
    for path, command in _records(target, robot):
        if not path.is_file() and interrupted(path.parent):
            hint = f"ikgen build, or the command that wrote to '{path.parent}', again"
            half = Finding(path, HALF_IN_PLACE, command or "", hint=hint)
            results.append(Recheck(path, None, (half,)))
            continue
        record = None
        try:
            record = read_record(path)
            result = recheck(
                record,
                robot=robot,
                command=command,
                samples=samples,
                seed=seed,
                trust=trust,
                workers=workers,
                progress=progress,
                done=done,
            )
            results.append(proved(result, robot, progress) if prove else result)
        except IkgenError as error:
            results.append(unchecked(path, record, error))
    return results


def _records(target: Path | None, robot: Path | None) -> list[tuple[Path, str | None]]:
    """The records meant, each with the command that makes its outputs again, if not its own."""
    target = target or default_config(Path()) or Path()
    if target.is_dir():
        half = [target / name for name in interrupted(target) if name.endswith(SUFFIX)]
        whole = [] if half and not any(target.rglob(f"*{SUFFIX}")) else find_records(target)
        return _with_configs(list(dict.fromkeys([*half, *whole])), robot)
    if target.suffix.lower() == ".json":
        return _with_configs([target], robot)
    if not target.is_file():
        raise UsageError(
            f"{target}: no such file or directory",
            hint="name a config (ikgen.toml), a record, or the folder that was given to -o",
        )
    command = mending(target) if robot is None else None
    return [(path, command) for arm in load_config(target) for path in arm.records]


def _with_configs(records: Sequence[Path], robot: Path | None) -> list[tuple[Path, str | None]]:
    """Records, each with the command that makes it again where the nearest config above lists it."""

    @cache
    def listed(config: Path) -> frozenset[Path]:
        try:
            return frozenset(one.resolve() for arm in load_config(config) for one in arm.records)
        except IkgenError:  # told by whoever checks the config
            return frozenset()

    def command(record: Path) -> str | None:
        configs = (default_config(folder) for folder in record.parents)
        config = next((one for one in configs if one is not None), None)
        if config is None or record not in listed(config):
            return None
        return mending(Path(os.path.relpath(config)))

    return [(path, command(path.resolve()) if robot is None else None) for path in records]


def write_junit(path: Path, results: Sequence[Recheck]) -> None:
    """JUnit XML: one suite an output; findings that no verification holds become a suite of their own.
    Where outputs share a name their folders tell them apart."""
    from ikgen.verify.junit import write_junit_xml
    from ikgen.verify.verification_report import VerificationReport

    suites = []
    times = Counter(result.name for result in results)
    for result in results:
        apart = times[result.name] > 1
        name = (result.path.parent / result.name).as_posix() if apart else result.name
        request = result.record.request if result.record else None
        base, tip, task = (request.base, request.tip, request.task) if request else ("", "", "")
        checks = _files_checked(result)
        own = VerificationReport("outputs", base or "", tip or "", task or "", 0, 0, checks)
        suites += [(name, report) for report in (own, *result.reports.values())]
    path.parent.mkdir(parents=True, exist_ok=True)
    write_junit_xml(path, suites)


def _files_checked(result: Recheck) -> tuple[CheckResult, ...]:
    """Whether each recorded file is right, and others that findings are of: the record itself, say."""
    from ikgen.verify.verification_report import CheckResult

    wrong: dict[str, list[Finding]] = {}
    for finding in result.findings:
        place = Path(os.path.relpath(finding.file, result.path.parent)).as_posix()
        wrong.setdefault(place, []).append(finding)
    files = result.record.files if result.record else ()
    checks = []
    for name in dict.fromkeys((*files, *wrong)):
        found = wrong.get(name, [])
        detail, remedies = "; ".join(f.message for f in found), "\n".join(f.remedy for f in found)
        passed, count = not found, max(1, len(found))
        checks.append(
            CheckResult(
                f"{name} up to date", passed, count, len(found), detail=detail, worst_case=remedies
            )
        )
    return tuple(checks)
