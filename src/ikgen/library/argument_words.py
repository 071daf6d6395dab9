"""What messages say of options of the command line, in the words of the library: as arguments of `load`.

Messages name options by what is typed, `--tip LINK`, whatever part of ikgen they come from. Here alone is
said which argument each is, so that who calls `ikgen.load` reads `tip="LINK"`.
"""

from __future__ import annotations

import json
import re
import shlex
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from ikgen.errors import BadDescriptionError, IkgenError

__all__ = ["PROSE", "argument_words", "in_argument_words", "option_names"]

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
"""Options that are given once a name: the argument, and what parts the name from its value."""

_FOLDERS = {"--package-path": "package_paths"}
_NAMES = {**_TEXTS, **_FOLDERS, **{option: name for option, (name, _) in _BY_NAME.items()}}
_FLAGS = {"--trust": "trust=True", "--no-verify": "verify=False"}

PROSE = frozenset(("and", "for", "makes", "only", "out", "still", "with", "writes"))
"""Words behind an option that is named without a value."""

_VALUE = r"(?!--)(?:'[^']*'|[^\s'`\",;:()]|:(?=\S))+"
_WITH_VALUE = "|".join(_NAMES)
_PART = rf"(?:{_WITH_VALUE})(?![\w-])(?: (?!(?:{'|'.join(PROSE)})\b){_VALUE})?"
_OPTION = rf"(?:{_PART}|(?:{'|'.join(_FLAGS)})(?![\w-]))"
_RUN = re.compile(rf"(ikgen from-(?:urdf|dh) (?P<robot>{_VALUE}) ?)?{_OPTION}(?: {_OPTION})*")
_COMMAND = re.compile(rf"ikgen from-(?:urdf|dh) (?P<robot>{_VALUE})(?= *$| *\n)")
_ONE = re.compile(rf"(--[\w-]+)(?: (?!--)({_VALUE}))?")


def option_names() -> tuple[str, ...]:
    """The options that are an argument of `load`."""
    return (*_NAMES, *_FLAGS)


def argument_words(text: str) -> str:
    """A message, its options as arguments of `load`, and commands that generate as calls of it."""
    text = _RUN.sub(_as_arguments, text)
    return _COMMAND.sub(lambda found: f"ikgen.load({_literal(found['robot'])})", text)


@contextmanager
def in_argument_words() -> Iterator[None]:
    """Errors that pass speak of arguments."""
    try:
        yield
    except IkgenError as error:
        error.message, error.hint = argument_words(error.message), argument_words(error.hint)
        error.warnings = tuple(map(argument_words, error.warnings))
        error.args = (error.message,)
        if isinstance(error, BadDescriptionError):
            error.problem = argument_words(error.problem)
        raise


def _as_arguments(found: re.Match[str]) -> str:
    """Options that follow each other, those of one argument together; a call behind a command."""
    options = found[0][len(found[1] or "") :]
    given: dict[str, list[str]] = {}
    for option, value in _ONE.findall(options):
        given.setdefault(option, []).extend([value] if value else [])
    colon = found.string[found.end() :].startswith(":")
    words = [_argument(option, values, colon=colon) for option, values in given.items()]
    if found["robot"]:
        return f"ikgen.load({', '.join([_literal(found['robot']), *words])})"
    return ", ".join(words)


def _argument(option: str, values: Sequence[str], *, colon: bool) -> str:
    """One argument; its name alone where no value is said, without its sign where it begins a sentence."""
    if option in _FLAGS:
        return _FLAGS[option]
    name = _NAMES[option]
    if not values:
        return name if colon else f"{name}="
    if option in _TEXTS:
        return f"{name}={_literal(values[-1])}"
    if option in _FOLDERS:
        return f"{name}=[{', '.join(map(_literal, values))}]"
    parted = [_unquoted(value).partition(_BY_NAME[option][1]) for value in values]
    if not any(sign for _, sign, _ in parted):
        names = [json.dumps(joint, ensure_ascii=False) for joint, _, _ in parted]
        return f"{name}={names[0]}" if len(names) == 1 else f"{name}=[{', '.join(names)}]"
    entries = [f"{json.dumps(joint, ensure_ascii=False)}: {_number(x)}" for joint, _, x in parted]
    return f"{name}={{{', '.join(entries)}}}"


def _number(text: str) -> str:
    """A value as Python writes it: a number, the word VALUE that stands for one, or else a text."""
    if text == "VALUE":
        return text
    try:
        float(text)
    except ValueError:
        return json.dumps(text, ensure_ascii=False) if text else "None"
    return text


def _unquoted(value: str) -> str:
    """What a shell reads."""
    try:
        return "".join(shlex.split(value))
    except ValueError:
        return value


def _literal(value: str) -> str:
    return json.dumps(_unquoted(value), ensure_ascii=False)
