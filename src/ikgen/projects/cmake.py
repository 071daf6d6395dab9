"""Where the CMake package and the ament package are."""

from __future__ import annotations

from pathlib import Path

from ikgen.errors import MissingToolError

__all__ = ["ament_directory", "cmake_directory"]


def cmake_directory() -> Path:
    """The directory of ikgenConfig.cmake: in an installed package, beside `src` in a checkout."""
    return _holding("cmake", "ikgenConfig.cmake")


def ament_directory() -> Path:
    """The ament package ikgen_ament, to be copied into a workspace."""
    return _holding("ament/ikgen_ament", "package.xml")


def _holding(name: str, file: str) -> Path:
    package = Path(__file__).resolve().parent.parent
    for templates in (package / "templates", package.parent.parent / "templates"):
        if (templates / name / file).is_file():
            return templates / name
    raise MissingToolError(
        f"this installation lacks {name}/{file}",
        hint=f"reinstall ikgen: its wheel carries it in ikgen/templates/{name}",
    )
