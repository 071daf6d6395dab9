"""Outputs in the folders of a config that none of its arms makes: of one that was renamed or left out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from ikgen.errors import BadDescriptionError
from ikgen.projects.config import ArmConfig
from ikgen.records.record import SUFFIX, Record, read_record, relative_to_cwd

__all__ = ["LeftOutputs", "left_outputs"]


@dataclass(frozen=True, slots=True)
class LeftOutputs:
    """What the records of the arm `name` have that is still there, and these records."""

    name: str
    files: tuple[Path, ...]


def left_outputs(arms: Sequence[ArmConfig]) -> list[LeftOutputs]:
    """By the records beside the arms' outputs and in their packages; those that cannot be read tell
    nothing."""
    made = {(arm.outputs.out.resolve(), arm.name) for arm in arms}
    records = (path for arm in arms for path in arm.records)
    own = {file.resolve() for path in records for file in _written(path, _record(path))}
    left: dict[tuple[Path, str], list[Path]] = {}
    for out in sorted({place for place, _ in made}):
        for path in sorted([*out.glob(f"*{SUFFIX}"), *out.glob(f"*/*{SUFFIX}")]):
            record = _record(path)
            if record is None:
                continue
            place = (record.out or record.folder).resolve(), record.name
            if place[0] == out and place not in made:
                files = [one for one in _written(path, record) if one.resolve() not in own]
                left.setdefault(place, []).extend(files)
    return [
        LeftOutputs(name, tuple(map(relative_to_cwd, files))) for (_, name), files in left.items()
    ]


def _record(path: Path) -> Record | None:
    try:
        return read_record(path)
    except BadDescriptionError:
        return None


def _written(path: Path, record: Record | None) -> list[Path]:
    """The files of a record that are there, and it; nothing of one that cannot be read."""
    if record is None:
        return []
    return [*(file for name in record.files if (file := record.folder / name).is_file()), path]
