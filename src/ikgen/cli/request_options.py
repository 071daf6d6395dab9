"""The `Request` that options make, and the texts that they take."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from ikgen.errors import UsageError
from ikgen.model.joint_relation import checked_relation
from ikgen.model.joint_value import parse_joint_value
from ikgen.model.maintainer import checked_maintainer
from ikgen.model.module_name import checked_module_name
from ikgen.records.request import Request

__all__ = ["make_request", "parse_coupled", "parse_emit", "parse_free", "parse_locked"]


def make_request(
    robot: Path,
    *,
    base: str | None = None,
    tip: str | None = None,
    task: str | None = None,
    tool_axis: str | None = None,
    free: Sequence[str] = (),
    lock: Sequence[str] = (),
    couple: Sequence[str] = (),
    args: Sequence[str] = (),
    package_paths: Sequence[Path] = (),
    calibration: Path | None = None,
    name: str | None = None,
    maintainer: str | None = None,
    license: str | None = None,
    trust: bool = False,
) -> Request:
    """The request that the options make; raises `UsageError` for text that does not parse."""
    from ikgen.tasks import requested_task

    for folder in package_paths:
        if not folder.is_dir():
            hint = "name the folder that holds the package's folder"
            raise UsageError(f"--package-path {folder}: no such directory", hint=hint)
    return Request(
        robot=robot,
        base=base,
        tip=tip,
        task=requested_task(task, tool_axis),
        tool_axis=tool_axis,
        free=parse_free(free),
        lock=parse_locked(lock),
        couple=parse_coupled(couple),
        args=_arguments(args),
        package_paths=tuple(package_paths),
        calibration=calibration,
        name=_checked("--name", checked_module_name, name),
        maintainer=_checked("--maintainer", checked_maintainer, maintainer),
        license=license,
        trust=trust,
    )


def parse_free(texts: Sequence[str]) -> dict[str, float | None]:
    """Joint -> default value or None of each --free JOINT[=VALUE]."""
    found: dict[str, float | None] = {}
    for text in texts:
        joint, equals, value = text.rpartition("=")
        if not equals:
            joint = value
        if not joint or joint in found:
            what = "given twice" if joint else "no joint named"
            raise UsageError(
                f"--free {text}: {what}", hint="write --free JOINT or JOINT=VALUE, once"
            )
        found[joint] = _number("--free", text, value) if equals else None
    return found


def parse_locked(texts: Sequence[str]) -> dict[str, float]:
    """Joint -> value of each --lock JOINT=VALUE."""
    found: dict[str, float] = {}
    for text in texts:
        joint, _, value = text.rpartition("=")
        if not joint:
            raise UsageError(
                f"--lock {text}: no value",
                hint="write --lock JOINT=VALUE (rad or m, or 45deg, 120mm)",
            )
        if joint in found:
            hint = "leave all but one of them out"
            raise UsageError(f"--lock {text}: joint '{joint}' is given twice", hint=hint)
        found[joint] = _number("--lock", text, value)
    return found


def parse_coupled(texts: Sequence[str]) -> dict[str, str]:
    """Joint -> relation of each --couple JOINT=SOURCE*k+c."""
    found: dict[str, str] = {}
    for text in texts:
        joint, _, relation = text.partition("=")
        _checked(f"--couple {text}", checked_relation, relation)
        if not joint or joint in found:
            what = "given twice" if joint else "no joint named"
            raise UsageError(
                f"--couple {text}: {what}", hint="write --couple JOINT=SOURCE*k+c, once a joint"
            )
        found[joint] = relation
    return found


def parse_emit(texts: Sequence[str]) -> tuple[str, ...]:
    """Names of outputs from --emit a,b (repeatable), each once, by default Python; raises for an unknown
    one, or none."""
    from ikgen.generation.emitters import find_emitter

    names = [name.strip() for text in texts for name in text.split(",")]
    chosen = tuple(dict.fromkeys(name for name in names if name))
    if texts and not chosen:
        raise UsageError("--emit names no output", hint="for example --emit python,cpp")
    chosen = chosen or ("python",)
    for name in chosen:
        find_emitter(name)
    return chosen


def _number(option: str, text: str, value: str) -> float:
    try:
        return parse_joint_value(value)
    except ValueError:
        raise UsageError(
            f"{option} {text}: '{value}' is not a finite number",
            hint="give the value in rad (revolute) or m (prismatic), or with its unit: 45deg, 120mm",
        ) from None


def _arguments(texts: Sequence[str]) -> dict[str, str]:
    """NAME:=VALUE pairs."""
    found: dict[str, str] = {}
    for text in texts:
        name, sign, value = text.partition(":=")
        if not sign or not name:
            raise UsageError(f"--arg {text}: not an argument", hint="write --arg NAME:=VALUE")
        found[name] = value
    return found


def _checked(option: str, check: Callable[[str], str], text: str | None) -> str | None:
    """The text of an option, None where it was not given, if it passes a check."""
    try:
        return None if text is None else check(text)
    except UsageError as error:
        raise UsageError(f"{option}: {error.message}", hint=error.hint) from None
