"""Where the CMake package is."""

from __future__ import annotations

from pathlib import Path

from ikgen.errors import MissingToolError

__all__ = ["cmake_directory"]


def cmake_directory() -> Path:
    """The directory of ikgenConfig.cmake: in an installed package, beside `src` in a checkout."""
    package = Path(__file__).resolve().parent.parent
    for folder in (package / "templates", package.parent.parent / "templates"):
        if (folder / "cmake" / "ikgenConfig.cmake").is_file():
            return folder / "cmake"
    raise MissingToolError(
        "this installation has no CMake files",
        hint="reinstall ikgen: its wheel carries them as ikgen/templates/cmake",
    )
