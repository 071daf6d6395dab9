"""URDF files into a `JointTree`."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from lxml import etree

from ikgen.errors import UsageError
from ikgen.importers.unprefixed import require_expanded
from ikgen.importers.urdf.joint_list import read_joints, unique_names
from ikgen.importers.urdf.millimetres import note_millimetres
from ikgen.importers.urdf.topology import check_joints, find_roots
from ikgen.importers.xml_document import (
    WEB_PAGE_HINT,
    Element,
    Place,
    children,
    local_name,
    parse_xml,
    read_text,
    shown_file,
)
from ikgen.model.joint_tree import JointTree, Source
from ikgen.model.oddity import Oddity

__all__ = ["NO_LINKS", "changed_tree", "parse_urdf", "read"]

NO_LINKS = "the robot has no links"

_XACRO_HINT = "this is a xacro file: rename it to .urdf.xacro, or expand it with xacro first"
_OTHER_FORMATS = {
    "sdf": "an SDF file",
    "mujoco": "a MuJoCo MJCF file",
    "COLLADA": "a COLLADA file",
    "launch": "a launch file",
}


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
    environment: tuple[tuple[str, str | None], ...] = (),
    arguments: Mapping[str, str] | None = None,
    warnings: Sequence[Oddity] = (),
) -> JointTree:
    """Build the tree of a URDF text; `path` is the file that the user named.

    Raises `BadDescriptionError` with file and line; what is odd but readable is in
    `JointTree.source.warnings`.
    """
    source = Source(
        path=path,
        kind=kind,
        text=text,
        sha256=_digest(text),
        dependencies=dependencies or (path.resolve(),),
        package_urls=package_urls,
        environment=environment,
        arguments=tuple(sorted((arguments or {}).items())),
    )
    return _tree(parse_xml(text, shown_file(source)), source, warnings)


def _tree(root: Element, source: Source, warnings: Sequence[Oddity]) -> JointTree:
    """The tree of a document; what is odd in it is added to the warnings."""
    place = Place(shown_file(source), list(warnings))
    _check_root(root, place)
    require_expanded(root, place)
    links = _link_names(root, place)
    joints = read_joints(root, place)
    check_joints(links, joints, place.file)
    note_millimetres(joints, place)
    roots = find_roots(links, joints)
    if len(roots) > 1:
        others = ", ".join(f"'{link}'" for link, _ in roots[1:])
        place.warn(
            None,
            f"several root links: took '{roots[0][0]}', the one with most joints below it; also {others}",
        )
    name = _robot_name(root, source.path, place)
    return JointTree(
        name, links, joints, roots[0][0], replace(source, warnings=tuple(place.warnings))
    )


def _digest(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8", "replace")).hexdigest()


def changed_tree(source: Source, root: Element) -> JointTree:
    """The tree of a description whose document was changed to `root`: of what else is known of the source
    only the digest is another one.

    The elements keep the lines that they have in the file, so that what was odd before is not told again
    as if it were elsewhere.
    """
    text = etree.tostring(root, encoding="unicode")
    made = _tree(root, replace(source, text=text, sha256=_digest(text)), source.warnings)
    warnings = tuple(dict.fromkeys(made.source.warnings))
    return replace(made, source=replace(made.source, warnings=warnings))


def _check_root(root: Element, place: Place) -> None:
    tag = local_name(root)
    if tag != "robot":
        other = _OTHER_FORMATS.get(tag)
        hint = f"this looks like {other}; ikgen reads URDF and xacro" if other else ""
        hint = WEB_PAGE_HINT if tag.lower() == "html" else hint
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


def _link_names(root: Element, place: Place) -> tuple[str, ...]:
    links = unique_names(list(children(root, "link")), "link", place)
    if not links:
        raise place.error(root, NO_LINKS, "check that the file is complete")
    return links
