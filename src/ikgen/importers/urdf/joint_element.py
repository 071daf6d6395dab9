"""One `<joint>` element: checked, and copied in the plain form that suits yourdfpy."""

from __future__ import annotations

import math
from collections.abc import Sequence

from lxml import etree

from ikgen.errors import BadDescriptionError
from ikgen.importers.urdf.attribute_values import (
    BadValueError,
    parse_number,
    parse_numbers,
    shortened,
)
from ikgen.importers.xml_document import Element, Place, children
from ikgen.model.joint_tree import JointType

__all__ = ["clean_joint", "required_attribute"]

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


def clean_joint(joint: Element, place: Place) -> Element:
    """A copy of a `<joint>` with its kinematics only, every number checked and complete.

    Raises `BadDescriptionError` (file, line) for what cannot be read; warns about what can.
    """
    name = required_attribute(joint, "name", "<joint>", place)
    type_ = _joint_type(joint, name, place)
    plain = etree.Element("joint", name=name, type=type_.value)
    for role in ("parent", "child"):
        link = _only_child(joint, role, name, place)
        if link is None:
            raise place.error(joint, f"joint '{name}' has no <{role}>", f'add <{role} link="..."/>')
        label = f"<{role}> of joint '{name}'"
        etree.SubElement(plain, role, link=required_attribute(link, "link", label, place))
    _copy_origin(joint, plain, name, place)
    if type_.moves_on_one_axis:
        _copy_axis(joint, plain, name, place)
        _copy_limit(joint, plain, name, place)
        _copy_mimic(joint, plain, name, place)
    return plain


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
    found = list(children(joint, tag))
    if len(found) > 1:
        raise place.error(found[1], f"joint '{name}' has two <{tag}> elements", "keep one of them")
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


def _write(values: Sequence[float]) -> str:
    return " ".join(repr(value) for value in values)


def _copy_origin(joint: Element, plain: Element, name: str, place: Place) -> None:
    origin = _only_child(joint, "origin", name, place)
    if origin is None:
        return
    xyz = _vector(origin, "xyz", (0.0, 0.0, 0.0), name, place, _LONGEST)
    rpy = _vector(origin, "rpy", (0.0, 0.0, 0.0), name, place)
    etree.SubElement(plain, "origin", xyz=_write(xyz), rpy=_write(rpy))


def _copy_axis(joint: Element, plain: Element, name: str, place: Place) -> None:
    axis = _only_child(joint, "axis", name, place)
    xyz: tuple[float, ...] = (1.0, 0.0, 0.0)
    if axis is not None:
        xyz = _vector(axis, "xyz", xyz, name, place)
        if axis.get("rpy") is not None:
            place.warn(axis, f"joint '{name}': <axis> has an rpy, which URDF ignores")
    length = math.hypot(*xyz)
    if length > _AXIS_LONGEST:
        raise place.error(axis, f"joint '{name}': axis of length {length:g}", "use a unit vector")
    if length < _AXIS_SHORTEST:
        raise place.error(
            axis, f"joint '{name}' moves about a zero axis", "give the axis a direction"
        )
    if abs(length - 1.0) > _AXIS_ROUNDING:
        place.warn(axis, f"joint '{name}': axis of length {length:g} normalised")
    etree.SubElement(plain, "axis", xyz=_write(xyz))


def _copy_limit(joint: Element, plain: Element, name: str, place: Place) -> None:
    limit = _only_child(joint, "limit", name, place)
    if limit is None:
        return
    copied: dict[str, str] = {}
    for attribute in ("lower", "upper"):
        text = limit.get(attribute)
        if text is not None:
            copied[attribute] = repr(_scalar(limit, attribute, text, name, place, finite=False))
    etree.SubElement(plain, "limit", copied)
    for attribute in ("effort", "velocity"):
        text = limit.get(attribute)
        if text is not None and _scalar(limit, attribute, text, name, place, finite=False) < 0.0:
            place.warn(limit, f"joint '{name}': negative {attribute} limit {text} ignored")


def _copy_mimic(joint: Element, plain: Element, name: str, place: Place) -> None:
    mimic = _only_child(joint, "mimic", name, place)
    if mimic is None:
        return
    copied = {"joint": required_attribute(mimic, "joint", f"<mimic> of joint '{name}'", place)}
    for attribute in ("multiplier", "offset"):
        text = mimic.get(attribute)
        if text is not None:
            value = _scalar(mimic, attribute, text, name, place, largest=_LARGEST_COUPLING)
            copied[attribute] = repr(value)
    etree.SubElement(plain, "mimic", copied)


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
