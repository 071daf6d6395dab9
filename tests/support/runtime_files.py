"""The runtime's own files, as the emitters name them."""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import cache

from ikgen.emit.cpp.header_bundle import RUNTIME

__all__ = ["HEADERS", "MODULES", "chains", "included"]

HEADERS = sorted(path.relative_to(RUNTIME).as_posix() for path in RUNTIME.rglob("*.hpp"))
_PYTHON = RUNTIME.with_name("python")
MODULES = sorted(
    ".".join(path.relative_to(_PYTHON).with_suffix("").parts)
    for path in _PYTHON.rglob("*.py")
    if path.name != "__init__.py"
)


@cache
def included(header: str) -> frozenset[str]:
    """The headers that one includes, and those that these include."""
    own = re.findall(r'#include "(.+)"', (RUNTIME / header).read_text(encoding="utf-8"))
    return frozenset(own).union(*map(included, own))


def chains(headers: Iterable[str]) -> list[list[str]]:
    """The headers in few lists, in each of which every one includes all that stand before it: read in that
    order, none sees what it would not see alone."""
    found: list[list[str]] = []
    for header in sorted(headers, key=lambda one: (len(included(one)), one)):
        before = [chain for chain in found if chain[-1] in included(header)]
        if before:
            max(before, key=lambda chain: len(included(chain[-1]))).append(header)
        else:
            found.append([header])
    return found
