"""The command that makes a derivation's report again."""

from __future__ import annotations

import shlex
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

from ikgen.importers.named_robots import is_named
from ikgen.records.record import seen_from

if TYPE_CHECKING:
    from ikgen.emit.derivation import Reading
    from ikgen.records.request import Request
    from ikgen.tasks import Task

__all__ = ["report_command"]


def report_command(request: Request, reading: Reading, task: Task) -> str:
    """What to type where the description lies; what was chosen for the arm is said in it."""
    dh = reading.dh
    asked = replace(
        request,
        task=request.task if task.whole_pose else task.name,
        tool_axis=None,
        free={name: request.free.get(name) for name in dh.free},
        package_paths=tuple(_beside(request, folder) for folder in request.package_paths),
        calibration=request.calibration and _beside(request, request.calibration),
        maintainer=None,
        license=None,
        trust=False,
    )
    if reading.tree is not None:
        asked = replace(asked, base=dh.base_link, tip=dh.tip_link)
    return shlex.join(["ikgen", "report", request.robot.name, *asked.options])


def _beside(request: Request, path: Path) -> Path:
    """A path as it is called in the description's folder; as it was given where that has none."""
    return path if is_named(request.robot) else Path(seen_from(path, request.robot.parent))
