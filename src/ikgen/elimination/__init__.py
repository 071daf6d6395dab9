"""The eliminations' generation-time half: which one to use for six moving joints, slides among them.

The run-time half is `six_joint_rows` of the runtime, and its like in each language.
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
