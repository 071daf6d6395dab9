"""All joints of a description: each element checked, then computed by yourdfpy.

yourdfpy meets a copy that was checked first, because on a faulty file it raises bare Python exceptions
that name neither the file nor the line.
"""

from __future__ import annotations

from collections.abc import Sequence
from io import BytesIO
from typing import Any

import numpy as np
from lxml import etree

from ikgen.importers.urdf.attribute_values import BadValueError
from ikgen.importers.urdf.joint_element import clean_joint, required_attribute
from ikgen.importers.urdf.joint_limits import joint_limits
from ikgen.importers.xml_document import Element, Place, children
from ikgen.kinematics.fixed_order import length
from ikgen.kinematics.rigid import read_only
from ikgen.model.joint_tree import Joint, JointType, Mimic

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
    # Only the joints: meshes, materials and inertias are none of the kinematics' business, and
    # their faults need not stop it.
    plain = etree.Element("robot", name="robot")
    plain.extend([clean_joint(element, place) for element in elements])
    parsed = _load_with_yourdfpy(plain)
    _note_limits_of_continuous(parsed, elements, place)
    return tuple(_joint(joint, el, place) for joint, el in zip(parsed, elements, strict=True))


def _load_with_yourdfpy(plain: Element) -> Sequence[Any]:
    import yourdfpy  # costs over a second, mostly for its mesh loaders

    document = BytesIO(etree.tostring(plain))
    model = yourdfpy.URDF.load(document, build_scene_graph=False, load_meshes=False)
    joints: Sequence[Any] = model.robot.joints
    return joints


def _note_limits_of_continuous(
    parsed: Sequence[Any], elements: Sequence[Element], place: Place
) -> None:
    """One warning for all continuous joints with limits, as where one has them all tend to."""
    limited = [
        (joint, element)
        for joint, element in zip(parsed, elements, strict=True)
        if joint.type == JointType.CONTINUOUS.value
        and joint.limit is not None
        and (joint.limit.lower or joint.limit.upper)
    ]
    if limited:
        first, element = limited[0]
        more = f" and of {len(limited) - 1} more" if len(limited) > 1 else ""
        place.warn(
            element,
            f"limits of the continuous joint '{first.name}'{more} ignored, as a continuous joint has "
            'none: write type="revolute" where they are meant',
        )


def _joint(parsed: Any, element: Element, place: Place) -> Joint:
    type_ = JointType(parsed.type)
    limit = parsed.limit
    try:
        limits, notes = joint_limits(
            type_, None if limit is None else limit.lower, None if limit is None else limit.upper
        )
    except BadValueError as bad:
        raise place.error(element, f"joint '{parsed.name}': {bad}", bad.hint) from None
    for note in notes:
        place.warn(element, f"joint '{parsed.name}': {note}")
    mimic = parsed.mimic
    return Joint(
        name=parsed.name,
        type=type_,
        parent=parsed.parent,
        child=parsed.child,
        T_parent_child=read_only(np.eye(4) if parsed.origin is None else parsed.origin),
        axis=read_only(parsed.axis / length(parsed.axis)),
        limits=limits,
        mimic=None if mimic is None else Mimic(mimic.joint, mimic.multiplier, mimic.offset),
        line=element.sourceline,
    )
