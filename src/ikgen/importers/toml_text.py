"""TOML texts, read by the standard library, or by what stands for it in Python 3.10."""

from __future__ import annotations

import sys
from typing import Any

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

__all__ = ["parse_toml"]


def parse_toml(text: str) -> dict[str, Any]:
    """The tables of a text, behind a byte order mark or not. Raises `ValueError` for what is no TOML,
    numbers of thousands of digits, and what is nested too deep."""
    try:
        tables: dict[str, Any] = tomllib.loads(text.removeprefix("\ufeff"))
    except RecursionError as error:
        raise ValueError(str(error)) from None
    return tables
