"""A LaTeX text as PDF, where LaTeX is installed."""

from __future__ import annotations

import os
import re
import shutil
from dataclasses import dataclass
from pathlib import Path

from ikgen.processes.outside_program import run_program
from ikgen.processes.scratch_folder import ScratchFolder

__all__ = ["Typeset", "has_latex", "typeset"]

_LATEX = "pdflatex"
_RUNS = 2  # the second resolves references


@dataclass(frozen=True, slots=True)
class Typeset:
    """The PDF's bytes, or in words why there is none."""

    pdf: bytes | None = None
    failure: str = ""


def has_latex() -> bool:
    """Whether LaTeX is installed."""
    return shutil.which(_LATEX) is not None


def typeset(name: str, text: str) -> Typeset:
    """Typeset the text of a .tex file of this name in a folder that is then removed.

    The same text gives the same bytes: LaTeX is told a fixed date, and shell escapes are off.
    """
    latex = shutil.which(_LATEX)
    if latex is None:
        return Typeset(failure=f"{_LATEX} is not installed")
    environment = {**os.environ, "SOURCE_DATE_EPOCH": "0", "FORCE_SOURCE_DATE": "1"}
    with ScratchFolder("ikgen-") as folder:
        source = folder / Path(name).name
        source.write_text(text, encoding="utf-8", newline="\n")
        command = [latex, "-no-shell-escape", "-interaction=batchmode", source.name]
        for _ in range(_RUNS):
            done = run_program(command, cwd=folder, environment=environment)
            if done.late or done.crashed:
                return Typeset(failure=f"pdflatex {done.words}")
        made = source.with_suffix(".pdf")
        if done.code == 0 and made.is_file():
            return Typeset(made.read_bytes())
        return Typeset(failure=f"pdflatex fails: {_first_error(source.with_suffix('.log'))}")


def _first_error(log: Path) -> str:
    """The first error of LaTeX's log; its lines start with an exclamation mark."""
    text = log.read_text(encoding="utf-8", errors="replace") if log.is_file() else ""
    found = re.search(r"^! (.*)$", text, re.M)
    return found.group(1) if found else "its log names no error"
