"""Which links of a tree belong to its arms, and which only to their grippers, wheels and rotors.

Fingers are told by what they do (several short moving branches side by side at the end of an arm,
joints that mimic a neighbour) and by their names, wheels and rotors by their names and by what hangs
on them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from ikgen.chains.link_names import is_finger, is_finger_link, is_rotor, is_wheel
from ikgen.chains.rigid_bodies import RigidBodies
from ikgen.importers.urdf.topology import TreeIndex
from ikgen.model.joint_tree import Joint, JointType

__all__ = ["ARM_JOINTS", "ArmLinks", "arm_links"]

ARM_JOINTS = 3
"""A branch of fewer moving joints than this is no arm beside one that has as many."""

_FINGER_JOINTS = 4
_LONGEST_FINGER = 5
"""Thumbs have up to five joints; what moves more under a finger's name is something else."""


@dataclass(frozen=True, slots=True)
class ArmLinks:
    """The links that no joint of a gripper, wheel or rotor separates from the root, and among them
    the parts of a gripper that a file holds fast beside its moving fingers."""

    links: frozenset[str]
    held_fingers: frozenset[str]


def arm_links(index: TreeIndex, bodies: RigidBodies) -> ArmLinks:
    """The links of arms, the root included."""
    wheels = _wheel_joints(index, bodies)
    kept: set[str] = set()
    palms: list[str] = []
    waiting = [bodies.root]
    grippers: dict[str, bool] = {}
    while waiting:
        link = waiting.pop()
        kept.add(link)
        fingers = _finger_joints(index, link, bodies, grippers)
        if fingers:
            palms.append(link)
        without = fingers | wheels
        waiting.extend(j.child for j in index.below[link] if j.name not in without)
    return ArmLinks(frozenset(kept), _held_fingers(index, palms))


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


def _finger_joints(
    index: TreeIndex, link: str, bodies: RigidBodies, grippers: dict[str, bool]
) -> frozenset[str]:
    """The names of the joints right below a link that lead into fingers; `grippers` remembers which
    bodies are a gripper's."""
    fingers = {j.name for j in index.below[link] if _is_finger_joint(j, bodies)}
    if bodies.moving_above[link] >= ARM_JOINTS:
        hub = bodies.hub[link]
        if hub not in grippers:
            grippers[hub] = _is_gripper(hub, bodies)
        if grippers[hub]:
            fingers.update(j.name for j in index.below[link] if j.type is not JointType.FIXED)
    return frozenset(fingers)


def _is_gripper(hub: str, bodies: RigidBodies) -> bool:
    """Whether all that moves on a body is fingers: what moves beside two of them is of one hand."""
    exits = bodies.exits[hub]
    longest = min(_FINGER_JOINTS, bodies.moving_above[hub] - 1)
    short = all(bodies.moving_below[j.child] < longest for j in exits)
    sure = sum(_is_finger_joint(j, bodies) for j in exits)
    return sure > 1 or (short and len(exits) > 1)


def _is_finger_joint(joint: Joint, bodies: RigidBodies) -> bool:
    if not joint.type.moves_on_one_axis:
        return False
    # The depth keeps robots whose every joint is named after a finger or a claw.
    deep = bodies.moving_above[joint.parent] >= ARM_JOINTS
    if bodies.moving_below[joint.child] >= _LONGEST_FINGER:
        return False
    if deep and is_finger(joint.name, joint.child):
        return True
    # A mimic joint of an arm follows a joint of the same arm; a finger's follows the one beside it.
    if joint.mimic is None or bodies.hangs_on(joint.parent, joint.mimic.joint):
        return False
    if joint.mimic.joint not in bodies.reach or joint.mimic.joint == joint.name:
        return False  # wrong in the file, which is to be told
    return deep or not bodies.carries(joint.name, joint.mimic.joint)
