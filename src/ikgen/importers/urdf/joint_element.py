"""One `<joint>` element of URDF as a joint, every number checked."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ikgen.errors import BadDescriptionError
from ikgen.importers.urdf.attribute_values import (
    BadValueError,
    parse_number,
    parse_numbers,
    shortened,
)
from ikgen.importers.urdf.joint_limits import DEGREES_ABOVE, UNLIMITED, joint_limits
from ikgen.importers.urdf.urdf_version import has_quaternions
from ikgen.importers.xml_document import Element, Place, children
from ikgen.kinematics.fixed_order import length
from ikgen.kinematics.quaternion_rotation import rotation
from ikgen.kinematics.rigid import read_only, rotation_rpy
from ikgen.model.arrays import Array
from ikgen.model.joint_tree import Joint, JointType, Limits, Mimic

__all__ = ["read_joint", "required_attribute", "stated_limits"]

_X: tuple[float, ...] = (1.0, 0.0, 0.0)  # URDF's default axis
# Files write 0.57735 for 1/sqrt(3); what is farther from unit length than that was not meant so.
_AXIS_ROUNDING = 1e-4
# Beyond these a direction is noise, or its normalisation under- or overflows.
_AXIS_SHORTEST = 1e-12
_AXIS_LONGEST = 1e12
_LONGEST_NAME = 1000
# Files in mm have lengths of thousands; beyond this doubles leave no room for 1e-9 m.
_LONGEST = 1e4
# Couplings beyond these (a lead screw has some 1e3 rad/m) leave no digit of the angle.
_LARGEST_COUPLING = 1e6


def required_attribute(element: Element, attribute: str, what: str, place: Place) -> str:
    """An attribute that must be there, not be empty, and no longer than a name can be."""
    value: str | None = element.get(attribute)
    if value is None or not value.strip():
        raise place.error(element, f"{what} without {attribute}", f'write {attribute}="..."')
    if len(value) > _LONGEST_NAME:
        message = f"{what}: {attribute} '{shortened(value)}' has {len(value)} characters"
        raise place.error(element, message, f"write at most {_LONGEST_NAME}")
    return value


def read_joint(element: Element, place: Place) -> Joint:
    """A `<joint>` with its kinematics only: meshes, materials and inertias are none of its business, and
    their faults need not stop it.

    Raises `BadDescriptionError` (file, line) for what cannot be read; warns about what can.
    """
    name = required_attribute(element, "name", "<joint>", place)
    type_ = _joint_type(element, name, place)
    parent, child = (_link(element, role, name, place) for role in ("parent", "child"))
    moves = type_.moves_on_one_axis
    return Joint(
        name=name,
        type=type_,
        parent=parent,
        child=child,
        T_parent_child=read_only(_origin(element, name, place)),
        axis=read_only(_axis(element, name, place) if moves else _X),
        limits=_limits(element, type_, name, place) if moves else UNLIMITED,
        mimic=_mimic(element, name, place) if moves else None,
        line=element.sourceline,
    )


def stated_limits(element: Element) -> bool:
    """Whether a `<joint>` that was read states limits other than 0."""
    found = list(children(element, "limit"))
    bounds = [limit.get(bound) for limit in found for bound in ("lower", "upper")]
    return any(parse_number(text, finite=False) != 0.0 for text in bounds if text is not None)


def _joint_type(joint: Element, name: str, place: Place) -> JointType:
    text = required_attribute(joint, "type", f"joint '{name}'", place).strip()
    try:
        return JointType(text)
    except ValueError:
        known = ", ".join(member.value for member in JointType)
        hint = f"URDF knows: {known}"
        if text in ("spherical", "ball"):
            hint += "; write a ball joint as three revolute joints"
        raise place.error(joint, f"joint '{name}' has the unknown type '{text}'", hint) from None


def _only_child(joint: Element, tag: str, name: str, place: Place) -> Element | None:
    """The child, of several that say the same the first; ROS's parser reads it whatever the others say."""
    found = list(children(joint, tag))
    for other in found[1:]:
        if dict(other.attrib) != dict(found[0].attrib):
            hint = "keep one of them: ROS reads the first"
            raise place.error(other, f"joint '{name}' has two <{tag}> elements that differ", hint)
        place.warn(other, f"joint '{name}' has two <{tag}> elements that say the same", name)
    return found[0] if found else None


def _bad(element: Element, name: str, what: str, bad: BadValueError, place: Place) -> Exception:
    error: BadDescriptionError = place.error(element, f"joint '{name}': {what}: {bad}", bad.hint)
    return error


def _vector(
    element: Element,
    attribute: str,
    default: Sequence[float],
    name: str,
    place: Place,
    largest: float = math.inf,
) -> tuple[float, ...]:
    text = element.get(attribute)
    if text is None:
        return tuple(default)
    try:
        return parse_numbers(text, 3, largest=largest)
    except BadValueError as bad:
        raise _bad(element, name, attribute, bad, place) from None


