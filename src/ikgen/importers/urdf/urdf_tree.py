"""URDF files into a `JointTree`.

yourdfpy computes the joints. It meets a copy of the document that was checked first, because on a
faulty file it raises bare Python exceptions that name neither the file nor the line.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import replace
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from lxml import etree

from ikgen.errors import UsageError
from ikgen.importers.urdf.joint_element import clean_joint, required_attribute
from ikgen.importers.urdf.joint_limits import joint_limits
from ikgen.importers.urdf.topology import check_joints, find_roots
from ikgen.importers.xml_document import (
    Element,
    Place,
    children,
    local_name,
    parse_xml,
    read_text,
    shown_file,
)
from ikgen.model.joint_tree import Joint, JointTree, JointType, Matrix, Mimic, Source

__all__ = ["parse_urdf", "read"]

_XACRO_HINT = "this is a xacro file: rename it to .urdf.xacro, or expand it with xacro first"
_OTHER_FORMATS = {"sdf": "SDF", "mujoco": "MuJoCo MJCF", "COLLADA": "COLLADA", "launch": "launch"}


def read(path: Path, *, arguments: Mapping[str, str], package_paths: Sequence[Path]) -> JointTree:
    """Read a URDF file; it takes no arguments and needs no packages (meshes are not opened)."""
    del package_paths
    if arguments:
        raise UsageError(
            f"{path}: a URDF file takes no arguments, but got {', '.join(sorted(arguments))}",
            hint="give --arg only with a .xacro file",
        )
    return parse_urdf(read_text(path), path=path)


def parse_urdf(
    text: str,
    *,
    path: Path,
    kind: str = "urdf",
    dependencies: tuple[Path, ...] = (),
    package_urls: tuple[tuple[Path, str], ...] = (),
    arguments: Mapping[str, str] | None = None,
    warnings: Sequence[str] = (),
) -> JointTree:
    """Build the tree of a URDF text; `path` is the file that the user named.

    Raises `BadDescriptionError` with file and line; what is odd but readable is in
    `JointTree.source.warnings`.
    """
    source = Source(
        path=path,
        kind=kind,
        text=text,
        sha256=hashlib.sha256(text.encode("utf-8", "replace")).hexdigest(),
        dependencies=dependencies or (path.resolve(),),
        package_urls=package_urls,
        arguments=tuple(sorted((arguments or {}).items())),
    )
    place = Place(shown_file(source), list(warnings))
    root = parse_xml(text, place.file)
    _check_root(root, place)
    links = _link_names(root, place)
    joints = _joints(root, place)
    check_joints(links, joints, place.file)
    roots = find_roots(links, joints)
    if len(roots) > 1:
        others = ", ".join(f"'{link}'" for link, _ in roots[1:])
        place.warn(None, f"several root links: took '{roots[0][0]}', which has most; also {others}")
    name = _robot_name(root, path, place)
    return JointTree(
        name, links, joints, roots[0][0], replace(source, warnings=tuple(place.warnings))
    )


def _check_root(root: Element, place: Place) -> None:
    tag = local_name(root)
    if tag != "robot":
        other = _OTHER_FORMATS.get(tag)
        hint = f"this looks like a {other} file; ikgen reads URDF and xacro" if other else ""
        raise place.error(
            root, f"the document is <{tag}>, not <robot>", hint or "a URDF's root is <robot>"
        )
    for element in root:
        space = element.tag.partition("}")[0] if isinstance(element.tag, str) else ""
        if space.endswith("xacro"):
            tag = local_name(element)
            raise place.error(element, f"<xacro:{tag}> left in a URDF file", _XACRO_HINT)


def _robot_name(root: Element, path: Path, place: Place) -> str:
    name: str = (root.get("name") or "").strip()
    if not name:
        name = path.name.partition(".")[0] or path.name
        place.warn(root, f"<robot> has no name: took '{name}' from the file's name")
    return name


def _unique(elements: Sequence[Element], kind: str, place: Place) -> tuple[str, ...]:
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


def _link_names(root: Element, place: Place) -> tuple[str, ...]:
    links = _unique(list(children(root, "link")), "link", place)
    if not links:
        raise place.error(root, "the robot has no links", "check that the file is complete")
    return links


def _joints(root: Element, place: Place) -> tuple[Joint, ...]:
    elements = list(children(root, "joint"))
    _unique(elements, "joint", place)
    # Only the joints: meshes, materials and inertias are none of the kinematics' business, and
    # their faults need not stop it.
    plain = etree.Element("robot", name="robot")
    plain.extend([clean_joint(element, place) for element in elements])
    parsed = _load_with_yourdfpy(plain)
    return tuple(_joint(joint, el, place) for joint, el in zip(parsed, elements, strict=True))


def _load_with_yourdfpy(plain: Element) -> Sequence[Any]:
    import yourdfpy  # costs over a second, mostly for its mesh loaders

    document = BytesIO(etree.tostring(plain))
    model = yourdfpy.URDF.load(document, build_scene_graph=False, load_meshes=False)
    joints: Sequence[Any] = model.robot.joints
    return joints


def _joint(parsed: Any, element: Element, place: Place) -> Joint:
    type_ = JointType(parsed.type)
    limit = parsed.limit
    limits, notes = joint_limits(
        type_, None if limit is None else limit.lower, None if limit is None else limit.upper
    )
    for note in notes:
        place.warn(element, f"joint '{parsed.name}': {note}")
    mimic = parsed.mimic
    return Joint(
        name=parsed.name,
        type=type_,
        parent=parsed.parent,
        child=parsed.child,
        T_parent_child=_read_only(np.eye(4) if parsed.origin is None else parsed.origin),
        axis=_read_only(parsed.axis / np.linalg.norm(parsed.axis)),
        limits=limits,
        mimic=None if mimic is None else Mimic(mimic.joint, mimic.multiplier, mimic.offset),
        line=element.sourceline,
    )


def _read_only(values: Any) -> Matrix:
    array: Matrix = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array
