"""A joint that follows another: `SOURCE*k+c`. The standard library alone: configs hold such texts."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

__all__ = ["Mimic", "read_relation"]

_NUMBER = r"(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_RELATION = re.compile(
    rf"(?P<source>[^*]+?)(?:\*(?P<k>[+-]?{_NUMBER})(?P<c>[+-]{_NUMBER})?)?", re.ASCII
)


@dataclass(frozen=True, slots=True)
class Mimic:
    """`value = multiplier * value(joint) + offset` (URDF `<mimic>`), in rad or m."""

    joint: str
    multiplier: float
    offset: float

    @property
    def words(self) -> str:
        """As `read_relation` reads it."""
        return f"{self.joint}*{self.multiplier!r}{self.offset:+}"


def read_relation(text: str) -> Mimic:
    """The relation of a text `SOURCE`, `SOURCE*k` or `SOURCE*k+c`; raises `ValueError` for another."""
    found = _RELATION.fullmatch(text.strip())
    if found is None:
        raise ValueError(f"'{text}' is not SOURCE*k+c with numbers k and c")
    relation = Mimic(found["source"].strip(), float(found["k"] or 1), float(found["c"] or 0))
    if not math.isfinite(relation.multiplier) or not math.isfinite(relation.offset):
        raise ValueError(f"'{text}' holds no finite number")
    if relation.multiplier == 0.0:
        raise ValueError(f"'{text}' holds the joint still: lock it instead")
    return relation
