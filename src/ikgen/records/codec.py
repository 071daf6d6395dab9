"""Frozen dataclasses from and to plain tables (TOML, JSON), by the types of their fields.

Small and ikgen's own because configs and records are decoded with the standard library alone: the commit
hook `hooks/ikgen-check` runs from a checkout in which nothing is installed, so neither msgspec nor cattrs
is there to be imported.

A field is an entry of its class's table, of the same name; `inlined` puts the entries of a dataclass among
those of the class that has it, `uncoded` fields are no entries, `coded` gives one a reader of its own.
"""

from __future__ import annotations

import dataclasses
import math
import types
import typing
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

from ikgen.errors import UnknownNameError, shown

__all__ = [
    "CodecError",
    "Decoder",
    "coded",
    "encode",
    "entries_of",
    "inlined",
    "read_free",
    "uncoded",
]

T = TypeVar("T")
_WORDS: dict[type, tuple[str, str]] = {
    str: ("string", "write it in quotes"),
    bool: ("boolean", "write true or false, without quotes"),
    int: ("number", "write a whole number, without quotes"),
    float: ("number", "write a number, without quotes"),
}
"""What values are, and how they are written."""
_READ, _INLINE, _UNCODED = "ikgen.read", "ikgen.inline", "ikgen.uncoded"


class CodecError(Exception):
    """A table that does not fit: where (`arm[0].name`), what is wrong, and a way out."""

    def __init__(self, where: str, problem: str, hint: str) -> None:
        super().__init__(f"{where}{'' if problem.startswith((' ', ':')) else ': '}{problem}")
        self.where = where
        self.hint = hint


def coded(read: Callable[[Any, str], Any]) -> Mapping[str, Any]:
    """Metadata of a field whose raw value `read(value, where)` prepares; it may raise `CodecError`."""
    return {_READ: read}


def inlined() -> Mapping[str, Any]:
    """Metadata of a field (a dataclass) whose entries stand among those of its owner."""
    return {_INLINE: True}


def uncoded() -> Mapping[str, Any]:
    """Metadata of a field that is no entry: it keeps its default."""
    return {_UNCODED: True}


def read_free(value: Any, where: str) -> Any:
    """Held joints: a list of names stands for a table without values."""
    if isinstance(value, list):
        return {str(name): None for name in value}
    if value is not None and not isinstance(value, Mapping):
        raise CodecError(
            where,
            f"{value!r} is neither a list of joints nor a table of their values",
            'write ["JOINT"], or { JOINT = 0.5 }',
        )
    return value


@cache
def _entries(kind: Any) -> tuple[tuple[dataclasses.Field[Any], Any], ...]:
    """The fields that are entries, each with its resolved type."""
    hints = typing.get_type_hints(kind)
    fields = dataclasses.fields(kind)
    return tuple((f, hints[f.name]) for f in fields if not f.metadata.get(_UNCODED))


def entries_of(kind: type) -> tuple[str, ...]:
    """The names of the fields of a dataclass that are entries of its table."""
    return tuple(entry.name for entry, _ in _entries(kind))


def _names(kind: type) -> Iterator[str]:
    for entry, hint in _entries(kind):
        if entry.metadata.get(_INLINE):
            yield from _names(hint)
        else:
            yield entry.name


@dataclasses.dataclass(frozen=True, slots=True)
class Decoder:
    """Reads tables. `place` makes a path of a text, `strict` refuses entries that there are not."""

    place: Callable[[str], Path] = Path
    strict: bool = False

    def table(self, kind: type[T], value: Any, where: str) -> T:
        """The dataclass `kind` of a table; raises `CodecError`."""
        if not isinstance(value, Mapping):
            hint = f"write a table of its entries: {', '.join(sorted(_names(kind)))}"
            raise CodecError(where, " is no table", hint)
        if self.strict:
            known = sorted(_names(kind))
            for name in value:
                if name not in known:
                    hint = UnknownNameError("entry", name, known).hint
                    raise CodecError(f"{where}.{name}", f"unknown entry '{name}'", hint)
        found: T = self._fields(kind, value, where)
        return found

    def _fields(self, kind: Any, table: Mapping[str, Any], where: str) -> Any:
        found: dict[str, Any] = {}
        for entry, hint in _entries(kind):
            if entry.metadata.get(_INLINE):
                found[entry.name] = self._fields(hint, table, where)
            elif entry.name in table:
                found[entry.name] = self._entry(entry, hint, table[entry.name], where)
            elif entry.default is entry.default_factory is dataclasses.MISSING:
                raise CodecError(where, f" has no '{entry.name}'", f"add {entry.name}")
        return kind(**found)

    def _entry(self, entry: dataclasses.Field[Any], hint: Any, value: Any, where: str) -> Any:
        place = f"{where}.{entry.name}".lstrip(".")
        read = entry.metadata.get(_READ)
        return self._value(hint, read(value, place) if read else value, place)

    def _value(self, hint: Any, value: Any, where: str) -> Any:
        """A value of a type hint."""
        origin, inner = typing.get_origin(hint), typing.get_args(hint)
        if origin in (types.UnionType, typing.Union):
            known = next(one for one in inner if one is not type(None))
            return None if value is None else self._value(known, value, where)
        if origin is tuple:
            if not isinstance(value, list):
                raise CodecError(where, f"{value!r} is not a list", "write it in brackets: [...]")
            return tuple(self._value(inner[0], x, f"{where}[{i}]") for i, x in enumerate(value))
        if origin is not None:  # Mapping[str, ...]
            if not isinstance(value, Mapping):
                hint = "write NAME = VALUE in braces: { ... }"
                raise CodecError(where, f"{value!r} is not a table", hint)
            return {name: self._value(inner[1], x, f"{where}.{name}") for name, x in value.items()}
        if dataclasses.is_dataclass(hint):
            kind: type[Any] = hint  # type: ignore[assignment]
            return self.table(kind, value, where)
        return self.place(_plain(str, value, where)) if hint is Path else _plain(hint, value, where)


def _plain(kind: type, value: Any, where: str) -> Any:
    """A text, boolean or number; a number is no boolean, and finite."""
    allowed = (int, float) if kind is float else kind
    if not isinstance(value, allowed) or (isinstance(value, bool) and kind is not bool):
        word, hint = _WORDS[kind]
        raise CodecError(where, f"{value!r} is not a {word}", hint)
    try:
        plain = value if isinstance(value, kind) else kind(value)
    except OverflowError:  # an integer that is larger than any float
        plain = math.inf
    if isinstance(plain, float) and not math.isfinite(plain):
        raise CodecError(where, f"{shown(value)} is not a finite number", "give a finite one")
    return plain


def encode(value: Any, place: Callable[[Path], str]) -> Any:
    """The plain value (tables, lists, texts, numbers) of a coded one; `place` writes a path."""
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        table: dict[str, Any] = {}
        for entry, _ in _entries(type(value)):
            plain = encode(getattr(value, entry.name), place)
            table |= plain if entry.metadata.get(_INLINE) else {entry.name: plain}
        return table
    if isinstance(value, Path):
        return place(value)
    if isinstance(value, Mapping):
        return {name: encode(x, place) for name, x in value.items()}
    return [encode(x, place) for x in value] if isinstance(value, tuple) else value
