"""Joints that hardly move where the task needs them: solved for, in words."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from ikgen.model.counted import counted

if TYPE_CHECKING:
    from ikgen.model.chain import ActuatedJoint
    from ikgen.model.dh import DHChain
    from ikgen.tasks import Task

__all__ = ["idle_solved", "idle_warning"]


def idle_solved(dh: DHChain, task: Task) -> tuple[ActuatedJoint, ...]:
    """The joints that are solved for and hardly move, base to tip, where those that do move are too few for
    what all of them do of the task; none elsewhere."""
    from ikgen.kinematics.idle_joints import idle_joints
    from ikgen.tasks.fitting import freedoms_moved

    names = tuple(name for name in idle_joints(dh) if name not in dh.free)
    others = replace(dh, free=(*dh.free, *names))
    if not names or freedoms_moved(others, task) == freedoms_moved(dh, task):
        return ()
    return tuple(joint for joint in dh.joints if joint.name in names)


def idle_warning(dh: DHChain, task: Task) -> str:
    """What such joints make of the task, and the way out; "" where there are none."""
    from ikgen.kinematics.idle_joints import lock_options

    idle = idle_solved(dh, task)
    if not idle:
        return ""
    moving = dh.moving - len(idle)
    names = " and ".join(f"'{joint.name}'" for joint in idle)
    verb = "hardly moves" if len(idle) == 1 else "hardly move"
    return (
        f"{names} {verb}, so only {counted(moving, 'joint move')}: hardly any pose of the task "
        f"'{task.name}' has a solution inside the limits; {lock_options(idle)} gives the task that "
        f"{counted(moving, 'joint')} can do"
    )
