"""Depfiles: which outputs depend on which files, as a Makefile rule that build tools read."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import ikgen

__all__ = ["depfile_text", "write_depfile"]

_VERSION = Path(ikgen.__file__)
"""An update writes it anew."""


def depfile_text(targets: str | Sequence[Path], inputs: Sequence[Path]) -> str:
    """The rule; paths absolute, but for targets given as a text."""
    left = _escaped(targets) if isinstance(targets, str) else _listed(targets)
    return f"{left}: {_listed(inputs)}\n"


def write_depfile(path: Path, targets: str | Sequence[Path], inputs: Sequence[Path]) -> None:
    """Write the rule to a file. The outputs depend on ikgen's version too: on the file that states it."""
    text = depfile_text(targets, [*inputs, _VERSION])
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8", newline="\n")


def _listed(paths: Sequence[Path]) -> str:
    return " ".join(_escaped(path.resolve().as_posix()) for path in dict.fromkeys(paths))


def _escaped(text: str) -> str:
    for plain, written in (("\\", "\\\\"), (" ", "\\ "), ("#", "\\#"), ("$", "$$")):
        text = text.replace(plain, written)
    return text
