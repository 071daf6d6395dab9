"""Mimic joints of a chain, each resolved to the independent joint that drives it in the end."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from ikgen.errors import BadDescriptionError, UnknownNameError, UnsupportedJointError
from ikgen.importers.xml_document import shown_file
from ikgen.model.joint_tree import Joint, JointTree

__all__ = ["Coupling", "couple"]

_LARGEST = 1e6
"""The greatest offset (rad or m) that a chain of mimic joints may come to."""

_FASTEST = 1e4
"""The greatest multiplier that a chain of mimic joints may come to, and the inverse of the least but 0:
values of a joint that are 1e-6 apart count as one, which moves what follows it by a hundredth."""


@dataclass(frozen=True, slots=True)
class Coupling:
    """`value = multiplier * value(driver) + offset`; an independent joint drives itself."""

    driver: Joint
    multiplier: float = 1.0
    offset: float = 0.0

    def value(self, locked: Mapping[str, float]) -> float | None:
        """The joint's value (rad or m) where it is constant, else None."""
        if self.multiplier == 0.0:
            return self.offset
        held = locked.get(self.driver.name)
        return None if held is None else self.multiplier * held + self.offset


def couple(tree: JointTree, path: Sequence[Joint]) -> dict[str, Coupling]:
    """The coupling of each moving joint of a path, by its name, in the path's order.

    A mimic of a mimic composes. Raises `BadDescriptionError` (file, line) where a joint of the path
    mimics one that does not exist or cannot drive it, or where joints mimic each other in a circle.
    """
    joints = {joint.name: joint for joint in tree.joints}
    moving = (joint for joint in path if joint.type.moves_on_one_axis)
    return {joint.name: _resolve(tree, joints, joint) for joint in moving}


def _resolve(tree: JointTree, joints: Mapping[str, Joint], joint: Joint) -> Coupling:
    multiplier, offset = 1.0, 0.0
    current = joint
    seen = {joint.name}
    while current.mimic is not None:
        mimic = current.mimic
        # joint = m * current + o and current = m' * driver + o'
        offset += multiplier * mimic.offset
        multiplier *= mimic.multiplier
        if mimic.joint not in joints:
            raise BadDescriptionError(
                f"joint '{current.name}' mimics '{mimic.joint}', which does not exist",
                file=shown_file(tree.source),
                line=current.line,
                hint=UnknownNameError("joint", mimic.joint, joints).hint,
            )
        if mimic.joint in seen:
            raise BadDescriptionError(
                f"joint '{joint.name}' mimics itself through '{current.name}'",
                file=shown_file(tree.source),
                line=joint.line,
                hint="remove one of the <mimic> elements, or of the relations that were given",
            )
        seen.add(mimic.joint)
        current = joints[mimic.joint]
    if not current.type.moves_on_one_axis:
        raise UnsupportedJointError(
            f"joint '{joint.name}' mimics '{current.name}', which is {current.type.value}",
            file=shown_file(tree.source),
            line=joint.line,
            hint="a mimic joint follows a revolute, continuous or prismatic joint",
        )
    little, fast = 0.0 < abs(multiplier) < 1.0 / _FASTEST, abs(multiplier) > _FASTEST
    if little or fast or abs(offset) > _LARGEST:
        most = f"multiplier {_FASTEST:g}" if fast else f"offset {_LARGEST:g}"
        left = f"too few digits of its value are left beyond {most}: correct <mimic>"
        raise BadDescriptionError(
            f"joint '{joint.name}' follows '{current.name}' as {multiplier:g} * value + {offset:g}",
            file=shown_file(tree.source),
            line=joint.line,
            hint="such a joint hardly moves: write multiplier 0, or correct it" if little else left,
        )
    return Coupling(current, multiplier, offset)
