"""Attributes of values in expressions: entries of dictionaries, and methods that only compute."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from ikgen.importers.xacro.bounded_values import LARGEST, size_of
from ikgen.importers.xacro.refusals import RefusedExpressionError
from ikgen.model.counted import with_article

__all__ = ["attribute_of"]

_LONGEST_PADDED = 10_000

_TEXT_METHODS = frozenset(
    {
        *("capitalize", "casefold", "count", "endswith", "find", "index", "isalnum", "isalpha"),
        *("isdecimal", "isdigit", "isidentifier", "islower", "isnumeric", "isspace", "istitle"),
        *("isupper", "lower", "lstrip", "partition", "removeprefix", "removesuffix", "rfind"),
        *("rindex", "rpartition", "rsplit", "rstrip", "split", "splitlines", "startswith"),
        *("strip", "swapcase", "title", "upper"),
    }
)
_METHODS: tuple[tuple[type, frozenset[str]], ...] = (
    (str, _TEXT_METHODS),
    (dict, frozenset({"get", "items", "keys", "values"})),
    (list, frozenset({"count", "index"})),
    (tuple, frozenset({"count", "index"})),
    (int, frozenset({"bit_length", "real", "imag"})),
    (float, frozenset({"is_integer", "real", "imag"})),
    (complex, frozenset({"conjugate", "real", "imag"})),
)


def attribute_of(value: Any, name: str) -> Any:
    """`value.name`; raises `RefusedExpressionError` for what is neither an entry of a namespace or
    dictionary nor a method that only computes."""
    if name.startswith("_"):
        raise RefusedExpressionError(f"reaches for '{name}'")
    if hasattr(type(value), "top"):  # one of xacro's namespaces
        try:
            return value[name]
        except KeyError:
            raise NameError(f"name '{name}' is not defined") from None
    bounded = _BOUNDED.get(name) if isinstance(value, str) else None
    if bounded is not None:
        return lambda *arguments: bounded(value, *arguments)
    for type_, names in _METHODS:
        if isinstance(value, type_) and name in names:
            return getattr(value, name)
    if isinstance(value, dict):
        # Only the dictionaries that xacro makes of YAML have their entries as attributes.
        if hasattr(type(value), "__getattr__"):
            return value[name]
        raise AttributeError(f"'dict' object has no attribute '{name}'")
    raise RefusedExpressionError(
        f"reaches for the attribute '{name}' of {with_article(type(value).__name__)}"
    )


def _join(separator: str, parts: Any) -> str:
    texts = list(parts)
    if size_of(texts) + len(texts) * (len(separator) // 10 + 1) > LARGEST:
        raise RefusedExpressionError("joins too long a text")
    return separator.join(texts)


def _replace(text: str, old: str, new: str, count: int = -1) -> str:
    found = text.count(old) if count < 0 else min(count, text.count(old))
    if len(text) + found * len(new) > 10 * LARGEST:
        raise RefusedExpressionError("replaces to too long a text")
    return text.replace(old, new, count)


def _padded(method: str) -> Callable[..., str]:
    def pad(text: str, width: int, *fill: str) -> str:
        if width > _LONGEST_PADDED:
            raise RefusedExpressionError("pads to too long a text")
        return str(getattr(text, method)(width, *fill))

    return pad


_BOUNDED: Mapping[str, Callable[..., str]] = {
    "join": _join,
    "replace": _replace,
    **{method: _padded(method) for method in ("center", "ljust", "rjust", "zfill")},
}
