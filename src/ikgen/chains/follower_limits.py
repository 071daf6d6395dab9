"""Limits of joints that follow others, which are not looked at: where the joints leave them."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from ikgen.chains.mimic import Coupling, couple
from ikgen.model.chain import Chain
from ikgen.model.joint_tree import Joint, JointTree, Limits

__all__ = ["beyond_own_limits"]

_BEYOND = 0.02
"""Share of its range by which a follower leaves it before that is said: files round both."""


def beyond_own_limits(tree: JointTree, chain: Chain, path: Sequence[Joint]) -> tuple[str, ...]:
    """A line for each joint of the path that leaves its own limits where the one that it follows is inside
    its own."""
    couplings = couple(tree, path)
    joints = {joint.name: joint for joint in path}
    free = {joint.name: joint.limits for joint in chain.joints}
    found = (_beyond(joints[name], one, free) for name, one in couplings.items())
    return tuple(filter(None, found))


def _beyond(joint: Joint, coupling: Coupling, free: Mapping[str, Limits]) -> str:
    driver, factor = coupling.driver, coupling.multiplier
    if joint.mimic is None or driver.name not in free or factor == 0.0:
        return ""
    own, given = joint.limits, free[driver.name]
    ends = sorted(factor * end + coupling.offset for end in (given.lower, given.upper))
    if not all(map(math.isfinite, (own.lower, own.upper, *ends))):
        return ""
    room = _BEYOND * (own.upper - own.lower)
    if own.lower - room <= ends[0] and ends[1] <= own.upper + room:
        return ""
    inside = sorted((end - coupling.offset) / factor + 0.0 for end in (own.lower, own.upper))
    low, high = max(inside[0], given.lower), min(inside[1], given.upper)
    text = (
        f"joint '{joint.name}' follows '{driver.name}' from {ends[0]:.6g} to {ends[1]:.6g}: its own "
        f"limits, {own.lower:.6g} and {own.upper:.6g}, are not looked at"
    )
    both = f", and hold while '{driver.name}' is from {low:.6g} to {high:.6g}"
    return text + (both if low < high else "")
