"""The config that lists a package's arms: `ikgen.toml`, or `[tool.ikgen]` in pyproject.toml."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from ikgen.errors import BadDescriptionError, IkgenError, UsageError
from ikgen.importers.merge_conflict import conflict_or
from ikgen.importers.named_robots import is_named
from ikgen.importers.toml_text import parse_toml
from ikgen.model.module_name import identifier
from ikgen.projects.config_lines import ArmPlace, line_of
from ikgen.records.codec import CodecError, Decoder, inlined, uncoded
from ikgen.records.record import record_name, records_of
from ikgen.records.request import Outputs, Request
from ikgen.tasks import stem_and_axis

__all__ = ["ArmConfig", "default_config", "load_config", "named_config"]

CONFIG = "ikgen.toml"
PYPROJECT = "pyproject.toml"


@dataclass(frozen=True, slots=True)
class ArmConfig:
    """One `[[arm]]`: what it asks for and what is written; paths are those of the config joined to its
    folder. `place` is None for what no config lists."""

    request: Request = field(metadata=inlined())
    outputs: Outputs = field(metadata=inlined())
    place: ArmPlace | None = field(default=None, metadata=uncoded())

    @property
    def name(self) -> str:
        """The prefix of the outputs."""
        assert self.request.name is not None
        return self.request.name

    @property
    def records(self) -> list[Path]:
        """The records of the outputs; where one would lie beside them, if there are none."""
        beside = self.outputs.out / record_name(self.name)
        return records_of(self.outputs.out, self.name) or [beside]


def default_config(folder: Path) -> Path | None:
    """The config of a folder: its ikgen.toml, or a pyproject.toml with `[tool.ikgen]`."""
    if (folder / CONFIG).is_file():
        return folder / CONFIG
    project = folder / PYPROJECT
    if not project.is_file():
        return None
    # what is not UTF-8 is told where it is loaded
    text = project.read_text("utf-8", errors="replace")
    return project if re.search(r"^\[+\s*tool\.ikgen", text, re.M) else None


def named_config(path: Path | None) -> Path:
    """The config that a command means: a file, that of a folder, or the one here; a folder that is named
    and has none is meant itself."""
    if path is not None and not path.is_dir():
        return path
    found = default_config(path or Path()) or path
    if found is None:
        raise UsageError("no ikgen.toml here", hint="name the config: ikgen build CONFIG")
    return found


def load_config(path: Path) -> tuple[ArmConfig, ...]:
    """The arms of a config, in its order; raises `BadDescriptionError` naming the entry and its line."""
    text = _text(path)
    data = _tables(path, text)
    decoder = Decoder(lambda text: Path(text) if is_named(text) else path.parent / text, True)
    try:
        for key in set(data) - {"arm"}:
            raise CodecError(key, f"unknown entry '{key}'", "there is: arm")
        tables = data.get("arm", [])
        if not isinstance(tables, list) or not tables:
            hint = (
                "write [[arm]], in two brackets"
                if tables
                else "add a table [[arm]] with name and robot"
            )
            raise _error(path, "lists no arm", hint=hint)
        arms = [(i, arm) for i, table in enumerate(tables) for arm in _arms(decoder, table, i)]
        _check_places(arms)
    except CodecError as error:
        raise _error(path, str(error), line=line_of(text, error.where), hint=error.hint) from None
    return tuple(replace(arm, place=ArmPlace(path, i)) for i, arm in arms)


def _arms(decoder: Decoder, table: Any, index: int) -> Iterator[ArmConfig]:
    """The arms of one table: of a fleet one for each calibration, named after its file."""
    files = table.get("calibration") if isinstance(table, dict) else None
    if not isinstance(files, list):
        yield _arm(decoder, table, index)
        return
    where = f"arm[{index}].calibration"
    if not files or not all(isinstance(file, str) for file in files):
        raise CodecError(
            where, f"{files!r} is no list of files", 'write ["arm_1.yaml", "arm_2.yaml"]'
        )
    for file in files:
        arm = _arm(decoder, {**table, "calibration": file}, index)
        name = f"{arm.name}_{identifier(Path(file).stem)}"
        yield replace(arm, request=replace(arm.request, name=name))


def _arm(decoder: Decoder, table: Any, index: int) -> ArmConfig:
    """One table, its `out` by default the config's folder."""
    where = f"arm[{index}]"
    if isinstance(table, dict):
        table = {"out": ".", **table}
    arm = decoder.table(ArmConfig, table, where)
    if arm.request.name is None:
        raise CodecError(where, " has no 'name'", "add name: the names of its files begin with it")
    try:
        stem_and_axis(arm.request.task or "", arm.request.tool_axis)
    except IkgenError as error:
        key = "tool_axis" if arm.request.task is None else "task"
        raise CodecError(f"{where}.{key}", error.message, error.hint) from None
    for i, folder in enumerate(arm.request.package_paths):
        if not folder.is_dir():
            hint = "name the folder that holds the package's folder"
            raise CodecError(f"{where}.package_paths[{i}]", f"no such directory: {folder}", hint)
    return arm


def _check_places(arms: Sequence[tuple[int, ArmConfig]]) -> None:
    """No two arms, each with the index of its table, may have the same outputs."""
    seen: set[tuple[Path, str]] = set()
    for index, arm in arms:
        folder, name = place = arm.outputs.out, arm.name
        if place in seen:
            raise CodecError(
                f"arm[{index}].name", f"two arms named '{name}' in '{folder}'", "rename one of them"
            )
        seen.add(place)


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except FileNotFoundError:
        hint = "write one: `name`, `robot` under [[arm]]; ikgen init ROBOT does"
        raise _error(path, "no such file", hint=hint) from None
    except (OSError, UnicodeDecodeError) as error:
        raise _error(path, str(error), hint="save it as UTF-8 text that can be read") from None


def _tables(path: Path, text: str) -> dict[str, Any]:
    """The `ikgen` part of the file."""
    try:
        data = parse_toml(text)
    except ValueError as error:
        place = re.search(r"line (\d+)", str(error))
        line = int(place.group(1)) if place else text.count("\n") + 1  # at the end
        hint = (
            "correct it there, or name another file: an ikgen.toml, a pyproject.toml, or a folder"
        )
        raise _error(path, f"not TOML: {error}", line=line, hint=conflict_or(text, hint)) from None
    if path.name != PYPROJECT:
        return data
    tools = data.get("tool")
    found = tools.get("ikgen") if isinstance(tools, dict) else None
    if not isinstance(found, dict):
        raise _error(path, "has no [tool.ikgen]", hint="add [[tool.ikgen.arm]] tables")
    return found


def _error(path: Path, message: str, *, line: int | None = None, hint: str) -> BadDescriptionError:
    return BadDescriptionError(message, file=str(path), line=line, hint=hint)