def _link(joint: Element, role: str, name: str, place: Place) -> str:
    link = _only_child(joint, role, name, place)
    if link is None:
        raise place.error(joint, f"joint '{name}' has no <{role}>", f'add <{role} link="..."/>')
    return required_attribute(link, "link", f"<{role}> of joint '{name}'", place)


def _origin(joint: Element, name: str, place: Place) -> Array:
    """The pose (4, 4) of the joint's frame in its parent's."""
    T = np.eye(4)
    origin = _only_child(joint, "origin", name, place)
    if origin is not None:
        T[:3, 3] = _vector(origin, "xyz", (0.0, 0.0, 0.0), name, place, _LONGEST)
        T[:3, :3] = _rotation(origin, name, place)
    return T


def _rotation(origin: Element, name: str, place: Place) -> Array:
    """The rotation (3, 3) of an `<origin>`, by roll, pitch and yaw or as a quaternion."""
    quaternion = origin.get("quat_xyzw")
    if quaternion is not None and not has_quaternions(
        origin.getroottree().getroot().get("version")
    ):
        said = f"quat_xyzw of joint '{name}' ignored, as a URDF has it from version 1.1 on"
        place.warn(origin, f'{said}: write <robot version="1.1"> where it is meant', name)
    elif quaternion is not None:
        return _quaternion_rotation(origin, name, place)
    rpy = _vector(origin, "rpy", (0.0, 0.0, 0.0), name, place)
    if max(map(abs, rpy)) > DEGREES_ABOVE:
        angles = " ".join(f"{angle:g}" for angle in rpy)
        place.warn(origin, f"joint '{name}': rpy {angles} looks like degrees: taken as rad", name)
    return rotation_rpy(*rpy)


def _quaternion_rotation(origin: Element, name: str, place: Place) -> Array:
    if origin.get("rpy") is not None:
        message = f"joint '{name}' has both rpy and quat_xyzw"
        raise place.error(origin, message, "keep one of them: ROS refuses both")
    try:
        x, y, z, w = parse_numbers(origin.get("quat_xyzw"), 4, largest=_LONGEST)
    except BadValueError as bad:
        raise _bad(origin, name, "quat_xyzw", bad, place) from None
    if math.hypot(x, y, z, w) < _AXIS_SHORTEST:
        raise place.error(origin, f"joint '{name}': quat_xyzw is zero", "write 0 0 0 1 for no turn")
    return rotation(np.array((w, x, y, z)))


def _axis(joint: Element, name: str, place: Place) -> Array:
    """The unit vector (3,) of the axis in the joint's frame."""
    axis = _only_child(joint, "axis", name, place)
    xyz = _X
    if axis is not None:
        required_attribute(axis, "xyz", f"<axis> of joint '{name}'", place)
        xyz = _vector(axis, "xyz", xyz, name, place)
    size = math.hypot(*xyz)
    if size > _AXIS_LONGEST:
        raise place.error(axis, f"joint '{name}': axis of length {size:g}", "use a unit vector")
    if size < _AXIS_SHORTEST:
        raise place.error(
            axis, f"joint '{name}' moves about a zero axis", "give the axis a direction"
        )
    if abs(size - 1.0) > _AXIS_ROUNDING:
        place.warn(axis, f"joint '{name}': axis of length {size:g} normalised", name)
    vector = np.array(xyz)
    return np.asarray(vector / length(vector))


def _limits(joint: Element, type_: JointType, name: str, place: Place) -> Limits:
    limit = _only_child(joint, "limit", name, place)
    bounds: dict[str, float] = {}
    if limit is not None:
        for attribute in ("lower", "upper", "effort", "velocity"):
            text = limit.get(attribute)
            if text is not None:
                bounds[attribute] = _scalar(limit, attribute, text, name, place, finite=False)
        for attribute in ("effort", "velocity"):
            if bounds.get(attribute, 0.0) < 0.0:
                text = limit.get(attribute)
                place.warn(
                    limit, f"joint '{name}': negative {attribute} limit {text} ignored", name
                )
    try:
        limits, notes = joint_limits(type_, bounds.get("lower"), bounds.get("upper"), name)
    except BadValueError as bad:
        raise place.error(joint, f"joint '{name}': {bad}", bad.hint) from None
    for note in notes:
        place.warn(joint, f"joint '{name}': {note}", name, note.kind)
    return limits


def _mimic(joint: Element, name: str, place: Place) -> Mimic | None:
    mimic = _only_child(joint, "mimic", name, place)
    if mimic is None:
        return None
    source = required_attribute(mimic, "joint", f"<mimic> of joint '{name}'", place)
    values = {"multiplier": 1.0, "offset": 0.0}
    for attribute in values:
        text = mimic.get(attribute)
        if text is not None:
            values[attribute] = _scalar(
                mimic, attribute, text, name, place, largest=_LARGEST_COUPLING
            )
    return Mimic(source, values["multiplier"], values["offset"])


def _scalar(
    element: Element,
    attribute: str,
    text: str,
    name: str,
    place: Place,
    *,
    finite: bool = True,
    largest: float = math.inf,
) -> float:
    try:
        return parse_number(text, finite=finite, largest=largest)
    except BadValueError as bad:
        raise _bad(element, name, attribute, bad, place) from None
