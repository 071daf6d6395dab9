"""Arithmetic whose results stay small enough to hold: sizes are known before they are computed."""

from __future__ import annotations

import operator
import re
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from ikgen.importers.xacro.refusals import RefusedExpressionError

__all__ = ["LARGEST", "MOST_BITS", "OPERATORS", "checked", "gathered", "size_of"]

LARGEST = 100_000
"""The most values that one value of an expression may hold; ten characters count as one."""

MOST_BITS = 4096
"""The most bits of an integer."""

_CHARACTERS_A_VALUE = 10
# A width or precision of four digits or out of the arguments, or a value that is named: those can
# be repeated without end.
_WIDE_FORMAT = re.compile(r"%\(|%[^%a-zA-Z]*(\d{4}|\*)")


def size_of(value: Any, most: int = LARGEST) -> int:
    """How many values a value holds, itself included; counting stops beyond `most`."""
    size = 0
    waiting = [value]
    while waiting and size <= most:
        one = waiting.pop()
        size += 1
        if isinstance(one, str):
            size += len(one) // _CHARACTERS_A_VALUE
        elif isinstance(one, range):
            size += len(one)
        elif isinstance(one, dict) and _is_data(one):
            waiting += dict.keys(one)
            waiting += dict.values(one)
        elif isinstance(one, list | tuple | set | frozenset):
            waiting += list.__iter__(one) if isinstance(one, list) else one
    return size


def _is_data(value: dict[Any, Any]) -> bool:
    # xacro's namespaces are dictionaries with a parent: they hold functions, and are no values.
    return not hasattr(type(value), "top")


def checked(value: Any) -> Any:
    """The value; raises `RefusedExpressionError` where it is too large."""
    if isinstance(value, int):
        if value.bit_length() > MOST_BITS:
            raise RefusedExpressionError(f"computes an integer of more than {MOST_BITS} bits")
    elif not isinstance(value, float) and size_of(value) > LARGEST:
        raise RefusedExpressionError(f"computes more than {LARGEST:,} values or a text as long")
    return value


def gathered(values: Iterable[Any]) -> list[Any]:
    """The values as a list; raises `RefusedExpressionError` as soon as they are too many."""
    found: list[Any] = []
    size = 0
    for value in values:
        found.append(value)
        size += size_of(value)
        if size > LARGEST:
            raise RefusedExpressionError(f"computes more than {LARGEST:,} values")
    return found


def _power(left: Any, right: Any) -> Any:
    if isinstance(left, int) and isinstance(right, int) and right > 0:
        _require_bits(left.bit_length() * right)
    return left**right


def _shift(left: Any, right: Any) -> Any:
    if isinstance(left, int) and isinstance(right, int):
        _require_bits(left.bit_length() + right)
    return left << right


def _require_bits(bits: int) -> None:
    if bits > 2 * MOST_BITS:
        raise RefusedExpressionError(f"computes an integer of more than {MOST_BITS} bits")


def _multiply(left: Any, right: Any) -> Any:
    for sequence, count in ((left, right), (right, left)):
        repeated = isinstance(sequence, str | list | tuple) and isinstance(count, int)
        if repeated and size_of(sequence) * count > LARGEST:
            raise RefusedExpressionError(f"computes more than {LARGEST:,} values or a text as long")
    return left * right


def _modulo(left: Any, right: Any) -> Any:
    if isinstance(left, str) and _WIDE_FORMAT.search(left):
        raise RefusedExpressionError("formats a text to a width of thousands or by names")
    return left % right


OPERATORS: Mapping[str, Callable[..., Any]] = {
    "Add": operator.add,
    "Sub": operator.sub,
    "Mult": _multiply,
    "Div": operator.truediv,
    "FloorDiv": operator.floordiv,
    "Mod": _modulo,
    "Pow": _power,
    "LShift": _shift,
    "RShift": operator.rshift,
    "BitOr": operator.or_,
    "BitAnd": operator.and_,
    "BitXor": operator.xor,
    "UAdd": operator.pos,
    "USub": operator.neg,
    "Invert": operator.invert,
    "Not": operator.not_,
    "Eq": operator.eq,
    "NotEq": operator.ne,
    "Lt": operator.lt,
    "LtE": operator.le,
    "Gt": operator.gt,
    "GtE": operator.ge,
    "Is": operator.is_,
    "IsNot": operator.is_not,
    "In": lambda item, container: item in container,
    "NotIn": lambda item, container: item not in container,
}
"""Operator of the syntax tree -> its function."""
