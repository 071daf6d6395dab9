"""Where the templates are, and how they are filled in."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from ikgen.errors import IkgenError

if TYPE_CHECKING:
    import jinja2

__all__ = ["TURNING_MARKS", "environment", "folder_environment", "render", "template_folder"]

TURNING_MARKS = (0x61C, 0x200E, 0x200F, *range(0x202A, 0x202F), *range(0x2066, 0x206A))
"""Marks of Unicode that turn the direction of text around them."""

_TURNING = {mark: f"[U+{mark:04X}]" for mark in TURNING_MARKS}


def environment(language: str) -> jinja2.Environment:
    """The templates of one output language (`python`, `cpp`, ...); undefined names are errors.

    Raises IkgenError where the installation has no templates for the language.
    """
    return folder_environment(template_folder(language))


@cache
def folder_environment(folder: Path) -> jinja2.Environment:
    """The templates of a folder, for a language of another package; undefined names are errors."""
    import jinja2

    return jinja2.Environment(
        loader=jinja2.FileSystemLoader(folder),
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
        autoescape=False,
    )


def render(language: str, template: str, **values: object) -> str:
    """One template of a language, filled in; marks that turn the direction of text are told in words,
    since they make a line read as what it is not (CVE-2021-42574)."""
    return environment(language).get_template(template).render(**values).translate(_TURNING)


def template_folder(language: str) -> Path:
    """Where the templates of a language lie: a wheel carries them inside the package, a checkout has them
    beside `src`."""
    package = Path(__file__).resolve().parent.parent
    for folder in (package / "templates", package.parent.parent / "templates"):
        if (folder / language).is_dir():
            return folder / language
    raise IkgenError(
        f"no templates for '{language}' in this installation",
        hint="reinstall ikgen: its wheel carries them as ikgen/templates",
    )
