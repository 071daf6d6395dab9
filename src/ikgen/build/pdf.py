"""A LaTeX text as PDF, where LaTeX is installed."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from pathlib import Path

__all__ = ["compile_latex"]

_SECONDS = 120
_RUNS = 2  # the second resolves references


def compile_latex(source: Path) -> Path | None:
    """Make the PDF beside a .tex file; None where there is no LaTeX or it fails.

    The same text gives the same bytes: LaTeX is told a fixed date, and shell escapes are off.
    """
    latex = shutil.which("pdflatex")
    if latex is None:
        return None
    environment = {**os.environ, "SOURCE_DATE_EPOCH": "0", "FORCE_SOURCE_DATE": "1"}
    with tempfile.TemporaryDirectory(prefix="ikgen-") as folder:
        shutil.copy(source, folder)
        command = [latex, "-no-shell-escape", "-interaction=batchmode", source.name]
        for _ in range(_RUNS):
            try:
                subprocess.run(
                    command, cwd=folder, env=environment, capture_output=True, timeout=_SECONDS
                )
            except subprocess.TimeoutExpired:
                return None
        made = Path(folder, source.stem + ".pdf")
        if not made.is_file():
            return None
        return Path(shutil.copy(made, source.with_suffix(".pdf")))
