"""Joints that follow others although the file does not say so, and the stages of telescopes."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from lxml import etree

from ikgen.errors import UnknownNameError, UsageError
from ikgen.importers.urdf.urdf_tree import changed_tree
from ikgen.importers.xml_document import children, parse_xml, shown_file
from ikgen.model.arrays import Array
from ikgen.model.chain import PRISMATIC, ActuatedJoint, Chain, ChainAxis
from ikgen.model.joint_relation import Mimic
from ikgen.model.joint_tree import JointTree, Limits

__all__ = [
    "equal_shares",
    "equal_stages",
    "farthest_first",
    "related_tree",
    "shared_limits",
]

_SAME = 1e-9
"""Relative difference of the travels of two telescope stages that are equal."""

_SAME_DIRECTION = 1e-9


def related_tree(tree: JointTree, relations: Mapping[str, Mimic]) -> JointTree:
    """The tree of the same text with the relations as `<mimic>` elements; the limits of a source are what
    its followers leave of them.

    The digest stays that of the file. Raises `UnknownNameError` for a joint that is not there, `UsageError`
    where no value is left.
    """
    source = tree.source
    root = parse_xml(source.text, shown_file(source))
    elements: dict[str, Any] = {e.get("name") or "": e for e in children(root, "joint")}
    limits = {j.name: j.limits for j in tree.joints if j.type.moves_on_one_axis}
    for joint in farthest_first(relations):
        relation = relations[joint]
        for name in (joint, relation.joint):
            if name not in limits:
                raise UnknownNameError("joint", name, list(limits))
        for old in list(children(elements[joint], "mimic")):
            elements[joint].remove(old)
        numbers = {"multiplier": repr(relation.multiplier), "offset": repr(relation.offset)}
        etree.SubElement(elements[joint], "mimic", joint=relation.joint, **numbers)
        limits[relation.joint] = shared_limits(
            relation, joint, limits[joint], limits[relation.joint]
        )
    for name in {relation.joint: None for relation in relations.values()}:
        _limit(elements[name], limits[name])
    made = changed_tree(source, root)
    return replace(made, source=replace(made.source, sha256=source.sha256))


def farthest_first(relations: Mapping[str, Mimic]) -> list[str]:
    """The joints that follow others, those before that are driven through others: their limits count for
    these too. Raises `UsageError` where joints follow each other in a circle."""

    def steps(joint: str) -> int:
        passed: list[str] = []
        while joint in relations:
            if joint in passed:
                raise UsageError(
                    f"--couple {joint}={relations[joint].words}: joint '{joint}' follows itself",
                    hint="name another joint that it follows",
                )
            passed.append(joint)
            joint = relations[joint].joint
        return len(passed)

    return sorted(relations, key=steps, reverse=True)


def _limit(element: Any, limits: Limits) -> None:
    """Give a joint's element limits; one that was continuous is so no more where they are finite."""
    if not (math.isfinite(limits.lower) and math.isfinite(limits.upper)):
        return
    if element.get("type") == "continuous":
        element.set("type", "revolute")
    found = next(iter(children(element, "limit")), None)
    if found is None:
        found = etree.SubElement(element, "limit", effort="0", velocity="0")
    found.set("lower", repr(limits.lower))
    found.set("upper", repr(limits.upper))


def shared_limits(relation: Mimic, joint: str, own: Limits, of_source: Limits) -> Limits:
    """The values of the source at which it and the joint are inside their limits."""
    ends = sorted((x - relation.offset) / relation.multiplier for x in (own.lower, own.upper))
    both = Limits(max(of_source.lower, ends[0]), min(of_source.upper, ends[1]))
    if both.lower >= both.upper:
        raise UsageError(
            f"--couple {joint}={relation.words}: no range of values of '{relation.joint}' keeps both "
            "inside their limits",
            hint=f"'{joint}' may take {own.lower:.9g} to {own.upper:.9g}",
        )
    return both


def equal_shares(chain: Chain, held: Collection[str], told: Collection[str]) -> dict[str, Mimic]:
    """The stages of telescopes but those that something else is told of, and what they follow; none where a
    stage is held."""
    found = equal_stages(chain, told)
    named = {*found, *(stage.joint for stage in found.values())}
    return found if named.isdisjoint(held) else {}


def equal_stages(chain: Chain, told: Collection[str] = ()) -> dict[str, Mimic]:
    """Joints of a telescope, each with the same share as its first stage: neighbours that slide in one
    direction, or in the opposite one with the opposite sign, with the same travel, beside those that are
    `told` something else. By joint; empty where the chain has none."""
    found: dict[str, Mimic] = {}
    first: ChainAxis | None = None
    T = np.eye(3)  # from the axes of the last joint to those of the first stage
    for axis in chain.axes:
        joint = chain.joints[axis.driver]
        T = T @ axis.T_prev_axis[:3, :3]
        slides = axis.kind == PRISMATIC and joint.name == axis.name
        if slides and first is not None and (sign := _sense(first.axis, T @ axis.axis)):
            lead = chain.joints[first.driver]
            if joint.name in told:
                continue
            if _same_travel(lead, joint):
                begin = joint.limits.lower if sign > 0 else joint.limits.upper
                found[joint.name] = Mimic(lead.name, sign, begin - sign * lead.limits.lower)
                continue
        first, T = axis if slides and joint.name not in told else None, np.eye(3)
    return found


def _sense(one: Array, other: Array) -> float:
    """1 for directions that are the same, -1 for opposite ones, 0 for others."""
    return next((s for s in (1.0, -1.0) if np.allclose(s * other, one, atol=_SAME_DIRECTION)), 0.0)


def _same_travel(one: ActuatedJoint, other: ActuatedJoint) -> bool:
    """Whether two joints have limits equally far apart."""
    travels = [joint.limits.upper - joint.limits.lower for joint in (one, other)]
    return math.isfinite(travels[0]) and abs(travels[1] - travels[0]) <= _SAME * travels[0]
