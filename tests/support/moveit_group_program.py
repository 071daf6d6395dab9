"""Programs over the MoveIt plugin's sources, beside an arm and a planning group written by hand."""

from __future__ import annotations

from pathlib import Path

from tests.support.moveit_driver import STUBS
from tests.support.routines import compiled_header

from ikgen.emit.moveit import SOURCES

__all__ = ["compiled_beside_group"]

_GROUP = Path(__file__).parent / "moveit_group"


def compiled_beside_group(text: str, folder: Path, task: str = '-DTASK="pose"') -> Path:
    """The program of a source that includes them; warnings are errors. Skips without a compiler."""
    paths = (_GROUP, SOURCES, SOURCES / "include", STUBS / "common", STUBS / "hpp")
    return compiled_header(text, folder, task, *(f"-I{path}" for path in paths))
