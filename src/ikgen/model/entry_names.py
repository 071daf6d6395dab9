"""Names of the entries of a pose: r11 to r33 of its rotation, px, py and pz of its position."""

from __future__ import annotations

__all__ = ["ENTRY_NAMES", "entry_name", "entry_place"]

_POSITION = ("px", "py", "pz")


def entry_name(row: int, column: int) -> str:
    """The name of the entry in a row and column from 0; column 3 is the position."""
    return _POSITION[row] if column == 3 else f"r{row + 1}{column + 1}"


ENTRY_NAMES = (*(entry_name(i, j) for i in range(3) for j in range(3)), *_POSITION)

_PLACES = {entry_name(i, j): (i, j) for i in range(3) for j in range(4)}


def entry_place(name: str) -> tuple[int, int]:
    """The row and column, from 0, of the entry of a name; raises KeyError for what is none."""
    return _PLACES[name]
