"""The joint values that a DH table proposes as an example: what a report shows the solutions of."""

from __future__ import annotations

import math
from collections.abc import Collection
from typing import Any

from ikgen.errors import BadDescriptionError
from ikgen.importers.dh.entry_expression import BadEntryError, evaluate
from ikgen.importers.dh.table_document import TableDocument
from ikgen.importers.dh.table_entries import Entry, read_parameters

__all__ = ["read_example"]


def read_example(
    document: TableDocument, entries: tuple[Entry, ...], locked: Collection[str]
) -> tuple[float, ...]:
    """`example = [...]`: one value (rad or m, numbers or expressions) a moving joint, those of locked
    joints left out; empty where there is none. Raises `BadDescriptionError`."""
    given = document.data.get("example")
    if given is None:
        return ()
    moving = [entry.name for entry in entries if entry.kind != "fixed"]
    if not isinstance(given, list) or len(given) != len(moving):
        raise _problem(document, f"is no list of {len(moving)} joint values")
    values = [_value(document, one) for one in given]
    pairs = zip(moving, values, strict=True)
    return tuple(value for name, value in pairs if name not in locked)


def _problem(document: TableDocument, words: str) -> BadDescriptionError:
    hint = 'write example = [0.5, "pi/4", ...], one value a moving joint, rad or m'
    return document.error(f"the example {words}", hint, key="example")


def _value(document: TableDocument, one: Any) -> float:
    if isinstance(one, bool) or not isinstance(one, int | float | str):
        raise _problem(document, f"holds {one!r}, which is no number")
    try:
        found = evaluate(str(one), read_parameters(document), angle=True)
    except BadEntryError as error:
        raise _problem(document, f"holds {one!r}: {error}") from None
    if found.symbolic or not math.isfinite(found.value):
        raise _problem(document, f"holds {one!r}, which has no number")
    return float(found.value)
