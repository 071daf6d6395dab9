"""Numbers of things in words."""

from __future__ import annotations

__all__ = ["counted"]


def counted(count: int, thing: str) -> str:
    """`1 joint`, `2 joints`; of what moves, `1 joint moves`, `2 joints move`."""
    noun, space, verb = thing.partition(" ")
    if count == 1:
        return f"1 {noun}{space}{verb}{'s' if verb else ''}"
    return f"{count} {noun}s{space}{verb}"
