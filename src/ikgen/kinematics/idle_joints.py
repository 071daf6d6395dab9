"""Joints whose limits leave them next to no motion: locked by a file, or meant to be."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ikgen.model.chain import REVOLUTE

if TYPE_CHECKING:
    from collections.abc import Sequence

    from ikgen.model.chain import ActuatedJoint
    from ikgen.model.dh import DHChain

__all__ = ["hardly_moves", "idle_joints", "lock_options"]

_TURN = 1e-2
"""Range (rad) below which a joint turns next to nothing: the poses that it adds lie in a thin shell."""

_SLIDE = 1e-3
"""The same of a slide, over the arm's length."""


def hardly_moves(joint: ActuatedJoint, length: float) -> bool:
    """Whether the range inside the joint's limits is next to nothing, in an arm of a length (m)."""
    width = joint.limits.upper - joint.limits.lower
    return width < (_TURN if joint.kind == REVOLUTE else _SLIDE * length)


def idle_joints(dh: DHChain) -> tuple[str, ...]:
    """The joints of a chain that hardly move, held or not, base to tip."""
    from ikgen.kinematics.axis_relations import reach

    length = reach(dh)
    return tuple(joint.name for joint in dh.joints if hardly_moves(joint, length))


def lock_options(joints: Sequence[ActuatedJoint]) -> str:
    """The options that make joints constants, at the middle of their limits."""
    return " ".join(f"--lock {joint.name}={joint.limits.middle_text}" for joint in joints)
