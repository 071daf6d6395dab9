"""The arms whose outputs lie in a folder without a config: their records say what was asked for."""

from __future__ import annotations

from pathlib import Path

from ikgen.generation.record import find_records, read_record, records_of
from ikgen.generation.request import Outputs
from ikgen.projects.config import ArmConfig, load_config

__all__ = ["arms_below", "listed_arms"]


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


def listed_arms(path: Path) -> tuple[ArmConfig, ...]:
    """The arms of a config, or of the records below a folder, as `named_config` gives them."""
    return arms_below(path) if path.is_dir() else load_config(path)
