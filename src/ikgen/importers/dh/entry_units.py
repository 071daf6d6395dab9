"""Entries of a DH table that look like degrees, mm or cm."""

from __future__ import annotations

from collections.abc import Sequence

from ikgen.importers.dh.table_document import TableDocument
from ikgen.importers.dh.table_entries import Entry
from ikgen.importers.urdf.joint_limits import DEGREES_ABOVE
from ikgen.importers.urdf.millimetres import (
    longer_than_arms,
    shorter_than_arms,
    some_in_millimetres,
)
from ikgen.model.chain import PRISMATIC

__all__ = ["note_units"]


def note_units(document: TableDocument, entries: Sequence[Entry]) -> None:
    """Warns of angles beyond two turns, of lengths beyond those of any arm, and where all add up to more or
    less than those. They are kept as they are."""
    for i, entry in enumerate(entries, start=1):
        for key in ("alpha", "theta"):
            angle = getattr(entry, key)
            if not angle.symbolic and abs(angle.value) > DEGREES_ABOVE:
                words = f"joint {i}: {key} = {angle.value:g} looks like degrees"
                document.warn(f"{words}: taken as rad, in which 90 degrees are 'pi/2'")
    given = {
        f"joint {i}: {key}": getattr(entry, key).value
        for i, entry in enumerate(entries, start=1)
        for key in ("a", "d")
        if not getattr(entry, key).symbolic
    }
    sizes = {name: abs(x) for name, x in given.items()}
    lengths = list(sizes.values())
    far = some_in_millimetres(sizes)
    for name in far:
        where = f"{name} = {given[name]:g}"
        document.warn(f"{where} looks like mm, other lengths like m: kept as it is")
    if not far and longer_than_arms(lengths):
        document.warn(f"lengths up to {max(lengths):g} m look like mm or cm: kept as they are")
    travels = [e.limits.upper - e.limits.lower for e in entries if e.kind == PRISMATIC]
    known = len(lengths) == 2 * len(entries) and not {"base", "tool"} & document.data.keys()
    if known and (words := shorter_than_arms([*lengths, *travels])):
        document.warn(words)
