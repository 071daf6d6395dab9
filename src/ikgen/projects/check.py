"""Say which arms of a config are stale; with the standard library alone, as a commit hook needs it."""

from __future__ import annotations

import shlex
import sys
from collections.abc import Sequence
from pathlib import Path

from ikgen.errors import BadDescriptionError, IkgenError, UnknownNameError
from ikgen.generation.emitters import find_emitter
from ikgen.projects.config import ArmConfig, named_config
from ikgen.projects.recorded_arms import ROBOT_NOW, has_lost_robot, listed_arms
from ikgen.projects.stale import stale_reasons
from ikgen.tasks import find_task

__all__ = ["main", "mending", "reasons_checked", "stale_lines"]


def reasons_checked(arms: Sequence[ArmConfig], *, verify: bool = True) -> list[str]:
    """`stale_reasons`; raises `BadDescriptionError` where what is stale asks for a task or an output that
    there is not, so that it would not be made either."""
    reasons = stale_reasons(arms, verify=verify)
    for arm, reason in zip(arms, reasons, strict=True):
        try:
            if reason and arm.request.task is not None:
                find_task(arm.request.task)
            for name in arm.outputs.emit if reason else ():
                find_emitter(name)
        except UnknownNameError as error:
            if arm.place is None:
                raise
            raise BadDescriptionError(
                f"{arm.name}: {error.message}",
                file=arm.place.file.as_posix(),
                line=arm.place.line_about([error.name]),
                hint=error.hint,
            ) from None
    return reasons


def stale_lines(reasons: Sequence[tuple[str, str]]) -> list[str]:
    """One line an arm, from its name and the reason it is stale (empty: it is not)."""
    return [f"{name}: {'stale: ' + reason if reason else 'up to date'}" for name, reason in reasons]


def mending(config: Path, arms: Sequence[ArmConfig] = (), robot: Path | None = None) -> str:
    """The command that brings arms of a config, or of a folder's records, up to date; `robot`: the
    description that was given for these."""
    lost = robot is None and any(has_lost_robot(config, arm) for arm in arms)
    more = (
        f" --robot {shlex.quote(robot.as_posix())}" if robot is not None else f" {ROBOT_NOW}" * lost
    )
    return f"ikgen build {shlex.quote(config.as_posix())}{more}"


def main(configs: Sequence[str]) -> int:
    """Check configs (default: the one here); what `ikgen build --check` exits with."""
    code = 0
    named: list[Path | None] = [Path(config) for config in configs]
    for config in named or [None]:
        try:
            path = named_config(config)
            arms = listed_arms(path)
            reasons = [
                (arm.name, reason) for arm, reason in zip(arms, reasons_checked(arms), strict=True)
            ]
        except IkgenError as error:
            hint = [f"hint: {error.hint}"] if error.hint else []
            print(f"error: {error.message}", *hint, sep="\n", file=sys.stderr)
            return error.exit_code
        print(*stale_lines(reasons), sep="\n")
        if any(reason for _, reason in reasons):
            print(f"hint: {mending(path, arms)}", file=sys.stderr)
            code = 1
    return code
