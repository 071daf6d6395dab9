"""Outputs of the same name that are in the folder already: whose they are, and which languages they
hold."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from ikgen.errors import BadDescriptionError, UsageError
from ikgen.model.module_name import identifier
from ikgen.outputs.publish import is_generated
from ikgen.outputs.written_list import check_written, digests_listed, recorded
from ikgen.records.record import Record, digest, read_record, records_of

if TYPE_CHECKING:
    from ikgen.emit.derivation import Reading
    from ikgen.records.request import Request

__all__ = ["Earlier", "earlier_outputs"]


@dataclass(frozen=True, slots=True)
class _Difference:
    """Whose outputs are, in words; `chain`: those of another chain of the robot."""

    words: str
    chain: bool = False


@dataclass(frozen=True, slots=True)
class Earlier:
    """What was generated before by the name that outputs are to have; `broken` are records that cannot be
    read."""

    name: str
    records: tuple[Record, ...] = ()
    broken: tuple[Path, ...] = ()

    @property
    def emit(self) -> tuple[str, ...]:
        """Names of the outputs, each once."""
        return tuple(dict.fromkeys(name for record in self.records for name in record.emit))

    def check(self, request: Request, reading: Reading, task: str | None) -> None:
        """Raises `UsageError` where the outputs are of another robot, chain or task (None: not known
        yet)."""
        for path in self.broken:
            raise self._refused(path, "is no record of ikgen, or a broken one", reading)
        for record in self.records:
            whose = _difference(record, request, reading, task)
            if whose is not None:
                raise self._refused(
                    record.path, f"has outputs of {whose.words}", reading, chain=whose.chain
                )

    def _refused(
        self, path: Path, what: str, reading: Reading, *, chain: bool = False
    ) -> UsageError:
        other = f"{self.name}_{identifier(reading.dh.tip_link)}"
        by_tip = chain and not self.name.endswith(other[len(self.name) :])
        new = f"--name {other}" if by_tip else "--name NAME"
        return UsageError(
            f"{path} {what}",
            hint=f"write beside it with {new}, elsewhere with -o DIR, or replace it with --force",
        )

    def check_files(self, out: Path, texts: Mapping[str, str], *, edited: bool = False) -> None:
        """Raises `UsageError` where a file that would be replaced is another's, or not as ikgen wrote it,
        unless it may be `edited`; `texts`: what is to be written, by name in the folder `out`."""
        wrote: dict[Path, set[str]] = digests_listed(out, f"{self.name}_report")
        for path, digests in recorded(out, self.name).items():
            wrote.setdefault(path, set()).update(digests)
        own = {path.resolve() for path in (*(record.path for record in self.records), *self.broken)}
        if not edited:
            check_written(out, texts, wrote, own)
            return
        own |= wrote.keys() | {path.resolve() for name in texts if is_generated(path := out / name)}
        check_written(out, texts, wrote, own, "or give the arm another `out` or `name`")

    def outdated(self, files: Collection[Path]) -> list[Path]:
        """Recorded files that are as they were written and not among the new ones (records included)."""
        kept = {path.resolve() for path in files}
        known = [
            path
            for record in self.records
            for name, expected in record.files.items()
            if digest(path := record.folder / name) == expected
        ]
        known += [record.path for record in self.records]
        return [path for path in known if path.resolve() not in kept]


def earlier_outputs(out: Path, name: str) -> Earlier:
    """What is in a folder by that name."""
    records, broken = [], []
    for path in records_of(out, name):
        try:
            records.append(read_record(path))
        except BadDescriptionError:
            broken.append(path)
    return Earlier(name, tuple(records), tuple(broken))


def _difference(
    record: Record, request: Request, reading: Reading, task: str | None
) -> _Difference | None:
    """Whose the recorded outputs are, if not this request's. A task that was left to ikgen both times may
    have become another one with the description."""
    was, dh = record.request, reading.dh
    if record.source_sha256 != reading.source.sha256:
        if was.robot.resolve() != request.robot.resolve():
            return _Difference(f"another robot, {was.robot}")
        if dict(was.args) != dict(request.args):
            given = " ".join(f"{name}:={text}" for name, text in was.args.items())
            return _Difference(f"another robot, {was.robot} with {given or 'no arguments'}")
    if (was.base, was.tip) != (dh.base_link, dh.tip_link):
        return _Difference(f"another chain, {was.base} -> {was.tip}", chain=True)
    changed = _changed(was, request)
    if changed:
        return _Difference(f"the arm {changed}")
    if task is not None and was.task != task and record.asked.task != request.task:
        return _Difference(f"another task, {was.task}")
    return None


def _changed(was: Request, request: Request) -> str:
    """What another request made of the same chain: joints that move otherwise, or a calibration."""
    if dict(was.lock) != dict(request.lock):
        locked = " ".join(f"{name}={value!r}" for name, value in was.lock.items())
        return f"with {locked} locked" if locked else "with no joint locked"
    if dict(was.couple) != dict(request.couple):
        coupled = " ".join(f"{name}={text}" for name, text in was.couple.items())
        return f"with {coupled} coupled" if coupled else "with no joint coupled by --couple"
    files = [one.calibration and one.calibration.resolve() for one in (was, request)]
    if files[0] != files[1]:
        return f"calibrated by {was.calibration}" if was.calibration else "without a calibration"
    return ""
