"""Run recorded outputs against the description that was read now."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from ikgen.errors import BadDescriptionError, IkgenError, VerificationError
from ikgen.generation.emitted_arm import EmittedArm
from ikgen.projects.check_findings import Finding
from ikgen.projects.forward_difference import forward_difference
from ikgen.tasks import POSE
from ikgen.verify.shared_work import SharedWork

if TYPE_CHECKING:
    from ikgen.derivation.progress import Progress
    from ikgen.emit.derivation import Reading
    from ikgen.generation.emitters import Emitter
    from ikgen.generation.runners_ahead import RunnersAhead
    from ikgen.records.record import Record
    from ikgen.records.request import Outputs
    from ikgen.verify.oracle import Oracle
    from ikgen.verify.runners.runner import Runner
    from ikgen.verify.verification_report import VerificationReport

__all__ = ["Checked", "OutputChecks"]


@dataclass(frozen=True, slots=True)
class Checked:
    """What came of running outputs: findings, and the verification of each that could run."""

    findings: tuple[Finding, ...] = ()
    reports: Mapping[str, VerificationReport] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class OutputChecks:
    """The outputs of a record; `fix` is the command that makes them anew."""

    record: Record
    reading: Reading
    fix: str
    outputs: Outputs
    progress: Progress

    def run(self) -> Checked:
        """Run every output that can be run, what is compiled last; the first is the one that others are
        compared with."""
        from ikgen.generation.emitted_checks import oracle_for
        from ikgen.generation.runners_ahead import RunnersAhead

        findings: list[Finding] = []
        reports: dict[str, VerificationReport] = {}
        first = None
        in_turn = sorted(self.record.emit, key=_compiles)
        with RunnersAhead(partial(self._made, name) for name in in_turn) as runners:
            oracle, shared = oracle_for(self.reading), SharedWork()
            for name in in_turn:
                runner, found = self._runner(name, runners, oracle)
                if runner is not None:
                    report, found = self._report(name, runner, oracle, first, shared)
                    if report is not None:
                        reports[name] = report
                        first = first or runner
                findings += [found] if found else []
        reports = {name: reports[name] for name in self.record.emit if name in reports}
        return Checked(tuple(findings), reports)

    def _made(self, name: str) -> Runner | None:
        """What runs an output, if it can be run."""
        from ikgen.generation.emitters import find_emitter

        return find_emitter(name).runner(self._arm(), self.record.out or self.record.folder)

    def _runner(
        self, name: str, runners: RunnersAhead, oracle: Oracle
    ) -> tuple[Runner | None, Finding | None]:
        """What runs an output of the same geometry; None with what is wrong where there is none."""
        try:
            runner = runners.take()
            difference = None
            if runner is not None:
                difference = forward_difference(runner, oracle, self.reading.dh)
        except IkgenError as error:
            return None, self._failed(name, error)
        if difference is not None:
            return None, self._wrong(name, difference.words, difference.deviation)
        return runner, None

    def _report(
        self, name: str, runner: Runner, oracle: Oracle, peer: Runner | None, shared: SharedWork
    ) -> tuple[VerificationReport | None, Finding | None]:
        from ikgen.generation.emitted_checks import verify_one

        try:
            report = verify_one(
                runner, oracle, self._arm(), self.outputs, self.progress, peer=peer, shared=shared
            )
        except IkgenError as error:
            return None, self._failed(name, error)
        wrong = None if report.passed else self._wrong(name, f"is wrong: {report.worst_case}")
        return report, wrong

    def _arm(self) -> EmittedArm:
        dh, request = self.reading.dh, self.record.request
        task, most = request.task or POSE.name, self.record.max_solutions
        return EmittedArm(self.record.name, dh, task, most)

    def _failed(self, name: str, error: IkgenError) -> Finding | None:
        if isinstance(error, BadDescriptionError) and self._gone(error.file):
            return None  # the comparison with the record tells it
        if isinstance(error, BadDescriptionError | VerificationError):
            return self._wrong(name, error.message)
        # no compiler, a plug-in that fails: not the output's fault
        return Finding(self._file(name), error.message, exit_code=error.exit_code, hint=error.hint)

    def _gone(self, file: str) -> bool:
        """Whether a file is one that the record has and its folder has not."""
        paths = (self.record.folder / name for name in self.record.files)
        return any(path == Path(file) and not path.exists() for path in paths)

    def _wrong(
        self, name: str, message: str, deviation: tuple[float, float] | None = None
    ) -> Finding:
        return Finding(self._file(name), message, self.fix, deviation)

    def _file(self, emitter: str) -> Path:
        """The file to name in messages about an output."""
        known = _emitter(emitter)
        main = known.main_among(self.record.files, self.record.name) if known else None
        return self.record.path if main is None else self.record.folder / main


def _compiles(name: str) -> bool:
    """Whether an output is compiled before it is run: others are checked meanwhile."""
    known = _emitter(name)
    return known is not None and known.compiled


def _emitter(name: str) -> Emitter | None:
    """The emitter of that name; None where its package is gone or broken, which is told where it is to
    run."""
    from ikgen.generation.emitters import find_emitter

    try:
        return find_emitter(name)
    except IkgenError:
        return None
