"""DH tables in TOML: modified or standard convention, numbers or symbols."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from ikgen.errors import BadDescriptionError
from ikgen.importers.dh.entry_expression import BadEntryError, evaluate, finite
from ikgen.importers.dh.entry_units import note_units
from ikgen.importers.dh.example_entry import read_example
from ikgen.importers.dh.row_merge import Merged, merge, modified_rows
from ikgen.importers.dh.table_chain import TableEnds, chain_of_rows, exact_chain
from ikgen.importers.dh.table_document import TableDocument, read_document
from ikgen.importers.dh.table_entries import Entry, locked_entries, read_entries, read_parameters
from ikgen.kinematics.classify import parallel_to_previous, same_line_as_previous
from ikgen.kinematics.rigid import rotation_rpy
from ikgen.model.arrays import Array
from ikgen.model.chain import MOST_AXES
from ikgen.model.dh import DHChain
from ikgen.model.joint_tree import DH_TABLE, Source
from ikgen.model.oddity import OddityKind

__all__ = ["read_dh_table"]


def read_dh_table(
    path: Path, *, free: Sequence[str] = (), locked: Mapping[str, float] | None = None
) -> tuple[Source, DHChain]:
    """Read a table; `free` names joints held free, `locked` gives joints that become constants.

    Lengths and angles keep the table's names; those without numbers are symbolic. Raises
    `BadDescriptionError` with file, line and joint, and `UnknownNameError` for joint names.
    """
    document = read_document(path)
    entries = read_entries(document)
    rows = locked_entries(entries, dict(locked or {}), tuple(free))
    if all(entry.kind == "fixed" for entry in rows):
        raise document.error("no joint moves", "the table needs a revolute or prismatic joint")
    moving = sum(entry.kind != "fixed" for entry in rows)
    if moving > MOST_AXES:
        raise document.error(
            f"{moving} joints move, more than {MOST_AXES}", "fix joints by --lock JOINT=VALUE"
        )
    _check_convention(document, entries)
    note_units(document, entries)
    ends = TableEnds(
        str(document.data.get("name") or path.stem),
        str(document.data.get("base", {}).get("name", "base")),
        str(document.data.get("tool", {}).get("name", "tip")),
    )
    merged = merge(
        modified_rows(rows, str(document.data["convention"])),
        _transform(document, "base"),
        _transform(document, "tool"),
    )
    given = tuple(sorted((locked or {}).items()))
    if not merged.complete:
        _note_new_rows(document, merged)
    make = exact_chain if merged.complete else chain_of_rows
    dh = make(merged, ends, free=tuple(free), locked=given)
    for note in _redundant(dh):
        document.warn(note, OddityKind.ENDLESS)
    return _source(document, read_example(document, entries, tuple(locked or {}))), dh


def _note_new_rows(document: TableDocument, merged: Merged) -> None:
    """A fixed row is left between joints: possible with numbers only."""
    parts = [q for row in merged.rows for q in (row.alpha, row.a, row.d, row.theta)]
    if any(q.symbolic for q in parts):
        raise document.error(
            "a fixed row between joints cannot be merged with symbolic ones",
            "give the lengths and angles numbers under [parameters]",
        )
    document.warn("a fixed row between joints: the rows were made anew from the axes")


def _source(document: TableDocument, example: tuple[float, ...]) -> Source:
    return Source(
        path=document.path,
        kind=DH_TABLE,
        text=document.text,
        sha256=hashlib.sha256(document.text.encode()).hexdigest(),
        dependencies=(document.path.resolve(),),
        warnings=tuple(document.warnings),
        example=example,
    )


def _check_convention(document: TableDocument, entries: tuple[Entry, ...]) -> None:
    """Modified tables begin without a link and standard ones end without, nearly always."""
    moving = [e for e in entries if e.kind != "fixed"]
    if len(moving) < 3:
        return
    first, last = (not (e.alpha.is_near(0.0) and e.a.is_near(0.0)) for e in (moving[0], moving[-1]))
    convention = document.data["convention"]
    if convention == "modified" and first and not last:
        document.warn(
            "row 1 has alpha or a, the last row has none: this looks like the standard convention"
        )
    if convention == "standard" and last and not first:
        document.warn(
            "the last row has alpha or a, row 1 has none: this looks like the modified convention"
        )


def _redundant(dh: DHChain) -> list[str]:
    """Neighbouring axes of which one is enough and neither is held: a continuum of solutions."""
    notes = []
    for i in range(1, len(dh.rows)):
        one, two = dh.rows[i - 1 : i + 1]
        names = f"joints '{one.name}' and '{two.name}' (rows {i} and {i + 1})"
        if dh.joints[one.driver].name in dh.free or dh.joints[two.driver].name in dh.free:
            continue
        advice = "a pose has infinitely many solutions unless one of them is held or locked"
        if one.revolute and two.revolute and same_line_as_previous(two):
            notes.append(f"{names} turn about one line: {advice}")
        if not one.revolute and not two.revolute and parallel_to_previous(two):
            notes.append(f"{names} slide in one direction: {advice}")
    return notes


def _transform(document: TableDocument, table: str) -> Array:
    """The transform (4, 4) of [base] or [tool]: xyz in m, rpy in rad as in URDF."""
    end = document.data.get(table, {})
    x = _triple(document, table, "xyz", end)
    T = np.eye(4)
    T[:3, :3] = rotation_rpy(*_triple(document, table, "rpy", end))
    T[:3, 3] = x
    return T


def _triple(
    document: TableDocument, table: str, key: str, end: Mapping[str, Any]
) -> tuple[float, float, float]:
    given = end.get(key, [0.0, 0.0, 0.0])
    problem = BadDescriptionError
    place = document.error(
        f"[{table}] {key} is not three numbers", f"write {key} = [0, 0, 0]", key=key, table=table
    )
    if not isinstance(given, list) or len(given) != 3:
        raise place
    values: list[float] = []
    for one in given:
        if isinstance(one, bool) or not isinstance(one, int | float | str):
            raise place
        try:
            found = evaluate(str(one), read_parameters(document), angle=key == "rpy")
            finite(found.value)
        except BadEntryError as error:
            raise problem(
                f"[{table}] {key}: {error}", file=str(document.path),
                line=document.line(key=key, table=table), hint=error.hint,
            ) from None  # fmt: skip
        if found.symbolic:
            raise place
        values.append(found.value)
    return values[0], values[1], values[2]
