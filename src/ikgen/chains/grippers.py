"""Which links of a tree belong to its arms, and which only to their grippers.

Fingers are told by what they do (several short moving branches side by side at the end of an arm,
joints that mimic a neighbour) and by their names.
"""

from __future__ import annotations

from collections.abc import Mapping

from ikgen.chains.link_names import is_finger
from ikgen.importers.urdf.topology import TreeIndex
from ikgen.model.joint_tree import Joint, JointType

__all__ = ["ARM_JOINTS", "arm_links", "hub_of", "rigid_body"]

ARM_JOINTS = 3
"""A branch of fewer moving joints than this is no arm beside one that has as many."""

_FINGER_JOINTS = 4

# For each link: moving joints above it (from the root), and at most in a row below it.
_Depths = Mapping[str, tuple[int, int]]


def arm_links(index: TreeIndex, root: str) -> frozenset[str]:
    """The links below root, itself included, that no joint of a gripper separates from it."""
    depths = _depths(index, root)
    kept: set[str] = set()
    waiting = [root]
    while waiting:
        link = waiting.pop()
        kept.add(link)
        fingers = _finger_joints(index, link, depths)
        waiting.extend(j.child for j in index.below[link] if j.name not in fingers)
    return frozenset(kept)


def hub_of(index: TreeIndex, link: str, root: str) -> str:
    """The link nearest to root of the rigid body that a link belongs to."""
    while link != root and index.above[link].type is JointType.FIXED:
        link = index.above[link].parent
    return link


def rigid_body(index: TreeIndex, hub: str, links: frozenset[str] | None = None) -> list[str]:
    """The links rigidly attached to `hub` and below it, parents first; those in `links` only."""
    body: list[str] = []
    waiting = [hub]
    while waiting:
        link = waiting.pop()
        body.append(link)
        waiting.extend(
            joint.child
            for joint in reversed(index.below[link])
            if joint.type is JointType.FIXED and (links is None or joint.child in links)
        )
    return body


def _depths(index: TreeIndex, root: str) -> _Depths:
    order = list(index.subtree(root))
    above = {root: 0}
    for link in order:
        for joint in index.below[link]:
            above[joint.child] = above[link] + joint.type.moves_on_one_axis
    below: dict[str, int] = {}
    for link in reversed(order):
        runs = [below[j.child] + j.type.moves_on_one_axis for j in index.below[link]]
        below[link] = max(runs, default=0)
    return {link: (above[link], below[link]) for link in order}


def _finger_joints(index: TreeIndex, link: str, depths: _Depths) -> frozenset[str]:
    """The names of the joints right below a link that lead into fingers."""
    arm_above = depths[link][0]
    root = next(iter(depths))
    fingers = {j.name for j in index.below[link] if _is_finger_joint(index, j, arm_above)}
    if arm_above >= ARM_JOINTS:
        body = rigid_body(index, hub_of(index, link, root))
        exits = [j for b in body for j in index.below[b] if j.type is not JointType.FIXED]
        longest = min(_FINGER_JOINTS, arm_above - 1)
        short = all(depths[j.child][1] < longest for j in exits)
        sure = sum(_is_finger_joint(index, j, arm_above) for j in exits)
        # What moves beside two fingers belongs to the same hand.
        if sure > 1 or (short and len(exits) > 1):
            fingers.update(j.name for j in index.below[link] if j in exits)
    return frozenset(fingers)


def _is_finger_joint(index: TreeIndex, joint: Joint, arm_above: int) -> bool:
    if not joint.type.moves_on_one_axis:
        return False
    # The depth keeps robots whose every joint is named after a finger or a claw.
    if arm_above >= ARM_JOINTS and is_finger(joint.name, joint.child):
        return True
    if joint.mimic is None:
        return False
    # A mimic joint of an arm follows a joint of the same arm; a finger's follows the one beside it.
    link = joint.parent
    while link in index.above:
        if index.above[link].name == joint.mimic.joint:
            return False
        link = index.above[link].parent
    return True
