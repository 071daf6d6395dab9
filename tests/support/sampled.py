"""Cases of which a few run in every test run, and the others where `-m long` asks for them."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import Any

import pytest

__all__ = ["sampled"]


def sampled(names: Iterable[Any], always: Collection[Any]) -> list[Any]:
    """Parameters of a test: each of the names, those that do not run always marked `long`."""
    names = list(names)
    strange = set(always) - set(names)
    assert not strange, f"no such cases: {strange}"
    return [pytest.param(n, marks=() if n in always else pytest.mark.long) for n in names]
