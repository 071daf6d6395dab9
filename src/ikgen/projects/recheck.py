"""Check outputs against their description as it is now."""

from __future__ import annotations

import shlex
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from ikgen.derivation.progress import Progress, silent
from ikgen.derivation.read import read
from ikgen.errors import BadDescriptionError, UnknownNameError, UsageError
from ikgen.generation.emitters import solver_files
from ikgen.importers.named_robots import is_lost, is_named
from ikgen.outputs.journal import half_in_place
from ikgen.outputs.publish import left_over
from ikgen.processes.executors import Workers
from ikgen.projects.check_findings import HALF_IN_PLACE, Finding, Recheck
from ikgen.projects.output_checks import Checked, OutputChecks
from ikgen.projects.recorded_arms import ROBOT_NOW
from ikgen.projects.recorded_inputs import Packages
from ikgen.projects.sample_blocks import BLOCK, SampleBlock, blocks_checked
from ikgen.records.record import Record, digest
from ikgen.records.request import Outputs

if TYPE_CHECKING:
    from ikgen.emit.derivation import Reading

__all__ = ["recheck"]


def recheck(
    record: Record,
    *,
    robot: Path | None = None,
    command: str | None = None,
    samples: int = 1000,
    seed: int = 0,
    trust: bool = False,
    workers: Workers | None = None,
    progress: Progress = silent,
    done: Callable[[int, int], None] = lambda ready, total: None,
) -> Recheck:
    """Expand the description again and check every output against it.

    `command` is what to type to put things right (default: the command that made the outputs); `workers`
    take part where there are many samples, and `done` is told how many of their blocks are ready.
    Raises `IkgenError` where the description cannot be read.
    """
    made = record.command(robot)
    forced = command or f"{made} --force"
    fix = command or (made if robot is None else forced)  # they may be of another robot
    request = replace(record.again(robot), trust=trust)
    if robot is None and is_lost(request.robot):
        raise _gone(record, request.robot, command)
    findings = [*_edited(record, forced), *_left_over(record)]
    progress("read", str(request.robot))
    try:
        reading = read(request)
    except (UnknownNameError, UsageError) as error:
        if not (is_named(request.robot) or request.robot.is_file()):
            raise
        message = f"made from another description: {error.message}"
        look = f"ikgen inspect {shlex.quote(str(request.robot))}"
        listed = f"change its entry in the config, then {command}: {error.hint}" if command else ""
        lost = Finding(record.path, message, "" if listed else look, hint=listed)
        return Recheck(record.path, record, (*findings, lost))
    block = SampleBlock(record.path, robot, trust, fix, samples, seed)
    run = _Run(block, workers or Workers(), progress, done)
    found = _checked(record, reading, run)
    return replace(found, findings=(*findings, *found.findings))


def _gone(record: Record, robot: Path, command: str | None) -> BadDescriptionError:
    """That the description is not where the outputs were made from it; `command`: of a config's."""
    folder = shlex.quote(record.folder.as_posix())
    hint = f"ikgen verify {folder} {ROBOT_NOW}"
    if command is not None:
        hint = f"name where it is by robot in the config, then {command}; or {hint}"
    return BadDescriptionError("no such file", file=str(robot), hint=hint)


def _edited(record: Record, fix: str) -> list[Finding]:
    """Outputs that are gone, half in place, or differ from what was written."""
    found = []
    if half_in_place(record.path, record.out):
        found.append(Finding(record.path, HALF_IN_PLACE, fix))
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
    hint = f"remove it, or generate again with --emit {','.join(record.emit)},..."
    solvers = (record.folder / name for name in solver_files(record.name))
    found = left_over(solvers, [record.folder / name for name in record.files])
    return [Finding(path, message, hint=hint) for path in found]


@dataclass(frozen=True, slots=True)
class _Run:
    """What is to be run, and by whom."""

    block: SampleBlock
    workers: Workers
    progress: Progress
    done: Callable[[int, int], None]

    def checked(self, record: Record, reading: Reading) -> Checked:
        """All samples of the outputs."""
        block = self.block
        outputs = Outputs(samples=min(block.samples, BLOCK), seed=block.seed)
        first = OutputChecks(record, reading, block.fix, outputs, self.progress).run()
        return blocks_checked(first, block, self.workers, self.done)


_TEXT = "the text of the description"
_EARLIER = "made from an earlier description"


def _changed_files(record: Record) -> str:
    """The recorded inputs that are not as they were; "" where none is, as of other arguments."""
    inputs = Packages().inputs(record)
    return ", ".join(one.name for one in inputs if digest(one.path) != one.sha256)


def _checked(record: Record, reading: Reading, run: _Run) -> Recheck:
    """One record against what was read now."""
    dh, fix = reading.dh, run.block.fix
    changed = reading.source.sha256 != record.source_sha256
    notes = (f"{_changed_files(record) or _TEXT} has changed since",) if changed else ()
    joints = tuple(joint.name for joint in dh.joints)
    if joints != record.joints:
        was, now = ", ".join(record.joints), ", ".join(joints)
        message = f"made for other joints: {was}; the description has {now}"
        return Recheck(record.path, record, (Finding(record.path, message, fix),), notes)
    if dh.symbols:
        missing = Finding(
            record.path,
            f"not checked: no numbers for {dh.symbol_words}",
            exit_code=2,
            hint="give them, by the table's names, under [parameters] of "
            f"{record.request.robot}, then {fix}",
        )
        # what cannot run cannot show that only a remark changed
        old = Finding(record.path, _EARLIER, fix)
        return Recheck(record.path, record, (old, missing) if changed else (missing,), notes)
    found = run.checked(record, reading)
    findings = found.findings
    if changed and not findings and not found.reports:
        findings = (Finding(record.path, _EARLIER, fix),)  # nothing ran that could show otherwise
    return Recheck(record.path, record, findings, notes, found.reports)
