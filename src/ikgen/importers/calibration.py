"""Calibrations: what one arm's own kinematics is off its model's.

Two forms. YAML as `ur_description` reads it (`kinematics: shoulder: {x, y, z, roll, pitch, yaw}`, lengths
in m and angles in rad): the origins of joints, by the link that they carry, in place of the file's. TOML as
DH tables are written: `[[joints]]` with `alpha`, `a`, `d`, `theta` to add to the arm's modified rows, or
to the standard ones of a table, where `convention` says so.
"""

from __future__ import annotations

import hashlib
import math
import re
from collections.abc import Iterator, Mapping
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ikgen.errors import BadDescriptionError, shown
from ikgen.importers.dh.table_document import CONVENTIONS
from ikgen.importers.merge_conflict import conflict_or
from ikgen.importers.toml_text import parse_toml
from ikgen.model.oddity import Oddity

if TYPE_CHECKING:
    from ikgen.model.joint_tree import JointTree, Source

__all__ = ["ROW_ENTRIES", "calibrated_source", "calibrated_tree", "is_offsets", "row_offsets"]

ROW_ENTRIES = ("alpha", "a", "d", "theta")
_ORIGIN = ("x", "y", "z", "roll", "pitch", "yaw")
_NOT_A_LINK = ("hash",)
_LARGEST = 2**19  # bytes


def is_offsets(path: Path) -> bool:
    """Whether a calibration is one of DH rows, by its suffix."""
    return path.suffix.lower() == ".toml"


def calibrated_source(source: Source, path: Path) -> Source:
    """The source of a description with a calibration beside it: another digest, one more file."""
    from dataclasses import replace

    digest = hashlib.sha256(f"{source.text}\n{_text(path)}".encode("utf-8", "replace")).hexdigest()
    files = dict.fromkeys((*(source.dependencies or (source.path.resolve(),)), path.resolve()))
    return replace(source, sha256=digest, dependencies=tuple(files))


def calibrated_tree(tree: JointTree, path: Path) -> JointTree:
    """The tree of the same text with the origins of a calibration in YAML.

    Raises `BadDescriptionError` for a file that is none, and for entries that name no link of the tree, or
    several.
    """
    from dataclasses import replace

    from lxml import etree

    from ikgen.importers.xml_document import children, parse_xml, shown_file

    source = tree.source
    root = parse_xml(source.text, shown_file(source))
    joints = {
        joint: element for element in children(root, "joint") if (joint := element.get("name"))
    }
    for key, origin in _origins(path).items():
        element = joints[_carrier(tree, key, path)]
        for old in list(children(element, "origin")):
            element.remove(old)
        numbers = [f"{origin[name]!r}" for name in _ORIGIN]
        etree.SubElement(element, "origin", xyz=" ".join(numbers[:3]), rpy=" ".join(numbers[3:]))
    made = _changed_tree(source, root, path)
    return replace(made, source=calibrated_source(made.source, path))


def _changed_tree(source: Source, root: Any, path: Path) -> JointTree:
    """The tree with the calibration's origins; what is odd or wrong in it and was not before is told of the
    calibration's file."""
    from dataclasses import replace

    from ikgen.importers.urdf.urdf_tree import changed_tree
    from ikgen.importers.xml_document import shown_file

    try:
        made = changed_tree(source, root)
    except BadDescriptionError as error:
        raise BadDescriptionError(error.problem, file=str(path), hint=error.hint) from None
    place = re.compile(rf"{re.escape(shown_file(source))}(:\d+)?(?=: )")
    found = []
    for one in made.source.warnings:
        new = Oddity(place.sub(lambda _: str(path), one, count=1), one.joint, one.kind)
        found.append(one if one in source.warnings else new)
    return replace(made, source=replace(made.source, warnings=tuple(found)))


def _carrier(tree: JointTree, key: str, path: Path) -> str:
    """The joint whose child is the link that an entry means: `<key>_link` or `<key>`, with any prefix."""
    exact = [joint.name for joint in tree.joints if joint.child in (f"{key}_link", key)]
    ends = (f"_{key}_link", f"/{key}_link")
    found = exact or [joint.name for joint in tree.joints if joint.child.endswith(ends)]
    if len(found) == 1:
        return found[0]
    what = f"several links of that name ({', '.join(found)})" if found else f"no link '{key}_link'"
    links = ", ".join(joint.child for joint in tree.joints if joint.type.moves_on_one_axis)
    raise BadDescriptionError(
        f"the entry '{key}' of the calibration: the robot has {what}",
        file=str(path),
        hint=f"entries are named like the links that joints carry: {links}",
    )


def _origins(path: Path) -> dict[str, dict[str, float]]:
    """Link -> the six numbers of its joint's origin."""
    data = _yaml(path)
    table = data.get("kinematics") if isinstance(data, Mapping) else None
    if not isinstance(table, Mapping):
        raise BadDescriptionError(
            "no calibration: it has no table 'kinematics'",
            file=str(path),
            hint="a robot's own is written by ur_calibration; offsets of DH rows go in a .toml file",
        )
    found = {}
    links = {key: entry for key, entry in table.items() if key not in _NOT_A_LINK}
    if not links:
        hint = "under it are links, each with the six numbers of its joint's origin"
        raise BadDescriptionError(
            "no calibration: its table 'kinematics' names no link", file=str(path), hint=hint
        )
    for key, entry in links.items():
        if not isinstance(entry, Mapping) or set(entry) != set(_ORIGIN):
            problem = (
                f"the entry '{key}' of the calibration has not the numbers {', '.join(_ORIGIN)}"
            )
            raise BadDescriptionError(problem, file=str(path), hint="lengths in m, angles in rad")
        found[str(key)] = {name: _number(entry[name], f"{key}.{name}", path) for name in _ORIGIN}
    return found


