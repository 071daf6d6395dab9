"""The universal solver's generation-time half: which elimination to use for a given 6R arm.

The run-time half is the routine `general_6r` in the templates of each language.
"""

from ikgen.elimination.applies import elimination_plan
from ikgen.elimination.loop_frames import held_frames, hold_joint
from ikgen.elimination.plan import EliminationPlan, choose_plan
from ikgen.elimination.routine import general_6r, general_6r_batch

__all__ = [
    "EliminationPlan",
    "choose_plan",
    "elimination_plan",
    "general_6r",
    "general_6r_batch",
    "held_frames",
    "hold_joint",
]
