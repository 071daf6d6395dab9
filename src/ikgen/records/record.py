"""Records (`<name>_ik.json`): beside outputs, or inside their package, what they were made from, and how.

Here alone is said what a record holds: `Record` is the format, `ikgen.records.codec` reads and writes
it.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

from ikgen.errors import BadDescriptionError, UsageError
from ikgen.importers.merge_conflict import conflict_or
from ikgen.importers.named_robots import is_named
from ikgen.records.codec import CodecError, Decoder, coded, encode, inlined, read_free, uncoded
from ikgen.records.request import Request

__all__ = [
    "GENERATOR",
    "SUFFIX",
    "Asked",
    "Record",
    "digest",
    "environment_digest",
    "find_records",
    "read_record",
    "record_name",
    "record_text",
    "records_of",
    "relative_to_cwd",
    "seen_from",
]

GENERATOR = "ikgen"
SUFFIX = "_ik.json"
_AGAIN = f"generate the outputs again; *{SUFFIX} is for records alone"


@dataclass(frozen=True, slots=True)
class Asked:
    """What of a request was left to ikgen (None), as the user gave it."""

    base: str | None = None
    tip: str | None = None
    task: str | None = None
    free: Mapping[str, float | None] | None = field(default=None, metadata=coded(read_free))
    tool_axis: str | None = None


@dataclass(frozen=True, slots=True)
class Record:
    """One record: a request with every choice said, and what came of it.

    Its paths are relative to the record's folder in the file, and as seen from the current directory here.
    `out` is the folder that was given for the outputs: the record's own, or the one around it for a
    package. `inputs` (relative path or `package://` URL -> SHA-256) are read by `recorded_inputs`; `files`
    (path relative to the record's folder -> SHA-256) are the outputs; `environment` is what the description
    asked of the environment, as `environment_digest` gives it; `verified` is false after
    `--no-verify`. `path` is the record's file.
    """

    generator: str
    version: str
    request: Request = field(metadata=inlined())
    source_sha256: str
    asked: Asked
    emit: tuple[str, ...]
    verified: bool
    joints: tuple[str, ...]
    max_solutions: int
    inputs: Mapping[str, str]
    files: Mapping[str, str]
    out: Path | None = None
    environment: Mapping[str, str] = field(default_factory=dict)
    path: Path = field(default=Path(), metadata=uncoded())

    @property
    def folder(self) -> Path:
        """Where the record lies."""
        return self.path.parent

    @property
    def name(self) -> str:
        """The prefix of the outputs."""
        assert self.request.name is not None
        return self.request.name

    @property
    def given(self) -> Request:
        """The request as the user gave it."""
        free = self.request.free if self.asked.free is None else self.asked.free
        asked = self.asked
        ends = replace(self.request, base=asked.base, tip=asked.tip, free=free)
        return replace(ends, task=asked.task, tool_axis=asked.tool_axis)

    def again(self, robot: Path | None = None) -> Request:
        """The request that makes the outputs again, for its own or another description."""
        request = self.request if robot is None else replace(self.request, robot=robot)
        return replace(request, base=None, tip=None) if request.table else request

    def command(self, robot: Path | None = None) -> str:
        """The command that makes the outputs again."""
        out = str(self.out or self.folder)
        return self.again(robot).command("--emit", ",".join(self.emit), "-o", out)


def record_name(name: str) -> str:
    """The file name of an arm's records."""
    return f"{name}{SUFFIX}"


def record_text(record: Record) -> str:
    """The text of a record; paths relative to its folder, with slashes on every system."""
    return json.dumps(encode(record, lambda path: seen_from(path, record.folder)), indent=2) + "\n"


def digest(path: Path) -> str | None:
    """SHA-256 of a file's bytes; None where it cannot be read."""
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError:
        return None


def environment_digest(value: str | None) -> str:
    """SHA-256 of an environment variable's value, which may be a secret; "" where it is not set."""
    return "" if value is None else hashlib.sha256(value.encode("utf-8", "replace")).hexdigest()


def find_records(folder: Path) -> list[Path]:
    """All files below a folder that are named as records, hidden folders left out; what is none is told as
    it is read. Raises `UsageError` where none is."""
    found = [
        path
        for path in sorted(folder.rglob(f"*{SUFFIX}"))
        if not any(part.startswith(".") for part in path.relative_to(folder).parts[:-1])
    ]
    if not found:
        raise UsageError(
            f"no outputs of ikgen below '{folder}' (no *{SUFFIX})",
            hint="name the folder that was given to -o, or a config (ikgen.toml)",
        )
    return found


def records_of(out: Path, name: str) -> list[Path]:
    """The records of the outputs `name` that were written to a folder: beside them, and in their
    packages."""
    beside = out / record_name(name)
    inside = [path for path in sorted(out.glob(f"*/{record_name(name)}")) if _is_of(path, out)]
    return [*([beside] if beside.is_file() else []), *inside]


def _is_of(path: Path, out: Path) -> bool:
    """Whether a record in a folder of `out` is that of a package written there."""
    try:
        record = read_record(path)
    except BadDescriptionError:
        return False
    return record.out is not None and record.out.resolve() == out.resolve()


def read_record(path: Path) -> Record:
    """The record in a file; raises `BadDescriptionError` for a file that is none."""
    text = ""
    try:
        text = path.read_text(encoding="utf-8")
        data = json.loads(text)
        folder = path.parent
        decoder = Decoder(lambda x: Path(x) if is_named(x) else relative_to_cwd(folder / x))
        record = decoder.table(Record, data, "the record")
        if record.request.name is None:
            raise CodecError("the record", " has no 'name'", _AGAIN)
        if record.generator != GENERATOR:
            raise CodecError(
                "the record.generator", f"'{record.generator}' is not '{GENERATOR}'", _AGAIN
            )
    except OSError as error:
        raise BadDescriptionError(
            error.strerror or str(error), file=str(path), hint="generate it first (ikgen build)"
        ) from None
    except (ValueError, RecursionError, CodecError) as error:
        hint = conflict_or(text, _AGAIN)
        raise BadDescriptionError(
            f"not a record of ikgen: {error}", file=str(path), hint=hint
        ) from None
    return replace(record, path=path)


def relative_to_cwd(path: Path) -> Path:
    """A path as short as it can be from the current directory."""
    whole = path.resolve()
    here = Path.cwd()
    return whole.relative_to(here) if whole.is_relative_to(here) else whole


def seen_from(path: Path, folder: Path) -> str:
    """A path as a file in a folder has it, with slashes on every system; a robot's name as it is."""
    if is_named(path):
        return str(path)
    return Path(os.path.relpath(path.resolve(), folder.resolve())).as_posix()
