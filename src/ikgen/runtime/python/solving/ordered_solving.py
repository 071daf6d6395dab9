"""Search of an arm without held joints: its rows in the order of a preference."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ikgen.runtime.python.arm.solved_arm import Arm
from ikgen.runtime.python.rows.row_preference import preference_costs, preference_of
from ikgen.runtime.python.rows.solutions import Solutions
from ikgen.runtime.python.solving.pose_solving import solve_pose

__all__ = ["search_rows"]


def search_rows(
    arm: Arm, pose: Any, seed: ArrayLike | None, prefer: str, limits: bool
) -> Solutions:
    """All rows, best first. Raises ValueError for bad arguments."""
    preference = preference_of(arm, prefer, seed)
    found = solve_pose(arm, pose, None, seed, limits)
    if not len(found):
        return found
    q, cost, _ = preference_costs(arm, preference, found.q[None], limits)
    order = np.argsort(cost[0], kind="stable")
    return Solutions(q[0, order], found.status, found.singular[order], names=found.names)
