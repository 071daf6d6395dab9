"""The eliminations' generation-time half: which one to use for six moving joints, slides among them.

The run-time half is `six_joint_rows` of the runtime, and its like in each language.
"""

from ikgen.elimination.applies import elimination_plan
from ikgen.elimination.loop_frames import held_frames, hold_joint
from ikgen.elimination.plan import EliminationPlan, choose_plan

__all__ = [
    "EliminationPlan",
    "choose_plan",
    "elimination_plan",
    "held_frames",
    "hold_joint",
]
