"""Joints that follow several others: as many joints on one axis, of which each follows one.

The motions of joints on one axis add up, so that `value = k1 * a + k2 * b + c` is that of a joint that
follows `a` and of one on the same axis behind it that follows `b`.
"""

from __future__ import annotations

import copy
import math
from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction
from typing import Any

import numpy as np
from lxml import etree

from ikgen.errors import UnknownNameError, UsageError
from ikgen.importers.urdf.urdf_tree import changed_tree
from ikgen.importers.xml_document import children, parse_xml, shown_file
from ikgen.model.dh import Angle, DHChain, Length
from ikgen.model.joint_relation import Mimic, Relation
from ikgen.model.joint_tree import JointTree, Limits

__all__ = ["parted_dh", "parted_tree", "parts"]

_ROUNDING = 1e-9
"""How far (rad or m) a joint may go beyond its limits by the rounding of numbers in texts."""


def parts(relations: Mapping[str, Relation]) -> dict[str, Mimic]:
    """What the joints of the axes follow: those of the relations, and behind each its further ones."""
    out: dict[str, Mimic] = {}
    for joint, relation in relations.items():
        offset = relation.offset
        for source, multiplier in relation.terms:
            name = joint if joint not in out else _part(joint, source)
            out[name] = Mimic(source, multiplier, offset)
            offset = 0.0
    return out


def _part(joint: str, source: str) -> str:
    return f"{joint} by {source}"


def parted_tree(
    tree: JointTree,
    relations: Mapping[str, Relation],
    locked: Mapping[str, float],
    followed: Mapping[str, str],
) -> JointTree:
    """The tree with the further joints behind those of the relations, all without limits. `followed`: what
    the joints follow that follow one other and are not in the file so.

    Raises `UnknownNameError` for a joint that is not there, `UsageError` where the sources take a joint out
    of its limits.
    """
    if not relations:
        return tree
    limits = {j.name: j.limits for j in tree.joints if j.type.moves_on_one_axis}
    own = {j.name: j.mimic.joint for j in tree.joints if j.mimic is not None}
    _check_sources(relations, own | dict(followed))
    held = {name: Limits(x, x) for name, x in locked.items()}
    root = parse_xml(tree.source.text, shown_file(tree.source))
    elements: dict[str, Any] = {e.get("name") or "": e for e in children(root, "joint")}
    for joint, relation in relations.items():
        _check_range(joint, relation, limits | held)
        _add_joints(root, elements[joint], joint, relation)
    made = changed_tree(tree.source, root)
    return replace(made, source=replace(made.source, sha256=tree.source.sha256))


def _add_joints(root: Any, element: Any, joint: str, relation: Relation) -> None:
    for name in ("limit", "mimic"):
        for old in list(children(element, name)):
            element.remove(old)
    if element.get("type") == "prismatic":
        etree.SubElement(element, "limit", lower="-inf", upper="inf", effort="0", velocity="0")
    else:
        element.set("type", "continuous")
    before = element
    for source, _ in relation.terms[1:]:
        name = _part(joint, source)
        after = copy.deepcopy(element)
        after.set("name", name)
        for origin in list(children(after, "origin")):
            after.remove(origin)
        next(iter(children(after, "child"))).set("link", _child(before))
        next(iter(children(after, "parent"))).set("link", name)
        next(iter(children(before, "child"))).set("link", name)
        etree.SubElement(root, "link", name=name)
        root.append(after)
        before = after


def _child(element: Any) -> str:
    return str(next(iter(children(element, "child"))).get("link"))


def parted_dh(
    dh: DHChain, relations: Mapping[str, Relation], followed: Mapping[str, str]
) -> DHChain:
    """The chain of a table with the further rows behind those of the relations, each with a joint of its
    own. Raises as `parted_tree`."""
    _check_sources(relations, followed)
    for joint, relation in relations.items():
        _check_range(joint, relation, {one.name: one.limits for one in dh.joints})
        for source, _ in reversed(relation.terms[1:]):
            dh = _with_row(dh, joint, _part(joint, source))
    return dh


def _with_row(dh: DHChain, joint: str, name: str) -> DHChain:
    driver = [one.name for one in dh.joints].index(joint)
    place = next(i for i, row in enumerate(dh.rows) if row.driver == driver)
    none, nowhere = Angle(0.0, Fraction(0)), Length(0.0, None)
    row = dh.rows[place]
    straight = replace(
        row, name=name, alpha=none, a=nowhere, d=nowhere, theta=none, driver=len(dh.joints),
        scale=math.copysign(1.0, row.scale), offset=none if row.revolute else nowhere,
    )  # fmt: skip
    endless = Limits(-math.inf, math.inf)
    own = replace(dh.joints[driver], limits=endless, continuous=row.revolute)
    joints = [own if j == driver else one for j, one in enumerate(dh.joints)]
    frames = dh.file_frames
    if frames:
        frames = (*frames[: place + 1], np.eye(4), *frames[place + 1 :])
    return replace(
        dh,
        rows=(*dh.rows[: place + 1], straight, *dh.rows[place + 1 :]),
        joints=(*joints, replace(own, name=name)),
        file_frames=frames,
    )


def _check_sources(relations: Mapping[str, Relation], followed: Mapping[str, str]) -> None:
    """Whether no joint follows one of the relations', which moves by a part of its value alone then."""
    sources = [(joint, source) for joint, source in followed.items() if joint not in relations]
    sources += [(joint, name) for joint, one in relations.items() for name, _ in one.terms]
    for joint, source in sources:
        if source in relations:
            raise UsageError(
                f"--couple: '{joint}' follows '{source}', which follows several joints",
                hint=f"say by --couple {joint}=... what it follows of those that '{source}' does",
            )


def _check_range(joint: str, relation: Relation, limits: Mapping[str, Limits]) -> None:
    """Whether the joint is inside its limits wherever its sources are inside theirs: limits of emitted code
    are of one joint each."""
    low = high = relation.offset
    for name in (joint, *(source for source, _ in relation.terms)):
        if name not in limits:
            raise UnknownNameError("joint", name, list(limits))
    for source, multiplier in relation.terms:
        ends = sorted(multiplier * x for x in (limits[source].lower, limits[source].upper))
        low, high = low + ends[0], high + ends[1]
    own = limits[joint]
    if low < own.lower - _ROUNDING or high > own.upper + _ROUNDING:
        raise UsageError(
            f"--couple: '{joint}' follows several joints, and these take it from {low:.6g} to "
            f"{high:.6g}, beyond its limits ({own.lower:.6g} to {own.upper:.6g})",
            hint="give it limits in the file that hold all of that, or narrower ones to what it follows",
        )
