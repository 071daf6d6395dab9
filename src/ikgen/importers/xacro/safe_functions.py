"""Functions for expressions in place of Python's own, none of them lazy or without bounds."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from ikgen.importers.xacro.bounded_values import LARGEST, OPERATORS, checked, gathered
from ikgen.importers.xacro.refusals import RefusedExpressionError
from ikgen.model.counted import with_article

__all__ = ["MATH", "PYTHON", "tokenize"]

_LARGEST_FACTORIAL = 400
_MOST_DIGITS = 400


def _range(*bounds: int) -> range:
    found = range(*bounds)
    if abs(found.stop - found.start) // abs(found.step) > LARGEST:
        raise RefusedExpressionError(f"counts to more than {LARGEST:,}")
    return found


def _map(function: Callable[..., Any], *values: Iterable[Any]) -> list[Any]:
    return gathered(function(*one) for one in zip(*values, strict=False))


def _filter(function: Callable[..., Any] | None, values: Iterable[Any]) -> list[Any]:
    return [one for one in values if (one if function is None else function(one))]


def _enumerate(values: Iterable[Any], start: int = 0) -> list[tuple[int, Any]]:
    return list(enumerate(values, start))


def _zip(*values: Iterable[Any]) -> list[tuple[Any, ...]]:
    return list(zip(*values, strict=False))


def _reversed(values: Any) -> list[Any]:
    return list(reversed(values))


def _round(value: Any, digits: int | None = None) -> Any:
    if digits is not None and abs(digits) > _MOST_DIGITS:
        raise RefusedExpressionError(f"rounds to more than {_MOST_DIGITS} digits")
    return round(value, digits)


def _sum(values: Iterable[Any], start: Any = 0) -> Any:
    total = start
    for value in values:
        total = checked(total + value)
    return total


def _type(value: Any) -> type:
    for known in (bool, int, float, complex, str, list, dict, tuple, set):
        if isinstance(value, known):
            return known
    raise RefusedExpressionError(f"asks for the type of {with_article(type(value).__name__)}")


def _factorial(n: int) -> int:
    if n > _LARGEST_FACTORIAL:
        raise RefusedExpressionError(f"computes the factorial of more than {_LARGEST_FACTORIAL}")
    return math.factorial(n)


def _comb(n: int, k: int) -> int:
    return _factorial(n) // (_factorial(k) * _factorial(n - k)) if 0 <= k <= n else 0


def _perm(n: int, k: int | None = None) -> int:
    chosen = n if k is None else k
    return _factorial(n) // _factorial(n - chosen) if 0 <= chosen <= n else 0


def _prod(values: Iterable[Any], *, start: Any = 1) -> Any:
    product = start
    for value in values:
        product = checked(OPERATORS["Mult"](product, value))
    return product


def _lcm(*values: int) -> int:
    multiple = 1
    for value in values:
        multiple = checked(math.lcm(multiple, value))
    return multiple


def tokenize(text: str, sep: str = ",; ", skip_empty: bool = True) -> list[str]:
    """xacro's function of that name: a text split at any of the characters `sep`."""
    parts = re.split(f"[{re.escape(sep)}]", text)
    return [part for part in parts if part] if skip_empty else parts


PYTHON: Mapping[str, Any] = {
    **{
        function.__name__: function
        for function in (
            *(list, dict, len, str, float, int, bool, min, max, abs, all, any, complex, divmod),
            *(frozenset, isinstance, issubclass, ord, repr, set, slice, sorted, tuple),
        )
    },
    "True": True,
    "False": False,
    "enumerate": _enumerate,
    "filter": _filter,
    "map": _map,
    "range": _range,
    "reversed": _reversed,
    "round": _round,
    "sum": _sum,
    "type": _type,
    "zip": _zip,
}
"""The names of Python that expressions know."""

_MATH_IN_PLACE = {
    "comb": _comb,
    "factorial": _factorial,
    "lcm": _lcm,
    "perm": _perm,
    "prod": _prod,
}
MATH: Mapping[str, Any] = {
    name: _MATH_IN_PLACE.get(name, value)
    for name, value in vars(math).items()
    if not name.startswith("_")
}
"""The names of the module `math`."""
