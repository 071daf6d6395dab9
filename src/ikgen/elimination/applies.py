"""Whether the elimination solves a chain, and by which plan."""

from __future__ import annotations

import numpy as np

from ikgen.elimination.loop_frames import held_frames
from ikgen.elimination.plan import EliminationPlan, choose_plan
from ikgen.model.dh import DHChain

__all__ = ["elimination_plan"]

_HELD_VALUES = (0.4, -1.1, 2.2)
"""Values of held joints (rad or m) at which plans are tried."""


_MOST_SLIDES = 3
"""With more of them the rest cannot turn the tip to every rotation."""


def elimination_plan(dh: DHChain) -> EliminationPlan | None:
    """The plan for a whole pose; None unless six joints move, at most three of them slides, or
    where no plan finds all."""
    moving = [row for row in dh.rows if dh.joints[row.driver].name not in dh.free]
    turning = tuple(row.revolute for row in moving)
    if len(moving) != 6 or len(dh.rows) != dh.dof or turning.count(False) > _MOST_SLIDES:
        return None
    values = _HELD_VALUES if dh.free else (0.0,)
    plan = choose_plan(np.array([held_frames(dh, value) for value in values]), turning)
    return plan if plan.usable else None
