"""Numbers as URDF attributes hold them, read strictly; a refusal has a reason and a hint."""

from __future__ import annotations

import re

__all__ = ["BadValueError", "parse_number", "parse_numbers"]

# Stricter than float(), which also takes 1_000 and nan; inf occurs in limits.
_NUMBER = re.compile(r"[+-]?(?:(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?|inf(?:inity)?)", re.IGNORECASE)


class BadValueError(ValueError):
    """An attribute's text that is not the number or numbers it should be, and a way out."""

    def __init__(self, message: str, hint: str) -> None:
        super().__init__(message)
        self.hint = hint


def parse_numbers(text: str, count: int, *, finite: bool = True) -> tuple[float, ...]:
    """`count` numbers separated by white space; raises `BadValueError`."""
    if "$(" in text or "${" in text:
        raise BadValueError(
            f"'{text}' is a xacro expression",
            "this is a xacro file: rename it to .urdf.xacro, or expand it with xacro first",
        )
    words = text.split()
    numbers = tuple(_number(word, text, finite) for word in words)
    if len(numbers) != count:
        raise BadValueError(
            f"'{text}' has {len(numbers)} numbers where {count} belong",
            f"write {count} numbers separated by spaces",
        )
    return numbers


def parse_number(text: str, *, finite: bool = True) -> float:
    """One number; raises `BadValueError`."""
    return parse_numbers(text, 1, finite=finite)[0]


def _number(word: str, text: str, finite: bool) -> float:
    if _NUMBER.fullmatch(word):
        value = float(word)
        if not finite or abs(value) != float("inf"):
            return value
        raise BadValueError(f"'{text}' is not finite", "write a finite number")
    if "," in word:
        hint = "separate numbers by spaces, without commas"
    elif word.count(".") > 1:
        hint = f"'{word}' has more than one decimal point"
    else:
        hint = "write plain decimal numbers separated by spaces"
    raise BadValueError(f"'{word}' in '{text}' is not a number", hint)
