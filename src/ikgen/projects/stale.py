"""Whether an arm's outputs are those that its config and description would give: by digests alone.

Nothing is expanded or derived, so the answer takes milliseconds and needs none of the big packages.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from ikgen import __version__
from ikgen.errors import BadDescriptionError
from ikgen.generation.record import Record, digest, read_record, seen
from ikgen.projects.config import ArmConfig
from ikgen.projects.recorded_inputs import Packages

__all__ = ["stale_reasons", "why_stale"]


def stale_reasons(arms: Sequence[ArmConfig], *, verify: bool = True) -> list[str]:
    """`why_stale` of each arm."""
    packages = Packages()
    return [why_stale(arm, packages, verify=verify) for arm in arms]


def why_stale(arm: ArmConfig, packages: Packages | None = None, *, verify: bool = True) -> str:
    """The reason to generate the arm again; empty where its outputs are fresh. With `verify` outputs
    that were never verified are not."""
    if not arm.record_path.is_file():
        return "not generated yet"
    try:
        record = read_record(arm.record_path)
    except BadDescriptionError as error:
        return error.message
    if record.version != __version__:
        return f"made by ikgen {record.version}; this is {__version__}"
    changed = _changed_options(arm, record) or _changed_files(record, packages or Packages())
    return changed or ("not verified yet" if verify and not record.verified else "")


def _changed_options(arm: ArmConfig, record: Record) -> str:
    """The first option that differs from the one recorded."""
    paths = [_resolved(path) for path in arm.package_paths]
    pairs = {
        "robot": (_resolved(record.robot), _resolved(arm.robot)),
        "base": (record.asked.get("base"), arm.base),
        "tip": (record.asked.get("tip"), arm.tip),
        "task": (record.asked.get("task"), arm.task),
        "args": (dict(record.args), dict(arm.args)),
        "free": (dict(record.free), dict(arm.free)),
        "lock": (dict(record.lock), dict(arm.lock)),
        "package_paths": ([_resolved(path) for path in record.package_paths], paths),
        "emit": (list(record.emit), list(arm.emit)),
    }
    for name, (was, now) in pairs.items():
        if was != now:
            return f"'{name}' was {_shown(was)}, is {_shown(now)}"
    return ""


def _changed_files(record: Record, packages: Packages) -> str:
    """The first file, read or written, whose content differs from the one recorded."""
    for file in packages.inputs(record):
        actual = digest(file.path)
        if actual is None:
            return f"{file.name} is not there"
        if actual != file.sha256:
            return f"{file.name} has changed"
    for name, expected in record.files.items():
        path = seen(record.folder / name)
        actual = digest(path)
        if actual is None:
            return f"{path} is not there"
        if actual != expected:
            return f"{path} was edited"
    return ""


def _resolved(path: Path) -> str:
    return os.path.realpath(path)


def _shown(value: object) -> str:
    return "not given" if value in (None, {}, []) else f"{value}"
