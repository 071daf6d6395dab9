"""What messages say of options of the command line, in a config's words: as entries of an `[[arm]]`."""

from __future__ import annotations

import re
import shlex
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType

from ikgen.records.option_words import Notation, quoted
from ikgen.records.request import Request

__all__ = ["EntryWords"]

_BARE = re.compile(r"[A-Za-z0-9_-]+")
_NUMBER = re.compile(r"[+-]?\d+(\.\d+)?([eE][+-]?\d+)?")


class EntryWords(Notation):
    """Entries of the table that asks for a request. What stands there already is not said again."""

    texts = MappingProxyType({"--maintainer": "maintainer", "--license": "license", "-o": "out"})
    lists = MappingProxyType({"--emit": "emit"})

    def __init__(self, request: Request | None = None) -> None:
        super().__init__()
        typed = shlex.join(request.options) if request is not None else ""
        self._there = frozenset(self.fields(typed))

    def names_in(self, message: str) -> Iterator[str]:
        """What a message names that may stand in the table, what it is about first: entries that it begins
        with, the file that it does, names in quotes, other entries."""
        entries = [field.split(" ")[0] for field in self.fields(message)]
        yield from entries if message.startswith("-") else ()
        yield from (Path(file).name for file in re.findall(r"^([^\s:]+):", message))
        yield from re.findall(r"'([^']+)'", message)
        yield from entries

    def generating(self, robot: str, words: Sequence[str]) -> str:
        """The entries that are to be written, or the command that builds what is listed."""
        return ", ".join(word for word in words if word not in self._there) or "ikgen build"

    def alone(self, name: str, *, heading: bool) -> str:
        """The entry's name."""
        return name

    def assigned(self, name: str, value: str) -> str:
        """As TOML has it."""
        return f"{name} = {value}"

    def table(self, values: Mapping[str, str | None]) -> str:
        """An inline table."""
        return f"{{ {', '.join(f'{_key(name)} = {_value(x)}' for name, x in values.items())} }}"


def _key(name: str) -> str:
    return name if _BARE.fullmatch(name) else quoted(name)


def _value(text: str | None) -> str:
    """A number, the word VALUE that stands for one, or else a text."""
    if text is None or text == "VALUE":
        return "VALUE"
    return text if _NUMBER.fullmatch(text) else quoted(text)
