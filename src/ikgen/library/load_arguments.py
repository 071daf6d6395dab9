"""The arguments of `ikgen.load`, checked one by one, as a `Request`."""

from __future__ import annotations

import operator
import os
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ikgen.errors import ArgumentError, IkgenError, shown
from ikgen.importers.named_robots import is_named, name_asked
from ikgen.model.joint_relation import checked_relation
from ikgen.model.joint_value import parse_joint_value
from ikgen.model.module_name import checked_module_name
from ikgen.records.request import Request, xacro_texts

__all__ = ["checked_count", "checked_flag", "checked_path", "checked_request", "wrong"]

_MOST = 10**9


def checked_request(
    robot: object,
    *,
    base: object,
    tip: object,
    task: object,
    free: object,
    lock: object,
    couple: object,
    args: object,
    calibration: object,
    tool_axis: object,
    package_paths: object,
    name: object,
    trust: object,
) -> Request:
    """The request that the arguments make; raises `ArgumentError` that names the wrong one."""
    file = _robot(robot)
    axis = _text("tool_axis", tool_axis, '"x", "y" or "z"')
    request = Request(
        robot=file,
        base=_text("base", base, "the name of a link, as in the file"),
        tip=_text("tip", tip, "the name of a link, as in the file"),
        task=_task(task, axis),
        tool_axis=axis,
        free=_held(free),
        lock=_locked(lock),
        couple=_coupled(couple),
        args=_xacro_arguments(args),
        calibration=_calibration(calibration),
        package_paths=_folders(package_paths),
        name=_name(name),
        trust=checked_flag("trust", trust),
    )
    _refuse_for_tables(request)
    return request


def _robot(robot: object) -> Path:
    """The file that is meant."""
    if not isinstance(robot, str | os.PathLike):
        raise wrong("robot", robot, 'a path, or a name such as "example-robot-data:panda"')
    path = Path(os.fsdecode(robot))
    if is_named(path):
        return path
    if not os.fsdecode(robot):
        raise ArgumentError("robot is empty", hint="name a URDF or xacro file, or a DH table")
    if _existing("robot", path).is_dir():
        raise ArgumentError(f"robot: '{path}' is a directory", hint="name the file in it")
    return path


def _refuse_for_tables(request: Request) -> None:
    """A DH table is one chain without arguments."""
    if request.table and (given := request.field_without_use):
        raise ArgumentError(
            f"{given}: a DH table is one chain without arguments", hint=f"leave {given} out"
        )


def _text(argument: str, value: object, what: str) -> str | None:
    if value is not None and (not isinstance(value, str) or not value):
        raise wrong(argument, value, what)
    return value


def _task(task: object, axis: str | None) -> str | None:
    from ikgen.tasks import TASKS, requested_task

    known = ", ".join(one.name for one in TASKS)
    text = _text("task", task, f"one of {known}")
    try:
        return requested_task(text, axis)
    except IkgenError as error:
        raise ArgumentError(f"task: {error.message}", hint=error.hint) from None


def _held(free: object) -> dict[str, float | None]:
    what = "a joint's name, several, or a mapping of names to default values"
    if free is None:
        return {}
    if isinstance(free, str):
        free = [free]
    if isinstance(free, Mapping):
        pairs = list(free.items())
    elif isinstance(free, Iterable):
        pairs = [(joint, None) for joint in free]
    else:
        raise wrong("free", free, what)
    found: dict[str, float | None] = {}
    for joint, value in pairs:
        if not isinstance(joint, str) or not joint:
            raise wrong("free", joint, what)
        found[joint] = None if value is None else _value("free", joint, value)
    return found


def _locked(lock: object) -> dict[str, float]:
    what = "a mapping of joints' names to values"
    if lock is None:
        return {}
    if not isinstance(lock, Mapping) or not all(isinstance(n, str) and n for n in lock):
        raise wrong("lock", lock, what)
    return {joint: _value("lock", joint, value) for joint, value in lock.items()}


