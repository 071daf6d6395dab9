"""Cases of which a few run in every test run, and the others where `-m long` asks for them."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import Any

import pytest
from tests.support.solving import NO_COMPILER

__all__ = ["BOTH", "PYTHON_OFTEN", "in_languages", "sampled"]

COMPILES = pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "")
BOTH = pytest.mark.parametrize("language", ["python", pytest.param("cpp", marks=COMPILES)])
"""A test in either language."""
PYTHON_OFTEN = pytest.mark.parametrize(
    "language", ["python", pytest.param("cpp", marks=(COMPILES, pytest.mark.long))]
)
"""The same, of which C++ is for `-m long`."""


def sampled(names: Iterable[Any], always: Collection[Any]) -> list[Any]:
    """Parameters of a test: each of the names, those that do not run always marked `long`."""
    names = list(names)
    strange = set(always) - set(names)
    assert not strange, f"no such cases: {strange}"
    return [pytest.param(n, marks=() if n in always else pytest.mark.long) for n in names]


def in_languages(
    names: Iterable[str], compiled: Collection[str], rare: Collection[str] = ()
) -> list[Any]:
    """Parameters of a test, a name and a language: all in Python, of which the `rare` are marked `long`; in
    C++, which takes seconds to compile, the others than those `compiled` are."""
    names = list(names)
    strange = set(rare) - set(names)
    assert not strange, f"no such cases: {strange}"
    cases = []
    for kind in sampled(names, compiled):
        (name,) = kind.values
        cases.append(pytest.param(name, "python", marks=pytest.mark.long if name in rare else ()))
        cases.append(pytest.param(name, "cpp", marks=(*kind.marks, COMPILES)))
    return cases
