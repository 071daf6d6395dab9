"""The kinematic part of a URDF text, in a form that Pinocchio's parser accepts.

Only what places and moves the tip in the base is kept: the path between the two links, its links
emptied, its joints with origin, parent, child and axis. Efforts, velocities, ranges, inertias and
meshes do not move a link, yet Pinocchio refuses a file over some of them (a negative effort, a
revolute joint without `<limit>`). Mimic relations and ranges are read here from the same text and
applied by the oracle, because Pinocchio ignores or reinterprets them.
"""

from __future__ import annotations

import math
import re
import xml.etree.ElementTree as ET
from dataclasses import dataclass, field
from xml.parsers import expat

from ikgen.errors import BadDescriptionError, UnknownNameError
from ikgen.importers.urdf.urdf_version import has_quaternions

__all__ = ["JOINT_PREFIX", "KinematicText", "read_kinematic_text"]

JOINT_PREFIX = "joint:"
"""Put before joint names: Pinocchio confuses a joint and a link of one name, which URDF allows."""

_KINEMATIC = ("origin", "parent", "child", "axis")
_LIMITED = ("revolute", "prismatic")
_UNLIMITED = 1e3
"""A limit (rad) as far as this stands for none: where the other does not, it is taken as two turns from
that, or from 0."""

_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)

_HARMLESS_LIMIT = {"lower": "-1", "upper": "1", "effort": "1", "velocity": "1"}


@dataclass(frozen=True, slots=True)
class KinematicText:
    """`xml` for Pinocchio; `mimic` maps a joint to (driver, multiplier, offset); `ranges` maps a
    joint to (lower, upper) in rad or m, infinite for continuous joints, NaN where the file has no
    usable range; `notes` says which values of the file Pinocchio would have refused."""

    xml: str
    mimic: dict[str, tuple[str, float, float]] = field(default_factory=dict)
    ranges: dict[str, tuple[float, float]] = field(default_factory=dict)
    notes: tuple[str, ...] = ()


def _number(element: ET.Element | None, name: str, default: float) -> float:
    try:
        return default if element is None else float(element.get(name, default))
    except ValueError:
        return math.nan


def _range(joint: ET.Element) -> tuple[float, float]:
    if joint.get("type") not in _LIMITED:
        return -math.inf, math.inf
    limit = joint.find("limit")
    lower, upper = _number(limit, "lower", 0.0), _number(limit, "upper", 0.0)
    if joint.get("type") == "revolute" and upper - lower > 2.0 * _UNLIMITED:
        low, high = lower <= -_UNLIMITED, upper >= _UNLIMITED
        if low and high:
            return -math.inf, math.inf
        lower = min(upper, 0.0) - 4.0 * math.pi if low else lower
        upper = max(lower, 0.0) + 4.0 * math.pi if high else upper
    return (lower, upper) if lower < upper else (math.nan, math.nan)


def _refused(joint: ET.Element) -> list[str]:
    """Limit attributes of the joint that Pinocchio would refuse, as notes."""
    limit, name = joint.find("limit"), joint.get("name", "")
    if limit is None:
        missing = joint.get("type") in _LIMITED
        return [f"joint {name}: no <limit>"] if missing else []
    values = ((a, _number(limit, a, 0.0)) for a in ("effort", "velocity"))
    return [f"joint {name}: {a} {limit.get(a)}" for a, value in values if not value >= 0.0]


def _copy_joint(joint: ET.Element) -> ET.Element:
    name, kind = joint.get("name", ""), joint.get("type", "")
    kept = ET.Element("joint", {"name": JOINT_PREFIX + name, "type": kind})
    kept.extend(child for child in joint if child.tag in _KINEMATIC)
    if kind in _LIMITED:
        ET.SubElement(kept, "limit", _HARMLESS_LIMIT)
    return kept


def _path(joints: list[ET.Element], links: tuple[str, str]) -> list[ET.Element]:
    """The joints between the two links, each with its nearest common ancestor left at the top."""
    above: dict[str, ET.Element] = {}
    for joint in joints:
        child = joint.find("child")
        above.setdefault("" if child is None else child.get("link", ""), joint)
    climbs = []
    for link in links:
        climb: list[ET.Element] = []
        while link in above and above[link] not in climb:
            climb.append(above[link])
            parent = above[link].find("parent")
            link = "" if parent is None else parent.get("link", "")
        climbs.append(climb)
    shared = [joint for joint in climbs[0] if joint in climbs[1]]
    return [joint for climb in climbs for joint in climb if joint not in shared]


def _ends(joint: ET.Element) -> list[str]:
    elements = (joint.find("parent"), joint.find("child"))
    return [element.get("link", "") for element in elements if element is not None]


def _root(text: str) -> ET.Element:
    """The document's root, prefixes left as parts of names: not all files declare them. Comments are left
    out, as those of some files hold `--`."""
    builder, parser = ET.TreeBuilder(), expat.ParserCreate()
    parser.StartElementHandler, parser.EndElementHandler = builder.start, builder.end
    parser.Parse(_COMMENT.sub("", text), True)
    return builder.close()


def read_kinematic_text(text: str, base_link: str, tip_link: str) -> KinematicText:
    """Reduce the URDF `text` to the kinematics between two links.

    Raises `BadDescriptionError` if it is not XML, `UnknownNameError` for a link that it lacks.
    """
    try:
        robot = _root(text)
    except expat.ExpatError as error:
        hint = "check what its macros expand to"
        raise BadDescriptionError(
            f"the expanded description is not XML: {error}", hint=hint
        ) from error
    links = dict.fromkeys(link.get("name", "") for link in robot.findall("link"))
    for link in (base_link, tip_link):
        if link not in links:
            raise UnknownNameError("link", link, links)
    joints = robot.findall("joint")
    path = _path(joints, (base_link, tip_link))
    reduced = ET.Element("robot", {"name": robot.get("name") or "robot"})
    if has_quaternions(robot.get("version")):
        reduced.set("version", "1.1")
    else:  # which Pinocchio would tell on stderr
        for origin in robot.iter("origin"):
            origin.attrib.pop("quat_xyzw", None)
    for name in dict.fromkeys([base_link, tip_link, *(end for j in path for end in _ends(j))]):
        ET.SubElement(reduced, "link", {"name": name})
    reduced.extend(_copy_joint(joint) for joint in path)
    mimic, ranges = {}, {}
    for joint in joints:
        name = joint.get("name", "")
        ranges[name] = _range(joint)
        relation = joint.find("mimic")
        if relation is not None and relation.get("joint"):
            factors = _number(relation, "multiplier", 1.0), _number(relation, "offset", 0.0)
            mimic[name] = (relation.get("joint", ""), *factors)
    notes = tuple(note for joint in path for note in _refused(joint))
    return KinematicText(ET.tostring(reduced, encoding="unicode"), mimic, ranges, notes)
