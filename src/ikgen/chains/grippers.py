"""Which links of a tree belong to its arms, and which only to their grippers, wheels and rotors.

Fingers are told by what they do (several short moving branches side by side at the end of an arm,
joints that mimic a neighbour) and by their names, unless a joint so named turns a whole gripper; wheels
and rotors by their names and by what hangs on them.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from ikgen.chains.link_names import is_finger, is_finger_link, is_finger_part, is_rotor, is_wheel
from ikgen.chains.rigid_bodies import RigidBodies
from ikgen.importers.urdf.topology import TreeIndex
from ikgen.model.joint_tree import Joint, JointType

__all__ = ["ARM_JOINTS", "ArmLinks", "arm_links"]

ARM_JOINTS = 3
"""A branch of fewer moving joints than this is no arm beside one that has as many."""

_FINGER_JOINTS = 4
_LONGEST_FINGER = 5
"""Thumbs have up to five joints; what moves more under a finger's name is something else."""
_WIDEST_JAW = 3.0
"""Rad; a joint that turns farther turns a gripper and does not open it."""


@dataclass(frozen=True, slots=True)
class ArmLinks:
    """The links that no joint of a gripper, wheel or rotor separates from the root, and among them
    the parts of a gripper that a file holds fast beside its moving fingers. `doubtful`: the joints that
    are taken for a gripper's without others to tell by, by the hub of their body."""

    links: frozenset[str]
    held_fingers: frozenset[str]
    doubtful: Mapping[str, tuple[Joint, ...]]


def arm_links(index: TreeIndex, bodies: RigidBodies) -> ArmLinks:
    """The links of arms, the root included."""
    wheels = _wheel_joints(index, bodies)
    hands = _Hands(index, bodies, _behind_arms(index, bodies))
    kept: set[str] = set()
    palms: list[str] = []
    waiting = [bodies.root]
    while waiting:
        link = waiting.pop()
        kept.add(link)
        fingers = hands.finger_joints(link)
        if fingers:
            palms.append(link)
        without = fingers | wheels
        waiting.extend(j.child for j in index.below[link] if j.name not in without)
    doubtful = {hub: hands.doubtful(hub) for hub in {bodies.hub[palm] for palm in palms}}
    return ArmLinks(frozenset(kept), _held_fingers(index, palms), doubtful)


def _held_fingers(index: TreeIndex, palms: Sequence[str]) -> frozenset[str]:
    """The links held fast below a link with moving fingers, where one of them is a finger's, and
    that do not lead to such a link themselves."""
    held: set[str] = set()
    seen: set[str] = set()
    for palm in palms:
        found: list[str] = []
        if palm in seen:
            continue
        waiting = [palm]
        while waiting:
            fixed = [j.child for j in index.below[waiting.pop()] if j.type is JointType.FIXED]
            found += fixed
            waiting += fixed
        seen.update(found)
        if any(is_finger_link(link) for link in found):
            held.update(found)
    for palm in palms:
        link = palm
        while link in held:
            held.remove(link)
            link = index.above[link].parent
    return frozenset(held)


def _wheel_joints(index: TreeIndex, bodies: RigidBodies) -> frozenset[str]:
    """The joints that turn a wheel, caster or rotor: named so, with nothing else moving below. A rotor that
    turns less than once is a motor's, which moves what is fixed to it."""
    wheels: set[str] = set()
    rolls: dict[str, bool] = {}
    for link in reversed(tuple(bodies.hub)):
        rolls[link] = True
        for joint in index.below[link]:
            if joint.type is JointType.FIXED:
                rolls[link] &= rolls[joint.child]
            elif rolls[joint.child] and _rolls(joint):
                wheels.add(joint.name)
            else:
                rolls[link] = False
    return frozenset(wheels)


def _rolls(joint: Joint) -> bool:
    if joint.type not in (JointType.CONTINUOUS, JointType.REVOLUTE):
        return False
    around = joint.limits.upper - joint.limits.lower >= math.tau
    return is_wheel(joint.name, joint.child) or (around and is_rotor(joint.name, joint.child))


