"""The record beside the outputs (`<name>_ik.json`): what they were made from, and how."""

from __future__ import annotations

import hashlib
import json
import shlex
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ikgen.errors import BadDescriptionError, UsageError

__all__ = ["SUFFIX", "Record", "digest", "find_records", "read_record", "seen"]

SUFFIX = "_ik.json"


@dataclass(frozen=True, slots=True)
class Record:
    """One record. `path` is its file; `robot` and `package_paths` are as seen from the current
    directory. `inputs` (path relative to the record's folder or `package://` URL -> SHA-256) is read
    by `recorded_inputs`; `files` (name -> SHA-256) are relative to the record's folder; `asked`
    are base, tip and task as the user gave them (or did not); `verified` is false after `--no-verify`.
    """

    path: Path
    version: str
    name: str
    robot: Path
    source_sha256: str
    base: str
    tip: str
    task: str
    free: Mapping[str, float | None]
    lock: Mapping[str, float]
    args: Mapping[str, str]
    package_paths: tuple[Path, ...]
    asked: Mapping[str, str | None]
    emit: tuple[str, ...]
    verified: bool
    joints: tuple[str, ...]
    max_solutions: int
    inputs: Mapping[str, str]
    files: Mapping[str, str]

    @property
    def folder(self) -> Path:
        """Where the outputs lie."""
        return self.path.parent

    def command(self, robot: Path | None = None) -> str:
        """The command that makes the outputs again."""
        source = robot or self.robot
        words = ["ikgen", "from-dh" if source.suffix == ".toml" else "from-urdf", str(source)]
        if source.suffix != ".toml":
            words += ["--base", self.base, "--tip", self.tip]
        words += ["--task", self.task, "--name", self.name]
        for joint, value in self.free.items():
            words += ["--free", joint if value is None else f"{joint}={value!r}"]
        for joint, value in self.lock.items():
            words += ["--lock", f"{joint}={value!r}"]
        for name, text in self.args.items():
            words += ["--arg", f"{name}:={text}"]
        for folder in self.package_paths:
            words += ["--package-path", str(folder)]
        words += ["--emit", ",".join(self.emit), "-o", str(self.folder)]
        return shlex.join(words)


def digest(path: Path) -> str | None:
    """SHA-256 of a file's bytes; None where it cannot be read."""
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except OSError:
        return None


def find_records(folder: Path) -> list[Path]:
    """All records below a folder, hidden folders left out; raises `UsageError` where none is."""
    found = [
        path
        for path in sorted(folder.rglob(f"*{SUFFIX}"))
        if not any(part.startswith(".") for part in path.relative_to(folder).parts[:-1])
        and is_record(path)
    ]
    if not found:
        raise UsageError(
            f"no outputs of ikgen below '{folder}' (no *{SUFFIX})",
            hint="name the folder that was given to -o, or a config (ikgen.toml)",
        )
    return found


def is_record(path: Path) -> bool:
    """Whether a JSON file is a record; a broken one counts, so that it is told."""
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return True
    return isinstance(data, dict) and data.get("generator") == "ikgen"


def read_record(path: Path) -> Record:
    """The record in a file; raises `BadDescriptionError` for a file that is none."""
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
        return _record(path, data)
    except OSError as error:
        raise BadDescriptionError(
            error.strerror or str(error), file=str(path), hint="generate it first (ikgen build)"
        ) from None
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        what = f"lacks {error}" if isinstance(error, KeyError) else str(error)
        raise BadDescriptionError(
            f"not a record of ikgen: {what}", file=str(path), hint="generate the outputs again"
        ) from None


def _record(path: Path, data: Mapping[str, Any]) -> Record:
    folder = path.parent
    return Record(
        path=path,
        version=str(data["version"]),
        name=str(data["name"]),
        robot=seen(folder / data["robot"]),
        source_sha256=str(data["source_sha256"]),
        base=str(data["base"]),
        tip=str(data["tip"]),
        task=str(data["task"]),
        free=dict(data["free"]),
        lock={name: float(value) for name, value in data["lock"].items()},
        args=dict(data["args"]),
        package_paths=tuple(seen(folder / p) for p in data["package_paths"]),
        asked=dict(data["asked"]),
        emit=tuple(data["emit"]),
        verified=bool(data["verified"]),
        joints=tuple(data["joints"]),
        max_solutions=int(data["max_solutions"]),
        inputs={name: str(value) for name, value in data["inputs"].items()},
        files=dict(data["files"]),
    )


def seen(path: Path) -> Path:
    """A path as short as it can be from the current directory."""
    whole = path.resolve()
    here = Path.cwd()
    return whole.relative_to(here) if whole.is_relative_to(here) else whole
