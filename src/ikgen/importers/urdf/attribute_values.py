"""Numbers as URDF attributes hold them, read strictly; a refusal has a reason and a hint."""

from __future__ import annotations

import math
import re

__all__ = ["BadValueError", "parse_number", "parse_numbers", "shortened"]

# Stricter than float(), which also takes 1_000 and nan; inf occurs in limits.
_NUMBER = re.compile(
    r"[+-]?(?:(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:e[+-]?[0-9]+)?|inf(?:inity)?)", re.IGNORECASE
)
# Three numbers with all 767 digits that a double can have, and room for spaces.
_SPACES = re.compile(r"[ \t\r\n]+")
_LONGEST_TEXT = 4000
_LONGEST_SHOWN = 60


class BadValueError(ValueError):
    """An attribute's text that is not the number or numbers it should be, and a way out."""

    def __init__(self, message: str, hint: str) -> None:
        super().__init__(message)
        self.hint = hint


def shortened(text: str, longest: int = _LONGEST_SHOWN) -> str:
    """A text as messages show it: its beginning, where it is longer than `longest`."""
    return text if len(text) <= longest else f"{text[:longest]}..."


def parse_numbers(
    text: str, count: int, *, finite: bool = True, largest: float = math.inf
) -> tuple[float, ...]:
    """`count` numbers separated by white space; raises `BadValueError`.

    `largest` is the greatest magnitude that a finite number may have.
    """
    shown = shortened(text)
    if len(text) > _LONGEST_TEXT:
        raise BadValueError(
            f"'{shown}' has {len(text)} characters", f"write {count} numbers in a few digits"
        )
    if "$(" in text or "${" in text:
        raise BadValueError(
            f"'{shown}' is a xacro expression",
            "this is a xacro file: rename it to .urdf.xacro, or expand it with xacro first",
        )
    numbers = tuple(_number(word, shown, finite) for word in _SPACES.split(text) if word)
    if len(numbers) != count:
        raise BadValueError(
            f"'{shown}' has {len(numbers)} numbers where {count} belong",
            f"write {count} numbers separated by spaces",
        )
    if any(largest < abs(number) < math.inf for number in numbers):
        raise BadValueError(f"'{shown}' is beyond {largest:g}", "write lengths in m, angles in rad")
    return numbers


def parse_number(text: str, *, finite: bool = True, largest: float = math.inf) -> float:
    """One number; raises `BadValueError`."""
    return parse_numbers(text, 1, finite=finite, largest=largest)[0]


def _number(word: str, shown: str, finite: bool) -> float:
    if _NUMBER.fullmatch(word):
        value = float(word)
        if not finite or abs(value) != float("inf"):
            return value
        raise BadValueError(f"'{shown}' is not finite", "write a finite number")
    if any(map(str.isspace, word)):
        hint = "a space in it is no plain one, as of text that was copied from a page: type it anew"
    elif "," in word:
        hint = "separate numbers by spaces, without commas"
    elif word.count(".") > 1:
        hint = f"'{shortened(word)}' has more than one decimal point"
    else:
        hint = "write plain decimal numbers separated by spaces"
    raise BadValueError(f"'{shortened(word)}' in '{shown}' is not a number", hint)