def _behind_arms(index: TreeIndex, bodies: RigidBodies) -> frozenset[str]:
    """The links with enough joints above for an arm, those of fingers not counted: a finger of its own
    is an arm."""
    above = {bodies.root: 0}
    for link in bodies.hub:
        for joint in index.below[link]:
            counts = joint.type.moves_on_one_axis and not _named_finger(joint, bodies)
            above[joint.child] = above[link] + counts
    return frozenset(link for link, count in above.items() if count >= ARM_JOINTS)


def _named_finger(joint: Joint, bodies: RigidBodies) -> bool:
    return is_finger(joint.name, joint.child) and not _turns_gripper(joint, bodies)


def _turns_gripper(joint: Joint, bodies: RigidBodies) -> bool:
    """Whether a joint with a gripper's name is an arm's: the one that moves on its body, with several
    fingers on what it moves, or turning farther than a jaw opens."""
    if len(bodies.exits[bodies.hub[joint.parent]]) > 1 or joint.mimic is not None:
        return False
    if len(bodies.exits[joint.child]) > 1:
        return True
    turns = joint.type in (JointType.CONTINUOUS, JointType.REVOLUTE)
    if not turns or joint.limits.upper - joint.limits.lower < _WIDEST_JAW:
        return False
    part = is_finger_part(joint.name) or is_finger_part(joint.child)
    return bodies.moving_below[joint.child] > 0 or not part


@dataclass(frozen=True, slots=True)
class _Hands:
    """Which joints are a gripper's; `behind_arms` are the links with an arm above."""

    index: TreeIndex
    bodies: RigidBodies
    behind_arms: frozenset[str]
    known: dict[str, bool] = field(default_factory=dict)

    def finger_joints(self, link: str) -> frozenset[str]:
        """The names of the joints right below a link that lead into fingers."""
        below = self.index.below[link]
        fingers = {j.name for j in below if self._is_finger_joint(j)}
        if self.bodies.moving_above[link] >= ARM_JOINTS:
            hub = self.bodies.hub[link]
            if hub not in self.known:
                self.known[hub] = self._is_gripper(hub)
            if self.known[hub]:
                fingers.update(j.name for j in below if j.type is not JointType.FIXED)
        return frozenset(fingers)

    def doubtful(self, hub: str) -> tuple[Joint, ...]:
        """The joints of a body that lead into fingers, unless several where one is sure or slides."""
        exits = self.bodies.exits[hub]
        sure = any(self._is_finger_joint(j) or j.type is JointType.PRISMATIC for j in exits)
        if len(exits) > 1 and sure:
            return ()
        return tuple(j for j in exits if j.name in self.finger_joints(j.parent))

    def _is_gripper(self, hub: str) -> bool:
        """Whether all that moves on a body is fingers: what moves beside two of them is of one hand."""
        bodies, exits = self.bodies, self.bodies.exits[hub]
        longest = min(_FINGER_JOINTS, bodies.moving_above[hub] - 1)
        short = all(bodies.moving_below[j.child] < longest for j in exits)
        sure = sum(self._is_finger_joint(j) for j in exits)
        return sure > 1 or (short and len(exits) > 1)

    def _is_finger_joint(self, joint: Joint) -> bool:
        bodies = self.bodies
        if not joint.type.moves_on_one_axis:
            return False
        # The depth keeps robots whose every joint is named after a finger or a claw.
        deep = joint.parent in self.behind_arms
        if bodies.moving_below[joint.child] >= _LONGEST_FINGER:
            return False
        if deep and _named_finger(joint, bodies):
            return True
        # A mimic joint of an arm follows a joint of the same arm; a finger's follows the one beside it.
        if joint.mimic is None or bodies.hangs_on(joint.parent, joint.mimic.joint):
            return False
        if joint.mimic.joint not in bodies.reach or joint.mimic.joint == joint.name:
            return False  # wrong in the file, which is to be told
        return deep or not bodies.carries(joint.name, joint.mimic.joint)
