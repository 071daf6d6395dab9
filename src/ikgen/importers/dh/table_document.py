"""The TOML of a DH table, checked entry by entry: every refusal names file, line and joint."""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ikgen.errors import BadDescriptionError, place_in
from ikgen.importers.merge_conflict import conflict_or
from ikgen.importers.toml_text import parse_toml
from ikgen.importers.xml_document import read_text
from ikgen.model.oddity import Oddity, OddityKind

__all__ = ["ENTRIES", "TableDocument", "read_document"]

ENTRIES = ("alpha", "a", "d", "theta")
KINDS = ("revolute", "prismatic", "fixed")
CONVENTIONS = ("modified", "standard")
_TOP_KEYS = (
    "name", "convention", "description", "source", "licence", "parameters", "joints", "base",
    "tool", "example",
)  # fmt: skip
_JOINT_KEYS = ("type", *ENTRIES, "limits", "name")
_END_KEYS = ("xyz", "rpy", "name")
_SYMBOL = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_LARGEST = 2**20
_MOST_ROWS = 100
_AT_LINE = re.compile(r"\s*\(at line (\d+), column \d+\)")


@dataclass(frozen=True, slots=True)
class TableDocument:
    """The checked document: keys are known, joints have their types; entries are not read yet."""

    path: Path
    text: str
    data: Mapping[str, Any]
    warnings: list[Oddity] = field(default_factory=list)

    def warn(self, message: str, kind: OddityKind = OddityKind.TOLD) -> None:
        """Record an oddity that could be read anyway."""
        self.warnings.append(Oddity(f"{place_in(str(self.path), None)}{message}", kind=kind))

    @property
    def joints(self) -> list[Mapping[str, Any]]:
        """The rows of the table."""
        return list(self.data["joints"])

    def error(
        self, message: str, hint: str, *, joint: int | None = None, key: str = "", table: str = ""
    ) -> BadDescriptionError:
        """The error to raise about joint number `joint` (from 1), or about a key of a `table`."""
        where = f"joint {joint}: " if joint else ""
        line = self.line(joint=joint, key=key, table=table)
        return BadDescriptionError(f"{where}{message}", file=str(self.path), line=line, hint=hint)

    def line(self, *, joint: int | None = None, key: str = "", table: str = "") -> int | None:
        """The line of a key, or of its table's header where the key is not found."""
        lines = self.text.splitlines()
        header, start = re.compile(r"^\s*\[+\s*([\w.-]+)\s*\]+"), 0
        wanted, seen = "joints" if joint else table, 0
        if wanted:
            for number, line in enumerate(lines):
                found = header.match(line)
                seen += bool(found and found.group(1) == wanted)
                if seen == (joint or 1):
                    start = number + 1
                    break
            else:
                return None
        for number, line in enumerate(lines[start:], start=start + 1):
            if header.match(line):
                break
            if key and re.match(rf"\s*['\"]?{re.escape(key)}['\"]?\s*=", line):
                return number
        return start or None


def read_document(path: Path) -> TableDocument:
    """Read and check a DH table; raises `BadDescriptionError`."""
    text = read_text(path, _LARGEST, may_be_empty=True)
    try:
        data = parse_toml(text)
    except ValueError as error:
        place = _AT_LINE.search(str(error))
        hint = "a DH table is a TOML file with [[joints]] rows; expressions stand in quotes"
        raise BadDescriptionError(
            f"not valid TOML: {_AT_LINE.sub('', str(error))}",
            file=str(path),
            line=int(place.group(1)) if place else None,
            hint=conflict_or(text, hint),
        ) from None
    document = TableDocument(path, text, data)
    _check_top(document)
    _check_parameters(document)
    for number, joint in enumerate(document.joints, start=1):
        _check_joint(document, number, joint)
    return document


def _unknown(
    document: TableDocument, keys: Iterable[str], known: tuple[str, ...], **place: Any
) -> None:
    for key in keys:
        if key not in known:
            close = difflib.get_close_matches(key, known, n=1, cutoff=0.5)
            hint = f"did you mean '{close[0]}'? " if close else ""
            raise document.error(
                f"unknown key '{key}'", f"{hint}known keys: {', '.join(known)}", key=key, **place
            )


def _check_top(document: TableDocument) -> None:
    data = document.data
    _unknown(document, data, _TOP_KEYS)
    if data.get("convention") not in CONVENTIONS:
        given = (
            "no convention" if "convention" not in data else f"convention {data['convention']!r}"
        )
        raise document.error(
            given,
            'write convention = "modified" (Craig: alpha and a before the joint) or "standard" '
            "(alpha and a after it)",
            key="convention",
        )
    joints = data.get("joints")
    if not isinstance(joints, list) or not joints or not all(isinstance(j, dict) for j in joints):
        raise document.error("no joints", "write one [[joints]] table a row", key="joints")
    if len(joints) > _MOST_ROWS:
        raise document.error(
            f"{len(joints)} rows, more than {_MOST_ROWS}", "describe one arm a table", key="joints"
        )
    for name in ("base", "tool"):
        end = data.get(name, {})
        if not isinstance(end, dict):
            raise document.error(
                f"'{name}' is no table", f"write [{name}] with xyz and rpy", key=name
            )
        _unknown(document, end, _END_KEYS, table=name)
    if not isinstance(data.get("name", ""), str):
        raise document.error("the name is no text", 'write name = "robot"', key="name")


def _check_parameters(document: TableDocument) -> None:
    parameters = document.data.get("parameters", {})
    if not isinstance(parameters, dict):
        raise document.error("'parameters' is no table", "write [parameters]", key="parameters")
    for name, value in parameters.items():
        if not _SYMBOL.fullmatch(name) or name in ("pi", "sqrt"):
            raise document.error(
                f"parameter '{name}' cannot be a name in an expression",
                "use letters, digits and underscores, such as a_2; pi and sqrt are taken",
                key=name, table="parameters",
            )  # fmt: skip
        if isinstance(value, bool) or not isinstance(value, int | float | str):
            raise document.error(
                f"parameter '{name}' is no number", "write a number in m or rad, or leave it out",
                key=name, table="parameters",
            )  # fmt: skip


def _check_joint(document: TableDocument, number: int, joint: Mapping[str, Any]) -> None:
    _unknown(document, joint, _JOINT_KEYS, joint=number)
    kind = joint.get("type")
    if kind not in KINDS:
        given = "no type" if kind is None else f"unknown type {kind!r}"
        raise document.error(given, f"types are: {', '.join(KINDS)}", joint=number, key="type")
    own = {"revolute": "theta", "prismatic": "d"}.get(kind)
    for key in ENTRIES:
        if key not in joint and key != own:
            raise document.error(
                f"{kind} joint without '{key}'",
                f"every row has alpha, a, d and theta; write {key} = 0 if it is zero",
                joint=number,
            )
        value = joint.get(key, 0)
        if isinstance(value, bool) or not isinstance(value, int | float | str):
            raise document.error(
                f"'{key}' is neither a number nor an expression",
                'write a number, or an expression in quotes such as "-pi/2"',
                joint=number, key=key,
            )  # fmt: skip
    if not isinstance(joint.get("name", ""), str) or joint.get("name") == "":
        raise document.error(
            "the name is no text", 'write name = "elbow"', joint=number, key="name"
        )
