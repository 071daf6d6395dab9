"""The arms whose outputs lie in a folder without a config: their records say what was asked for."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

from ikgen.errors import UsageError
from ikgen.importers.named_robots import is_lost
from ikgen.projects.config import ArmConfig, load_config
from ikgen.records.record import find_records, read_record, records_of
from ikgen.records.request import Outputs

__all__ = ["ROBOT_NOW", "arms_below", "has_lost_robot", "listed_arms"]


ROBOT_NOW = "--robot FILE (the description, where it is now)"
"""What to add to a command for outputs that were moved away from their description."""


def arms_below(folder: Path) -> tuple[ArmConfig, ...]:
    """Every arm that was generated into a folder or one below it, in the order of the records' paths;
    raises `UsageError` where there is none."""
    arms: dict[tuple[Path, str], ArmConfig] = {}
    for path in find_records(folder):
        record = read_record(path)
        out = record.out or record.folder
        if (out, record.name) not in arms:
            names = [name for one in records_of(out, record.name) for name in read_record(one).emit]
            outputs = Outputs(emit=tuple(names), out=out)
            arms[out, record.name] = ArmConfig(record.given, outputs)
    return tuple(arms.values())


def listed_arms(path: Path, robot: Path | None = None) -> tuple[ArmConfig, ...]:
    """The arms of a config, or of the records below a folder, as `named_config` gives them; the latter of
    another description, `robot`, where that is not any more where they name it.

    Raises `UsageError` for a `robot` beside a config, or where the records name several.
    """
    if robot is None:
        return arms_below(path) if path.is_dir() else load_config(path)
    if not path.is_dir():
        hint = f"change it in {path.as_posix()}"
        raise UsageError("--robot is of outputs without a config, which names its own", hint=hint)
    arms = arms_below(path)
    if len({arm.request.robot.resolve() for arm in arms}) > 1:
        what = f"--robot: the outputs below '{path}' are of several descriptions"
        raise UsageError(what, hint="name the folder of one of them")
    return tuple(replace(arm, request=replace(arm.request, robot=robot)) for arm in arms)


def has_lost_robot(path: Path, arm: ArmConfig) -> bool:
    """Whether an arm of a folder's records has no description where they name it, as of outputs that were
    moved alone."""
    return path.is_dir() and is_lost(arm.request.robot)
