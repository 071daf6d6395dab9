"""Names of emitted modules: which ones can be, and one made from a robot's name."""

from __future__ import annotations

import keyword

from ikgen.errors import UsageError, shown

__all__ = ["checked_module_name", "identifier", "is_module_name"]

_LONGEST = 100
"""Characters: names of files, of which it is the beginning, have at most 255."""


def is_module_name(name: str) -> bool:
    """Whether a Python module, a C++ namespace and their files can have that name."""
    return (
        len(name) <= _LONGEST
        and name.isascii()
        and name.isidentifier()
        and not keyword.iskeyword(name)
    )


def checked_module_name(name: str) -> str:
    """The name; raises `UsageError` with one that could be meant."""
    if not is_module_name(name):
        none = f"not an identifier of at most {_LONGEST} characters"
        what = "a keyword of Python" if keyword.iskeyword(name) else none
        hint = f"for example '{identifier(name)}'"
        raise UsageError(f"{shown(name)} is {what}", hint=hint)
    return name


def identifier(name: str) -> str:
    """A robot's name as a module name: lower case, letters, digits and underscores, not too long."""
    text = "".join(ch if ch.isascii() and ch.isalnum() else "_" for ch in name).strip("_").lower()
    text = text[:_LONGEST].rstrip("_")
    text = text if text and not text[0].isdigit() else f"robot_{text}".rstrip("_")
    return f"{text}_arm" if keyword.iskeyword(text) else text
