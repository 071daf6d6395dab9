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
    _note_turned_axes(joints, elements, place)
    return joints


def _note_limits_of_continuous(
    joints: Sequence[Joint], elements: Sequence[Element], place: Place
) -> None:
    limited = [
        (joint.name, element)
        for joint, element in zip(joints, elements, strict=True)
        if joint.type is JointType.CONTINUOUS and stated_limits(element)
    ]
    if limited:
        place.warn(
            limited[0][1],
            f"limits of the continuous joint {_first_of(limited)} ignored, as a continuous joint has "
            'none: write type="revolute" where they are meant',
        )


def _note_turned_axes(joints: Sequence[Joint], elements: Sequence[Element], place: Place) -> None:
    turned = [
        (joint.name, axis)
        for joint, element in zip(joints, elements, strict=True)
        for axis in children(element, "axis")
        if joint.type is not JointType.FIXED and axis.get("rpy") is not None
    ]
    if turned:
        place.warn(
            turned[0][1], f"the <axis> of joint {_first_of(turned)} has an rpy, which URDF ignores"
        )


def _first_of(noted: Sequence[tuple[str, Element]]) -> str:
    """The first, and how many there are besides: one warning for all, as where one has it all tend to."""
    more = f" and of {len(noted) - 1} more" if len(noted) > 1 else ""
    return f"'{noted[0][0]}'{more}"
