"""The rows of a DH table as quantities: expressions read, limits and names settled."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ikgen.errors import UnknownNameError
from ikgen.importers.dh.constant_names import symbol_of
from ikgen.importers.dh.entry_expression import BadEntryError, Quantity, evaluate, finite, number
from ikgen.importers.dh.entry_limits import read_limits
from ikgen.importers.dh.table_document import ENTRIES, TableDocument
from ikgen.model.dh import ARM_ANGLE_OPTION
from ikgen.model.joint_tree import Limits

__all__ = ["Entry", "locked_entries", "read_entries", "read_parameters"]


@dataclass(frozen=True, slots=True)
class Entry:
    """One row of the table in its own convention; the variable's own entry is the offset."""

    kind: str
    name: str
    alpha: Quantity
    a: Quantity
    d: Quantity
    theta: Quantity
    limits: Limits


def read_parameters(document: TableDocument) -> dict[str, float | None]:
    """The parameters' numbers; one may be an expression in those before it."""
    known: dict[str, float | None] = {}
    for name, value in document.data.get("parameters", {}).items():
        place: dict[str, Any] = {"key": name, "table": "parameters"}
        try:
            found = evaluate(value, known, angle=False) if isinstance(value, str) else number(value)
        except OverflowError:
            raise document.error(
                f"parameter '{name}' is too large", "write it in m", **place
            ) from None
        except BadEntryError as error:
            raise document.error(f"parameter '{name}': {error}", error.hint, **place) from None
        if found.symbolic or not math.isfinite(found.value):
            raise document.error(
                f"parameter '{name}' has no number",
                "give a finite number, or leave it out",
                **place,
            )
        known[name] = found.value
    return known


def read_entries(document: TableDocument) -> tuple[Entry, ...]:
    """Every row's quantities; raises `BadDescriptionError`; warns of names without number."""
    parameters = read_parameters(document)
    entries: list[Entry] = []
    moving = 0
    for i, joint in enumerate(document.joints, start=1):
        kind = joint["type"]
        moving += kind != "fixed"
        default = "" if kind == "fixed" else f"{'theta' if kind == 'revolute' else 'd'}_{moving}"
        name = joint.get("name", default)
        parts = {
            key: _entry(document, i, joint, key, parameters, (name, default)) for key in ENTRIES
        }
        limits = read_limits(document, i, joint, parameters)
        entries.append(Entry(kind, name, **parts, limits=limits))
    _check_names(document, entries)
    _check_kinds(document, entries, parameters)
    _check_parameters(document, entries, parameters)
    return tuple(entries)


def _entry(
    document: TableDocument,
    i: int,
    joint: Mapping[str, Any],
    key: str,
    parameters: Mapping[str, float | None],
    variable: tuple[str, str],
) -> Quantity:
    value = joint.get(key, 0)
    try:
        if not isinstance(value, str):
            return number(finite(value))
        found = evaluate(value, parameters, angle=key in ("alpha", "theta"))
        finite(found.value)
    except BadEntryError as error:
        raise document.error(f"{key}: {error}", error.hint, joint=i, key=key) from None
    own = {"revolute": "theta", "prismatic": "d"}.get(joint["type"]) == key
    return _offset(document, i, key, found, parameters, variable) if own else found


def _offset(
    document: TableDocument,
    i: int,
    key: str,
    found: Quantity,
    parameters: Mapping[str, float | None],
    variable: tuple[str, str],
) -> Quantity:
    """The variable's own entry: many tables write the variable itself there, which is left out."""
    number_of = variable[1].rpartition("_")[2]
    usual = {
        *variable,
        f"th_{number_of}",
        f"th{number_of}",
        f"q_{number_of}",
        f"q{number_of}",
        f"{key}{number_of}",
    }
    for name, factor in found.terms:
        if name in usual and name not in parameters and factor == 1.0:
            terms = tuple(t for t in found.terms if t[0] != name)
            if all(parameters.get(n) is not None for n, _ in terms):
                value = found.constant + sum(f * (parameters[n] or 0.0) for n, f in terms)
                return Quantity(value, found.constant, terms)
    if found.symbolic:
        raise document.error(
            f"the offset '{document.joints[i - 1][key]}' has no number",
            f"'{key}' is the variable of this joint: its entry is an offset, usually 0",
            joint=i,
            key=key,
        )
    return found


