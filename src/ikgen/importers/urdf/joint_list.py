"""All joints of a description."""

from __future__ import annotations

from collections.abc import Sequence

from ikgen.importers.urdf.joint_element import read_joint, required_attribute, stated_limits
from ikgen.importers.xml_document import Element, Place, children
from ikgen.model.joint_tree import Joint, JointType

__all__ = ["read_joints", "unique_names"]

_MOST_JOINTS = 20_000


def unique_names(elements: Sequence[Element], kind: str, place: Place) -> tuple[str, ...]:
    """The names of elements of a kind; raises `BadDescriptionError` for a missing or a second one."""
    lines: dict[str, int] = {}
    for element in elements:
        name = required_attribute(element, "name", f"<{kind}>", place)
        if name in lines:
            raise place.error(
                element,
                f"duplicate {kind} '{name}', first at line {lines[name]}",
                f"rename or remove one of the two {kind}s",
            )
        lines[name] = element.sourceline
    return tuple(lines)


def read_joints(root: Element, place: Place) -> tuple[Joint, ...]:
    """All joints of a `<robot>` in file order; raises `BadDescriptionError` with file and line."""
    elements = list(children(root, "joint"))
    if len(elements) > _MOST_JOINTS:
        message = f"the robot has {len(elements)} joints, more than {_MOST_JOINTS}"
        raise place.error(elements[_MOST_JOINTS], message, "describe one robot a file")
    unique_names(elements, "joint", place)
    joints = tuple(read_joint(element, place) for element in elements)
    _note_limits_of_continuous(joints, elements, place)
    return joints


def _note_limits_of_continuous(
    joints: Sequence[Joint], elements: Sequence[Element], place: Place
) -> None:
    """One warning for all continuous joints with limits, as where one has them all tend to."""
    limited = [
        (joint, element)
        for joint, element in zip(joints, elements, strict=True)
        if joint.type is JointType.CONTINUOUS and stated_limits(element)
    ]
    if limited:
        first, element = limited[0]
        more = f" and of {len(limited) - 1} more" if len(limited) > 1 else ""
        place.warn(
            element,
            f"limits of the continuous joint '{first.name}'{more} ignored, as a continuous joint has "
            'none: write type="revolute" where they are meant',
        )
