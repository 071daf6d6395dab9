"""What messages say of options of the command line, in another notation that says the same.

Messages name options by what is typed, `--tip LINK`, whatever part of ikgen they come from. Each is a field
of the request, and here alone is said which. What else a request is made of, arguments of `ikgen.load` or
entries of a config, is a `Notation`: who wrote those reads of them.
"""

from __future__ import annotations

import json
import re
import shlex
from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from types import MappingProxyType

__all__ = ["PROSE", "Notation", "quoted", "unquoted"]

_TEXTS = {
    "--base": "base",
    "--tip": "tip",
    "--task": "task",
    "--tool-axis": "tool_axis",
    "--name": "name",
    "--calibration": "calibration",
}
_BY_NAME = {
    "--free": ("free", "="),
    "--lock": ("lock", "="),
    "--couple": ("couple", "="),
    "--arg": ("args", ":="),
}
"""Options that are given once a name: the field, and what parts the name from its value."""

_LISTS = {"--package-path": "package_paths"}

PROSE = frozenset(("and", "for", "makes", "only", "out", "still", "with", "writes"))
"""Words behind an option that is named without a value."""

_VALUE = r"(?!--)(?:'[^']*'|[^\s'`\",;:()]|:(?=\S))+"
_COMMAND = re.compile(rf"ikgen from-(?:urdf|dh) (?P<robot>{_VALUE})(?= *$| *\n)")
_ONE = re.compile(rf"(--?[a-z][\w-]*)(?: (?!--)({_VALUE}))?")


class Notation(ABC):
    """How what options say is written elsewhere: `flags` by what stands for each that has no value; `texts`
    and `lists` are options that it has beyond those of every request."""

    flags: Mapping[str, str] = MappingProxyType({})
    texts: Mapping[str, str] = MappingProxyType({})
    lists: Mapping[str, str] = MappingProxyType({})

    def __init__(self) -> None:
        self._texts = {**_TEXTS, **self.texts}
        self._lists = {**_LISTS, **self.lists}
        by_name = {option: name for option, (name, _) in _BY_NAME.items()}
        self._names = {**self._texts, **self._lists, **by_name}
        no_value = rf"(?!(?:{'|'.join(sorted(PROSE))})\b)"
        part = rf"(?:{'|'.join(self._names)})(?![\w-])(?: {no_value}{_VALUE})?"
        option = rf"(?:{part}|(?:{'|'.join(self.flags)})(?![\w-]))" if self.flags else part
        command = rf"(?P<command>ikgen from-(?:urdf|dh) (?P<robot>{_VALUE}) ?)?"
        self._run = re.compile(rf"(?<![\w-]){command}{option}(?: {option})*")

    @property
    def options(self) -> tuple[str, ...]:
        """The options that are something in this notation."""
        return (*self._names, *self.flags)

    def words(self, text: str) -> str:
        """A message in this notation; commands that generate are what stands for them."""
        text = self._run.sub(self._said, text)
        return _COMMAND.sub(lambda found: self.generating(unquoted(found["robot"]), ()), text)

    @abstractmethod
    def generating(self, robot: str, words: Sequence[str]) -> str:
        """What stands for a command that generates from a robot, its options in `words`."""

    @abstractmethod
    def alone(self, name: str, *, heading: bool) -> str:
        """A field without a value; `heading`: a colon follows."""

    @abstractmethod
    def assigned(self, name: str, value: str) -> str:
        """A field with its value, which is written as this notation has it."""

    @abstractmethod
    def table(self, values: Mapping[str, str | None]) -> str:
        """Names with their values, texts as they were typed (None: none given)."""

    def fields(self, text: str) -> list[str]:
        """What a message's options are, in the order of the message."""
        return [word for found in self._run.finditer(text) for word in self._fields(found)]

    def _said(self, found: re.Match[str]) -> str:
        words = self._fields(found)
        return (
            self.generating(unquoted(found["robot"]), words) if found["robot"] else ", ".join(words)
        )

    def _fields(self, found: re.Match[str]) -> list[str]:
        """Options that follow each other, those of one field together."""
        options = found[0][len(found["command"] or "") :]
        given: dict[str, list[str]] = {}
        for option, value in _ONE.findall(options):
            given.setdefault(option, []).extend([value] if value else [])
        heading = found.string[found.end() :].startswith(":")
        return [self._field(option, values, heading) for option, values in given.items()]

    def _field(self, option: str, values: Sequence[str], heading: bool) -> str:
        if option in self.flags:
            return self.flags[option]
        name = self._names[option]
        if not values:
            return self.alone(name, heading=heading)
        typed = [unquoted(value) for value in values]
        if option in self._texts:
            return self.assigned(name, quoted(typed[-1]))
        if option in self._lists:
            return self.assigned(name, _listed(typed))
        parted = [value.partition(_BY_NAME[option][1]) for value in typed]
        if any(sign for _, sign, _ in parted):
            values_by_name = {one: value if sign else None for one, sign, value in parted}
            return self.assigned(name, self.table(values_by_name))
        return self.assigned(name, self.names([one for one, _, _ in parted]))

    def names(self, names: Sequence[str]) -> str:
        """Names without values, as of joints to hold."""
        return _listed(names)


def _listed(texts: Sequence[str]) -> str:
    return f"[{', '.join(map(quoted, texts))}]"


def unquoted(value: str) -> str:
    """What a shell reads."""
    try:
        return "".join(shlex.split(value))
    except ValueError:
        return value


def quoted(text: str) -> str:
    """A text as Python, JSON and TOML all read it."""
    return json.dumps(text, ensure_ascii=False)
