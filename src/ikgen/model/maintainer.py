"""Who maintains a package, as `NAME <EMAIL>`."""

from __future__ import annotations

import re

from ikgen.errors import UsageError, shown

__all__ = ["checked_maintainer", "name_and_email"]

_FORM = re.compile(r" *([^<>]*[^<>\s]) *<([^<>@\s\"]+@[^<>@\s\"]+\.[^<>@\s.\"]+)> *")


def checked_maintainer(text: str) -> str:
    """The text; raises `UsageError` where it has not the form that ROS manifests need."""
    if not text.isprintable() or _FORM.fullmatch(text) is None:
        raise UsageError(
            f"{shown(text)} is not written NAME <EMAIL>",
            hint="for example 'Ada Lovelace <ada@example.com>'",
        )
    return text


def name_and_email(text: str) -> tuple[str, str]:
    """The parts of a text in that form."""
    found = _FORM.fullmatch(text)
    assert found is not None, text
    return found[1], found[2]
