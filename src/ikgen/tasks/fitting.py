"""Which tasks an arm can do everywhere: those whose freedoms its joints move independently."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from ikgen.kinematics.axis_relations import reach
from ikgen.kinematics.forward import file_forward, file_slopes
from ikgen.kinematics.joint_box import joint_box
from ikgen.program.policy import LEVEL
from ikgen.tasks import AXES, POSE, POSITION, TASKS, Task

if TYPE_CHECKING:
    from ikgen.model.arrays import Array
    from ikgen.model.dh import DHChain

__all__ = [
    "default_tasks",
    "fits",
    "fitting_tasks",
    "freedoms_barely_moved",
    "freedoms_fixed",
    "freedoms_moved",
    "heading_shortened",
    "keeps_heading_level",
    "motion_ratios",
    "over_constrained",
    "rank",
    "scaled_motion",
]

_LEVEL = 0.5 * LEVEL
"""What a heading's squared length may be short of 1 at some configurations, as it is more at others."""

_INDEPENDENT = 1e-5
"""Least singular value, relative to the largest, of freedoms that are moved independently."""

_ROUND_OFF = 2e-9
"""The same of freedoms that are moved at all: more than rows may miss a pose by."""

_BARELY = 0.02
"""A task conditioned worse than another by this factor comes behind it: a tilt by rounding moves its
freedoms."""

_EDGE = 0.05
"""Share of a joint's range at either end, and of configurations, that does not decide which axis suits."""

_AS_GOOD = 0.5
"""The task's first axis is taken unless another suits the arm better by this factor."""


def fitting_tasks(dh: DHChain, axis: str | None = None) -> tuple[Task, ...]:
    """Tasks for an arm when none was asked for, the best first and the whole pose last; by the tool's
    `axis`, or the one that suits.

    An arm with fewer than six moving joints gets the task that fixes as many freedoms as it has, if
    its joints do move all of them; the whole pose then only counts on the poses that it can take.
    """
    moving = dh.moving
    if moving >= POSE.freedoms:
        return (POSE,)
    sized = [task for task in TASKS if task.freedoms == moving]
    found = [way for task in sized for way in _along(dh, task, (axis,) if axis else AXES)]
    rated = {way: _condition(dh, way) for way in found}
    least = _BARELY * max(rated.values(), default=0.0)
    return (*sorted(found, key=lambda way: rated[way] < least), POSE)


def default_tasks(dh: DHChain, axis: str | None = None) -> tuple[Task, ...]:
    """`fitting_tasks`, and where none fits before the whole pose the position, if that takes all joints:
    two links in a plane have both elbows for it, and one for a pose."""
    fitting = fitting_tasks(dh, axis)
    alone = len(fitting) == 1 and freedoms_moved(dh, POSITION) == dh.moving
    return (POSITION, *fitting) if alone and axis is None else fitting


def _along(dh: DHChain, task: Task, axes: Sequence[str]) -> list[Task]:
    """The task by those of the axes by which it fits, the one that suits the arm best first."""
    ways = [task.along(axis) for axis in axes] if task.axis else [task]
    rated = {way: _suits(dh, way) for way in ways if fits(dh, way)}
    best = max(rated.values(), default=0.0)

    def key(way: Task) -> tuple[bool, float]:
        return way.name != task.name or rated[way] < _AS_GOOD * best, -rated[way]

    return sorted(rated, key=key)


def _suits(dh: DHChain, task: Task) -> float:
    """How well the task's axis suits the arm: a direction alone by the worst in the middle of the joints'
    ranges, where a pan-tilt is not to turn the axis about itself."""
    if task.position or task.orientation != "direction":
        return _condition(dh, task) * _level(dh, task)
    low, high = joint_box(dh, reach(dh))
    share = np.random.default_rng(0).uniform(_EDGE, 1.0 - _EDGE, (256, dh.dof))
    ratios = _all_ratios(_moved(dh, task, low + share * (high - low)))
    return float(f"{np.quantile(ratios[:, -1], _EDGE):.2g}")


def _level(dh: DHChain, task: Task) -> float:
    """How much an elevation changes with the tilt of the tool in the middle of the joints' ranges: nothing
    where its axis is vertical there, as both sides of that have one elevation; 1 for other tasks."""
    if task.orientation != "pitch":
        return 1.0
    low, high = joint_box(dh, reach(dh))
    middle = file_forward(dh, 0.5 * (low + high)[None])[0, 2, AXES.index(task.axis)]
    return float(f"{np.sqrt(max(1.0 - middle**2, 0.0)):.2g}")


