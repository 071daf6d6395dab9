"""Who maintains a package, as `NAME <EMAIL>`."""

from __future__ import annotations

import re

__all__ = ["is_maintainer", "name_and_email"]

_FORM = re.compile(r" *([^<>]*[^<>\s]) *<([^<>@\s\"]+@[^<>@\s\"]+\.[^<>@\s.\"]+)> *")


def is_maintainer(text: str) -> bool:
    """Whether a text has the form that ROS manifests need."""
    return text.isprintable() and _FORM.fullmatch(text) is not None


def name_and_email(text: str) -> tuple[str, str]:
    """The parts of a text in that form."""
    found = _FORM.fullmatch(text)
    assert found is not None, text
    return found[1], found[2]
