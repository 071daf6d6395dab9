"""Whether the elimination solves a chain, and by which plan."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ikgen.elimination.coupled_plans import choose_coupled
from ikgen.elimination.loop_frames import held_frames
from ikgen.elimination.plan import EliminationPlan, choose_plan
from ikgen.kinematics.position_unit import position_unit
from ikgen.model.dh import DHChain, DHRow
from ikgen.runtime.python.arm.chain_kinematics import Motion
from ikgen.runtime.python.elimination.six_joints import with_tool_joint

__all__ = ["axis_motions", "elimination_plan"]

_HELD_VALUES = (0.4, -1.1, 2.2)
"""Values of held joints (rad or m) at which plans are tried."""

_RIGHT_ANGLES = (0.0, 0.5 * np.pi, np.pi, -0.5 * np.pi)
"""The same where axes become parallel or meet, at which some eliminations lose rank."""

_LONGEST = 2.0
"""Times what errors of the position count over, the scale of lengths at most: rows are right to half of
1e-9 of that."""

_MOST_SLIDES = 3
"""With more of them the rest cannot turn the tip to every rotation."""


def elimination_plan(dh: DHChain, tool: int | None = None) -> EliminationPlan | None:
    """The plan for a whole pose; None unless six joints move, at most three of them slides, or all
    turning where one of them, and no other, turns several axes; or where no plan finds all.

    `tool` (0: x): the plan for the position and the direction of that axis of the tool. A turn about
    it is then the sixth joint, and any pose with that direction does.
    """
    moving = [row for row in dh.rows if dh.joints[row.driver].name not in dh.free]
    drivers = Counter(row.driver for row in moving)
    several = sum(count > 1 for count in drivers.values())
    turned = 0 if tool is None else 1
    turning = tuple(row.revolute for row in moving) + (True,) * turned
    slides = turning.count(False)
    if len(drivers) + turned != 6 or len(dh.rows) - len(moving) != len(dh.free):
        return None
    if several > 1 or slides > (0 if several else _MOST_SLIDES):
        return None
    values, special = (_HELD_VALUES, _RIGHT_ANGLES) if dh.free else ((0.0,), ())
    family = np.array([held_frames(dh, value) for value in (*values, *special)])
    motions = axis_motions(dh, moving)
    if tool is not None:
        family, motions = with_tool_joint(family, tool), (*motions, (5, True, 1.0, 0.0))
    family, beside = np.split(family, [len(values)])
    plan = choose_coupled(family, motions) if several else choose_plan(family, turning, [*beside])
    if plan is None or not plan.usable:
        return None
    return replace(plan, tool=tool, length=min(plan.length, _LONGEST * position_unit(dh)))


def axis_motions(dh: DHChain, moving: Sequence[DHRow]) -> tuple[Motion, ...]:
    """How the DH variables of rows follow those of their joints' leading rows, joints counted among those
    that move."""
    joints = sorted({row.driver for row in moving})
    out = []
    for row in moving:
        ratio, shift = dh.follows(row)
        out.append((joints.index(row.driver), row.revolute, ratio, shift))
    return tuple(out)
