"""The config that lists a package's arms: `ikgen.toml`, or `[tool.ikgen]` in pyproject.toml."""

from __future__ import annotations

import re
import sys
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ikgen.errors import BadDescriptionError, UsageError
from ikgen.generation.record import SUFFIX
from ikgen.model.module_name import is_module_name

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

__all__ = ["ArmConfig", "default_config", "load_config", "named_config"]

CONFIG = "ikgen.toml"
_PYPROJECT = "pyproject.toml"
_NUMBER = (int, float)


@dataclass(frozen=True, slots=True)
class ArmConfig:
    """One `[[arm]]`; paths are those of the config joined to its folder. `emit` are outputs' names,
    `free` maps held joints to their default value or None, `lock` fixed joints to their value."""

    name: str
    robot: Path
    out: Path
    base: str | None = None
    tip: str | None = None
    task: str | None = None
    args: Mapping[str, str] = field(default_factory=dict)
    free: Mapping[str, float | None] = field(default_factory=dict)
    lock: Mapping[str, float] = field(default_factory=dict)
    package_paths: tuple[Path, ...] = ()
    emit: tuple[str, ...] = ("python",)
    samples: int = 1000

    @property
    def record_path(self) -> Path:
        """Where the record of the outputs lies."""
        return self.out / f"{self.name}{SUFFIX}"


def default_config(folder: Path) -> Path | None:
    """The config of a folder: its ikgen.toml, or a pyproject.toml with `[tool.ikgen]`."""
    if (folder / CONFIG).is_file():
        return folder / CONFIG
    project = folder / _PYPROJECT
    if project.is_file() and re.search(r"^\[+\s*tool\.ikgen", project.read_text("utf-8"), re.M):
        return project
    return None


def named_config(path: Path | None) -> Path:
    """The config that a command means: a file, that of a folder, or the one here."""
    if path is not None and not path.is_dir():
        return path
    found = default_config(path or Path())
    if found is None:
        where = f"in {path}" if path is not None else "here"
        raise UsageError(f"no ikgen.toml {where}", hint="name the config: ikgen build CONFIG")
    return found


def load_config(path: Path) -> tuple[ArmConfig, ...]:
    """The arms of a config, in its order; raises `BadDescriptionError` naming the entry."""
    data = _read(path)
    tables = data.get("arm", [])
    if not isinstance(tables, list) or not tables:
        raise _error(path, "lists no arm", "add a table [[arm]] with name and robot")
    _check_keys(path, "the config", data, {"arm"})
    arms = tuple(_arm(path, index, table) for index, table in enumerate(tables, start=1))
    places = [arm.record_path for arm in arms]
    for arm in arms:
        if places.count(arm.record_path) > 1:
            raise _error(path, f"two arms named '{arm.name}' in '{arm.out}'", "rename one of them")
    return arms


def _read(path: Path) -> dict[str, Any]:
    """The `ikgen` part of the file."""
    try:
        data: dict[str, Any] = tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise _error(path, "no such file", "write one: `name`, `robot` under [[arm]]") from None
    except (OSError, UnicodeDecodeError) as error:
        raise _error(path, str(error)) from None
    except tomllib.TOMLDecodeError as error:
        raise _error(path, f"not TOML: {error}") from None
    if path.name != _PYPROJECT:
        return data
    tool = data.get("tool", {}).get("ikgen")
    if not isinstance(tool, dict):
        raise _error(path, "has no [tool.ikgen]", "add [[tool.ikgen.arm]] tables")
    return tool


def _error(path: Path, message: str, hint: str = "") -> BadDescriptionError:
    return BadDescriptionError(message, file=str(path), hint=hint)


def _check_keys(path: Path, where: str, table: Mapping[str, Any], known: set[str]) -> None:
    for key in table:
        if key not in known:
            names = ", ".join(sorted(known))
            raise _error(path, f"{where} has an unknown entry '{key}'", f"there is: {names}")


_TYPES: dict[str, tuple[type, ...]] = {
    "name": (str,),
    "robot": (str,),
    "base": (str,),
    "tip": (str,),
    "task": (str,),
    "out": (str,),
    "args": (dict,),
    "free": (dict, list),
    "lock": (dict,),
    "package_paths": (list,),
    "emit": (list,),
    "samples": (int,),
}

_WORDS: dict[type, str] = {str: "string", dict: "table", list: "list", int: "number"}


def _arm(path: Path, index: int, table: Any) -> ArmConfig:
    """One table, checked."""
    where = f"arm {index}"
    if not isinstance(table, dict):
        raise _error(path, f"{where} is no table", "write [[arm]]")
    _check_keys(path, where, table, set(_TYPES))
    for key, value in table.items():
        if not isinstance(value, _TYPES[key]):
            wanted = " or ".join(_WORDS[kind] for kind in _TYPES[key])
            raise _error(path, f"{where}: '{key}' is not a {wanted}")
    for key in ("name", "robot"):
        if key not in table:
            raise _error(path, f"{where} has no '{key}'")
    name = table["name"]
    if not is_module_name(name):
        raise _error(path, f"{where}: the name '{name}' is not an identifier")
    folder = path.parent
    return ArmConfig(
        name=name,
        robot=folder / table["robot"],
        out=folder / table.get("out", "."),
        base=table.get("base"),
        tip=table.get("tip"),
        task=table.get("task"),
        args={n: _argument(value) for n, value in table.get("args", {}).items()},
        free=_free(path, where, table.get("free", {})),
        lock={n: _number(path, where, value) for n, value in table.get("lock", {}).items()},
        package_paths=tuple(folder / str(p) for p in table.get("package_paths", [])),
        emit=tuple(str(name) for name in table.get("emit", ["python"])),
        samples=max(1, table.get("samples", 1000)),
    )


def _argument(value: Any) -> str:
    """A xacro argument as text; booleans as xacro writes them."""
    return str(value).lower() if isinstance(value, bool) else str(value)


def _number(path: Path, where: str, value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, _NUMBER):
        raise _error(path, f"{where}: {value!r} is not a number (rad or m)")
    return float(value)


def _free(path: Path, where: str, value: Any) -> dict[str, float | None]:
    """A list of joints, or a table joint = default value."""
    if isinstance(value, list):
        return {str(name): None for name in value}
    return {name: _number(path, where, x) for name, x in value.items()}