def _coupled(couple: object) -> dict[str, str]:
    what = 'a mapping of joints\' names to what they follow, {"JOINT": "SOURCE*k+c"}'
    if couple is None:
        return {}
    if not isinstance(couple, Mapping) or not all(isinstance(n, str) and n for n in couple):
        raise wrong("couple", couple, what)
    for joint, relation in couple.items():
        if not isinstance(relation, str):
            raise wrong(f"couple: {joint}", relation, what)
        _passed(f"couple: {joint}", checked_relation, relation)
    return dict(couple)


def _value(argument: str, joint: str, value: object) -> float:
    try:
        return parse_joint_value(value)
    except ValueError as error:
        raise ArgumentError(
            f"{argument}: {joint}: {error}",
            hint='give rad or m, or a text with its unit: 0.5, "45deg", "120mm"',
        ) from None


def _xacro_arguments(args: object) -> dict[str, str]:
    if args is None:
        return {}
    if not isinstance(args, Mapping) or not all(isinstance(n, str) and n for n in args):
        raise wrong("args", args, "a mapping of the xacro file's arguments to their values")
    return xacro_texts(args)


def _calibration(file: object) -> Path | None:
    if file is None:
        return None
    return _existing("calibration", checked_path("calibration", file))


def _existing(argument: str, path: Path) -> Path:
    """A path that there is."""
    try:
        there = path.exists()
    except (OSError, ValueError):  # names that no file can have
        there = False
    if there:
        return path
    asked = name_asked(path) if argument == "robot" else ""
    hint = "; ".join(filter(None, (f"paths are relative to {Path.cwd()}", asked)))
    raise ArgumentError(f"{argument}: there is no file '{path}'", hint=hint)


def _folders(paths: object) -> tuple[Path, ...]:
    what = "folders that are packages or hold them"
    if isinstance(paths, str | os.PathLike):
        paths = [paths]
    if not isinstance(paths, Iterable):
        raise wrong("package_paths", paths, what)
    found = []
    for one in paths:
        if not isinstance(one, str | os.PathLike) or not os.fsdecode(one):
            raise wrong("package_paths", one, what)
        found.append(_existing("package_paths", Path(os.fsdecode(one))))
        if not found[-1].is_dir():
            raise ArgumentError(
                f"package_paths: '{found[-1]}' is no directory", hint=f"give {what}"
            )
    return tuple(found)


def _name(name: object) -> str | None:
    text = _text("name", name, "an identifier, which begins the names of files")
    return None if text is None else _passed("name", checked_module_name, text)


def _passed(argument: str, check: Callable[[str], str], text: str) -> str:
    """The text of an argument if it passes a check."""
    try:
        return check(text)
    except IkgenError as error:
        raise ArgumentError(f"{argument}: {error.message}", hint=error.hint) from None


def checked_path(argument: str, path: object) -> Path:
    """A path that a file can have."""
    try:
        text = os.fsdecode(path)  # type: ignore[arg-type]
        if isinstance(path, str | os.PathLike) and text and b"\0" not in os.fsencode(text):
            return Path(text)
    except (TypeError, UnicodeError):
        pass
    raise wrong(argument, path, "a path")


def checked_count(argument: str, value: object) -> int:
    """A number of things, at least one."""
    try:
        count = 0 if isinstance(value, bool) else operator.index(value)  # type: ignore[arg-type]
    except TypeError:
        count = 0
    if not 1 <= count <= _MOST:
        raise wrong(argument, value, f"a whole number from 1 to {_MOST}")
    return count


def checked_flag(argument: str, value: Any) -> bool:
    """True or false, as Python or NumPy has them."""
    if not isinstance(value, bool | np.bool_):
        raise wrong(argument, value, "True or False")
    return bool(value)


def wrong(argument: str, value: object, what: str) -> ArgumentError:
    """The error for a value that is not `what` the argument takes."""
    given = f"{shown(value)} ({type(value).__name__})"
    return ArgumentError(f"{argument}: {given} does not do", hint=f"give {what}")