def fits(dh: DHChain, task: Task) -> bool:
    """Whether the joints that are not held move the task's freedoms independently of each other."""
    level = task.orientation in ("yaw", "pitch") and keeps_heading_level(dh, task.axis)
    if task.orientation == ("pitch" if level else "yaw"):
        return False  # an axis that stays horizontal has a heading and no elevation, others the reverse
    return freedoms_moved(dh, task) == dh.moving


def over_constrained(dh: DHChain, task: Task) -> int:
    """How many of the task's freedoms the joints cannot move: 0 for a task that the arm can do."""
    return max(0, freedoms_fixed(dh, task) - freedoms_moved(dh, task))


def freedoms_fixed(dh: DHChain, task: Task) -> int:
    """How many freedoms the task fixes: with a heading whose length the joints change its tilt as well."""
    return task.freedoms + int(
        task.orientation == "yaw" and np.ptp(_shortened(dh, task.axis)) > _LEVEL
    )


def keeps_heading_level(dh: DHChain, axis: str) -> bool:
    """Whether the tool's axis stays horizontal, so that its heading is a unit vector."""
    return bool(_shortened(dh, axis).max() < _LEVEL)


def heading_shortened(dh: DHChain, task: Task) -> float:
    """By how much the squared length of a heading falls short of 1, at most, where that is so little that
    its direction alone counts; 0 for other tasks."""
    if task.orientation != "yaw":
        return 0.0
    short = float(_shortened(dh, task.axis).max())
    return 2.0 * short if short < _LEVEL else 0.0


def _shortened(dh: DHChain, axis: str) -> Array:
    """By how much the square of the heading's length falls short of 1, at some configurations (64,)."""
    q = np.random.default_rng(0).uniform(-np.pi, np.pi, (64, dh.dof))
    return np.asarray(file_forward(dh, q)[:, 2, AXES.index(axis)] ** 2)


def freedoms_moved(dh: DHChain, task: Task) -> int:
    """How many freedoms of the task the joints that are not held move, nearly everywhere: the rank of
    the task's entries by the joints."""
    return rank(_ratios(dh, task))


def freedoms_barely_moved(dh: DHChain, task: Task) -> int:
    """How many more freedoms of the task all joints move, held or not, by so little that they do not count:
    turns written with few digits tilt axes that are meant to be parallel."""
    ratios = _ratios(replace(dh, free=()), task)
    return int((ratios > _ROUND_OFF).sum()) - rank(ratios)


def rank(ratios: Array) -> int:
    """How many of singular values, each over the largest, are those of independent motions."""
    return int((ratios > _INDEPENDENT).sum())


def _condition(dh: DHChain, task: Task) -> float:
    """Smallest singular value of the motion over the largest, nearly everywhere, to two digits."""
    return float(f"{min(_ratios(dh, task), default=0.0):.2g}")


def _ratios(dh: DHChain, task: Task) -> Array:
    """Singular values of the task's motion over the largest, their median over the samples."""
    motions = _moved(dh, task)
    return motion_ratios(motions) if motions.size else np.empty(0)


def motion_ratios(motions: Array) -> Array:
    """Singular values of motions (..., N, entries, joints) over the largest, their median over the N
    samples: (..., k)."""
    return np.asarray(np.median(_all_ratios(motions), axis=-2))


def _all_ratios(motions: Array) -> Array:
    """Singular values (..., k) of motions (..., entries, joints) over the largest."""
    singular = np.linalg.svd(motions, compute_uv=False)
    return np.asarray(singular / np.maximum(singular[..., :1], 1e-12))


def _moved(dh: DHChain, task: Task, q: Array | None = None) -> Array:
    """`scaled_motion` by the joints that are not held."""
    moving = [j for j, joint in enumerate(dh.joints) if joint.name not in dh.free]
    return np.asarray(scaled_motion(dh, task, q)[..., moving])


def scaled_motion(dh: DHChain, task: Task, q: Array | None = None) -> Array:
    """How the task's entries change with all joints, held or not, lengths in those of the arm, at
    configurations `q` (N, dof), or at a few: (N, entries, dof)."""
    length = reach(dh)
    rows = np.array([1.0 / length if column == 3 else 1.0 for _, column in task.entries])
    columns = np.array([1.0 if joint.kind == "revolute" else length for joint in dh.joints])
    q = _configurations(dh) if q is None else q
    read = tuple(zip(*task.entries, strict=True))
    return np.asarray(file_slopes(dh, q)[:, read[0], read[1]] * rows[:, None] * columns)


def _configurations(dh: DHChain) -> Array:
    """A few configurations (8, dof) in rad and m, the same each time."""
    return np.random.default_rng(0).uniform(-1.5, 1.5, (8, dh.dof))