def _check_names(document: TableDocument, entries: list[Entry]) -> None:
    seen: dict[str, int] = {}
    for i, entry in enumerate(entries, start=1):
        if entry.kind == "fixed":
            continue
        if entry.name in seen:
            raise document.error(
                f"the name '{entry.name}' is joint {seen[entry.name]}'s already",
                "give every joint a name of its own", joint=i, key="name",
            )  # fmt: skip
        seen[entry.name] = i


def _check_kinds(
    document: TableDocument, entries: list[Entry], parameters: Mapping[str, float | None]
) -> None:
    """A name without a number stands for a length or for an angle: samples of these are not alike."""
    lengths = {
        name: (i, key) for i, key, name in _terms(entries, ("a", "d")) if name not in parameters
    }
    for i, key, name in _terms(entries, ("alpha", "theta")):
        if name in lengths:
            row, other = lengths[name]
            raise document.error(
                f"'{name}' is an angle here, and a length in row {row} ('{other}')",
                "give it a number under [parameters], or call one of them otherwise",
                joint=i,
                key=key,
            )


def _terms(entries: list[Entry], keys: Sequence[str] = ENTRIES) -> Iterator[tuple[int, str, str]]:
    """Row (from 1), key and name of every parameter in these entries."""
    for i, entry in enumerate(entries, start=1):
        for key in keys:
            for name, _ in getattr(entry, key).terms:
                yield i, key, name


def _check_parameters(
    document: TableDocument, entries: list[Entry], parameters: Mapping[str, float | None]
) -> None:
    """A name without a number is a symbol; one that misspells an unused parameter is a mistake."""
    written = " ".join(str(v) for joint in document.joints for v in joint.values())
    unused = [p for p in parameters if not re.search(rf"\b{re.escape(p)}\b", written)]
    plain = {re.sub("_", "", p).lower(): p for p in unused}
    for i, key, name in _terms(entries):
        close = plain.get(re.sub("_", "", name).lower())
        if name not in parameters and name.isidentifier() and close:
            raise document.error(
                f"no parameter named '{name}'", f"did you mean '{close}'?", joint=i, key=key
            )
    symbols = sorted({name for _, _, name in _terms(entries)} - set(parameters))
    alone = {q.single[0] for e in entries for q in (e.alpha, e.a, e.d, e.theta) if q.single}
    names = [_in_code(n) if n in alone else n for n in symbols if n.isidentifier()]
    if names and parameters:
        document.warn(f"kept as symbols, without numbers: {', '.join(names)}")
    if unused:
        document.warn(f"parameters that no row uses: {', '.join(unused)}")


def _in_code(name: str) -> str:
    """A parameter without a number, and what it is called in emitted code, where that is another name."""
    symbol = symbol_of(name)
    return name if symbol == name else f"{name} ({symbol} in code)"


def locked_entries(
    entries: tuple[Entry, ...], locked: Mapping[str, float], free: tuple[str, ...]
) -> tuple[Entry, ...]:
    """The rows with locked joints as constants; `free` names are checked too."""
    names = [entry.name for entry in entries if entry.kind != "fixed"]
    for name in (*locked, *free):
        if name not in names and (name in locked or name != ARM_ANGLE_OPTION):
            raise UnknownNameError("joint in the table", name, names)
    out: list[Entry] = []
    for entry in entries:
        if entry.kind == "fixed" or entry.name not in locked:
            out.append(entry)
            continue
        value = number(locked[entry.name])
        turned = entry.kind == "revolute"
        theta = entry.theta + value if turned else entry.theta
        d = entry.d if turned else entry.d + value
        out.append(Entry("fixed", entry.name, entry.alpha, entry.a, d, theta, entry.limits))
    return tuple(out)
