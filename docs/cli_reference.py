"""Writes the tables of reference/cli.md after its mark: `python docs/cli_reference.py`."""

from __future__ import annotations

import re
from html import escape
from pathlib import Path

import click

from ikgen.cli.main import COMMANDS, ikgen
from ikgen.generation.emitters import EMITTERS

__all__ = ["PAGE", "filled_in"]

PAGE = Path(__file__).parent / "reference/cli.md"
_MARK = "<!-- made by docs/cli_reference.py -->"
_PIPE = "&#124;"


def filled_in(text: str) -> str:
    """The page's text with what follows the mark written anew."""
    head, mark, _ = text.partition(_MARK)
    assert mark, "the page has lost its mark"
    return "\n\n".join([head + _MARK, _outputs(), *(_command(name) for name in COMMANDS)]) + "\n"


def _outputs() -> str:
    rows = [f"| `{emitter.name}` | {emitter.words} |" for emitter in EMITTERS]
    return "\n".join(["| output | what it is |", "|---|---|", *rows])


def _command(name: str) -> str:
    context = click.Context(ikgen, info_name="ikgen")
    command = ikgen.get_command(context, name)
    assert command is not None
    own = click.Context(command, info_name=name, parent=context)
    usage = " ".join(command.get_usage(own).removeprefix("Usage: ").split())
    rows = [_row(own, p) for p in command.params if isinstance(p, click.Option)]
    words = " ".join((command.help or "").split())
    parts = [f"## {name}", f"`{usage}`", words]
    if rows:
        parts.append("\n".join(["| option | meaning |", "|---|---|", *rows]))
    return "\n\n".join(parts)


def _row(context: click.Context, option: click.Option) -> str:
    record = option.get_help_record(context)
    assert record is not None
    names, words = record
    words = re.sub(r"\s*\[x>=\d+\]|; x>=\d+", "", words)  # not in all versions of click
    several = " May be given several times." if option.multiple else ""
    cells = [_code(names), f"{words}{several}".replace("|", _PIPE)]
    return re.sub(r"\s+", " ", f"| {' | '.join(cells)} |")


def _code(text: str) -> str:
    """Code in a cell of a table: GitHub ends a cell at a pipe inside backticks, Python-Markdown shows the
    backslash before an escaped one; the reference of the character is a pipe to both."""
    return f"<code>{escape(text).replace('|', _PIPE)}</code>" if "|" in text else f"`{text}`"


if __name__ == "__main__":
    PAGE.write_text(filled_in(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
