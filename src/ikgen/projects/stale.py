"""Whether an arm's outputs are those that its config and description would give: by digests alone.

Nothing is expanded or derived, so the answer takes milliseconds and needs none of the big packages.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any

from ikgen import __version__
from ikgen.errors import BadDescriptionError
from ikgen.importers.named_robots import is_lost
from ikgen.outputs.journal import half_in_place
from ikgen.projects.check_findings import HALF_IN_PLACE
from ikgen.projects.config import ArmConfig
from ikgen.projects.entry_words import EntryWords
from ikgen.projects.recorded_inputs import Packages
from ikgen.records.codec import encode, entries_of
from ikgen.records.record import (
    Record,
    digest,
    environment_digest,
    read_record,
    record_name,
    relative_to_cwd,
)
from ikgen.records.request import Request

__all__ = ["stale_reasons", "why_stale"]


def stale_reasons(arms: Sequence[ArmConfig], *, verify: bool = True) -> list[str]:
    """`why_stale` of each arm."""
    packages = Packages()
    return [why_stale(arm, packages, verify=verify) for arm in arms]


def why_stale(arm: ArmConfig, packages: Packages | None = None, *, verify: bool = True) -> str:
    """The reason to generate the arm again; empty where its outputs are fresh. With `verify` outputs
    that were never verified are not."""
    paths = arm.records
    if half_in_place(arm.outputs.out / record_name(arm.name)):
        return HALF_IN_PLACE
    if not paths[0].is_file():
        lost = f", and {arm.request.robot} is not there" if is_lost(arm.request.robot) else ""
        return f"not generated yet{lost}"
    try:
        records = [read_record(path) for path in paths]
    except BadDescriptionError as error:
        return error.message
    reasons = (_outdated(arm, record, packages or Packages()) for record in records)
    found = next(filter(None, reasons), "") or _changed_outputs(arm, records)
    if not found and verify and not all(record.verified for record in records):
        return "not verified yet"
    return found


def _outdated(arm: ArmConfig, record: Record, packages: Packages) -> str:
    """What differs of a record from what it would be."""
    if record.version != __version__:
        return f"made by ikgen {record.version}; this is {__version__}"
    return _changed_options(arm.request, record.given) or _changed_files(record, packages)


def _changed_options(now: Request, was: Request) -> str:
    """The first option that differs from the one recorded."""
    for name in entries_of(Request):
        pair = [encode(getattr(request, name), os.path.realpath) for request in (was, now)]
        if pair[0] != pair[1]:
            return f"'{name}' was {_shown(pair[0])}, is {_shown(pair[1])}"
    return ""


def _changed_outputs(arm: ArmConfig, records: Sequence[Record]) -> str:
    """Whether other outputs are asked for than the records have."""
    was = [name for record in records for name in record.emit]
    now = list(arm.outputs.emit)
    return "" if set(was) == set(now) else f"'emit' was {_shown(was)}, is {_shown(now)}"


def _changed_files(record: Record, packages: Packages) -> str:
    """The first file, read or written, or variable that differs from the one recorded."""
    for file in packages.inputs(record):
        actual = digest(file.path)
        if actual is None:
            return f"{file.name} is not there"
        if actual != file.sha256:
            return f"{file.name} has changed"
    for name, was in record.environment.items():
        if environment_digest(os.environ.get(name)) != was:
            return f"the environment variable {name}, which the description reads, has changed"
    for name, expected in record.files.items():
        path = relative_to_cwd(record.folder / name)
        actual = digest(path)
        if actual is None:
            return f"{path} is not there"
        if actual != expected:
            return f"{path} was edited"
    return ""


def _shown(value: Any) -> str:
    """A value as a config has it."""
    if value in (None, {}, []):
        return "not given"
    words = EntryWords()
    if isinstance(value, dict) and None in value.values():
        value = [name if x is None else f"{name} = {x}" for name, x in value.items()]
    if isinstance(value, dict):
        return words.table({name: str(x) for name, x in value.items()})
    return words.names(value) if isinstance(value, list) else f"{value}"