def row_offsets(path: Path, rows: int, table: str = "") -> tuple[dict[str, float], ...]:
    """What a calibration in TOML adds to each of the arm's modified rows: `ROW_ENTRIES`, in m and rad; the
    last, to the link behind the rows, which a standard table has in its last row. `table`: the text of the
    DH table that the arm was read from, "" where it was none.

    Raises `BadDescriptionError` for another number of rows, unknown entries, what is no number, and for
    offsets of standard rows where the arm has none: the signs of its own rows differ from those of a table
    that somebody has of it.
    """
    text = _text(path)
    try:
        data = parse_toml(text)
    except ValueError as error:
        hint = conflict_or(text, "write tables [[joints]]; calibrations in YAML end in .yaml")
        raise BadDescriptionError(f"not TOML: {error}", file=str(path), hint=hint) from None
    standard = _is_standard(data, table, path)
    joints = data.get("joints")
    if (
        set(data) - {"convention"} != {"joints"}
        or not isinstance(joints, list)
        or len(joints) != rows
    ):
        raise BadDescriptionError(
            f"no calibration of {rows} rows",
            file=str(path),
            hint=f"write {rows} tables [[joints]], one a row in order, with what its alpha, a, d, theta "
            "(rad, m) are off, none where that is nothing; ikgen inspect shows the rows",
        )
    found = [dict(_row(joint, i, path)) for i, joint in enumerate(joints, start=1)]
    nothing = dict.fromkeys(ROW_ENTRIES, 0.0)
    before = [nothing, *found] if standard else [*found, nothing]
    return tuple(
        {**link, "d": own["d"], "theta": own["theta"]}
        for link, own in zip(before, [*found, nothing], strict=True)
    )


def _is_standard(data: Mapping[str, Any], table: str, path: Path) -> bool:
    """Whether offsets are of the standard rows of a DH table."""
    convention = data.get("convention", CONVENTIONS[0])
    if convention not in CONVENTIONS:
        problem = f"the calibration's convention is {shown(convention)}"
        hint = f"there is: {', '.join(CONVENTIONS)}"
        raise BadDescriptionError(problem, file=str(path), hint=hint)
    if convention == CONVENTIONS[0]:
        return False
    if not table or parse_toml(table).get("convention") != convention:
        raise BadDescriptionError(
            f"the calibration is of {convention} rows, and the arm was not read from a table of such",
            file=str(path),
            hint="generate from that table (ikgen from-dh), or write the offsets of the modified rows that "
            "ikgen inspect shows",
        )
    return True


def _row(joint: Any, number: int, path: Path) -> Iterator[tuple[str, float]]:
    unknown = sorted(set(joint) - set(ROW_ENTRIES)) if isinstance(joint, Mapping) else ["row"]
    if unknown:
        problem = f"row {number} of the calibration: unknown entry '{unknown[0]}'"
        raise BadDescriptionError(
            problem, file=str(path), hint=f"there is: {', '.join(ROW_ENTRIES)}"
        )
    for name in ROW_ENTRIES:
        yield name, _number(joint.get(name, 0.0), f"row {number}, {name}", path)


def _number(value: Any, where: str, path: Path) -> float:
    number = math.nan
    if isinstance(value, str | int | float) and not isinstance(value, bool):
        with suppress(ValueError, OverflowError):
            number = float(value)  # YAML 1.1 takes 2e-05 for a text
    if math.isfinite(number):
        return number
    problem = f"{where} of the calibration is {shown(value)}, not a finite number"
    raise BadDescriptionError(problem, file=str(path), hint="write it as a number, in m or rad")


def _text(path: Path) -> str:
    from ikgen.importers.xml_document import read_text

    return read_text(path, _LARGEST)


def _yaml(path: Path) -> Any:
    import yaml

    from ikgen.importers.xacro.refusals import ExpansionLimitError
    from ikgen.importers.xacro.yaml_values import parse_yaml

    def check(node: Any) -> None:
        for key, line in _repeated(node):
            problem, hint = f"the calibration has '{key}' twice", "keep the one that is meant"
            raise BadDescriptionError(problem, file=str(path), line=line, hint=hint)

    try:
        return parse_yaml(_text(path), str(path), {}, check)
    except (yaml.YAMLError, ExpansionLimitError) as error:
        what = " ".join(str(error).split())
        hint = "write it as ur_description's calibration.yaml: kinematics, links, their six numbers"
        raise BadDescriptionError(f"not YAML: {what}", file=str(path), hint=hint) from None


def _repeated(node: Any) -> Iterator[tuple[str, int]]:
    """Keys that a table, or one in it, has twice, and the line of the second."""
    table = node.value if node.id == "mapping" else ()
    seen: set[str] = set()
    for key, value in table:
        if key.id == "scalar" and key.value in seen:
            yield key.value, key.start_mark.line + 1
        seen.add(str(key.value))
        yield from _repeated(value)
