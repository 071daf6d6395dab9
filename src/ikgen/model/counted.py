"""Numbers of things in words, and lists of names."""

from __future__ import annotations

from collections.abc import Sequence

__all__ = ["counted", "listed", "some_of_them", "with_article"]


def counted(count: int, thing: str) -> str:
    """`1 joint`, `2 joints`; of what moves, `1 joint moves`, `2 joints move`."""
    noun, space, verb = thing.partition(" ")
    if count == 1:
        return f"1 {noun}{space}{verb}{'s' if verb else ''}"
    return f"{count} {noun}s{space}{verb}"


def some_of_them(count: int, one: str, several: str) -> str:
    """`one of them is`, `2 of them are`, by the verb of one and of several."""
    return f"one of them {one}" if count == 1 else f"{count} of them {several}"


def listed(names: Sequence[str], most: int = 10) -> str:
    """Names, cut where they are many."""
    shown = ", ".join(names[:most])
    return shown if len(names) <= most else f"{shown} and {len(names) - most} more"


def with_article(word: str) -> str:
    """`a list`, `an int`: of words that are spoken as they are written."""
    return f"{'an' if word[:1].lower() in tuple('aeiou') else 'a'} {word}"
