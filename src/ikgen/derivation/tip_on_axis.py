"""Whether an arm's task is a smaller one because the last joint turns about the tip's own origin."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from ikgen.model.dh import DHChain
    from ikgen.tasks import Task

__all__ = ["tip_on_axis"]

_MOST_JOINTS = 3
"""An arm with more has a wrist, whose last joint is to turn the tip where it is."""

_ON_AXIS = 1e-6
"""How far off an axis, of the arm's length, a tip is on it: the rounding of files."""


def tip_on_axis(dh: DHChain, task: Task, links: bool) -> str:
    """In words, that the tip's origin lies on the last joint's axis, where a chosen task tells of it: one
    that asks more than the joints move, or a turn alone where a tip farther out had a place to reach; ""
    elsewhere. `links`: whether the description has any to name."""
    from ikgen.kinematics.axis_relations import reach
    from ikgen.tasks.fitting import fitting_tasks, over_constrained

    last, out, length = dh.rows[-1], dh.file_frames[-1], reach(dh)
    moving = dh.moving
    if moving > _MOST_JOINTS or not last.revolute or dh.joints[last.driver].name in dh.free:
        return ""
    if np.abs(out[:2, 3]).max() > _ON_AXIS * length:
        return ""
    if not over_constrained(dh, task):
        farther = np.array(out)
        farther[0, 3] += length
        moved = replace(dh, file_frames=(*dh.file_frames[:-1], farther))
        if task.position or fitting_tasks(moved)[0].stem == task.stem:
            return ""
    way_out = (
        "give its link by --tip, or add one to the file" if links else "place it by [tool] xyz"
    )
    return (
        f"'{last.name}' turns '{dh.tip_link}' about its own origin, which stays where it is: where a foot "
        f"or a fingertip is meant, {way_out}"
    )
