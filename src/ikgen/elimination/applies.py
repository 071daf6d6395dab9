"""Whether the elimination solves a chain, and by which plan."""

from __future__ import annotations

import numpy as np

from ikgen.elimination.loop_frames import held_frames
from ikgen.elimination.plan import EliminationPlan, choose_plan
from ikgen.model.dh import DHChain

__all__ = ["elimination_plan"]

_HELD_VALUES = (0.4, -1.1, 2.2)
"""Values of held joints (rad or m) at which plans are tried."""


def elimination_plan(dh: DHChain) -> EliminationPlan | None:
    """The plan for a whole pose; None unless six revolute joints move, or where no plan finds all."""
    moving = dh.dof - len(dh.free)
    turning = all(row.revolute or dh.joints[row.driver].name in dh.free for row in dh.rows)
    if moving != 6 or len(dh.rows) != dh.dof or not turning:
        return None
    values = _HELD_VALUES if dh.free else (0.0,)
    plan = choose_plan(np.array([held_frames(dh, value) for value in values]))
    return plan if plan.usable else None
