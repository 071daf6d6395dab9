"""What a joint's value follows: `A*k1+B*k2+c`. The standard library alone: configs hold such texts."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

from ikgen.errors import UsageError

__all__ = ["Mimic", "Relation", "checked_relation", "read_relation"]

_NUMBER = r"(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_ALONE = re.compile(r"[^*]+")
_TERM = rf"(?P<source>[^*]+?)\*(?P<k>[+-]?{_NUMBER})(?=\s*[+-]|$)"
_FIRST, _NEXT = (
    re.compile(sign + _TERM, re.ASCII) for sign in ("(?P<sign>)", r"\s*(?P<sign>[+-])")
)
_CONSTANT = re.compile(rf"\s*[+-]\s*{_NUMBER}", re.ASCII)


@dataclass(frozen=True, slots=True)
class Mimic:
    """`value = multiplier * value(joint) + offset` (URDF `<mimic>`), in rad or m."""

    joint: str
    multiplier: float
    offset: float

    @property
    def words(self) -> str:
        """As `read_relation` reads it, no more than that needs."""
        number = repr(self.multiplier).removesuffix(".0")
        factor = "" if self.multiplier == 1.0 and not self.offset else f"*{number}"
        return f"{self.joint}{factor}" + (f"{self.offset:+}" if self.offset else "")


@dataclass(frozen=True, slots=True)
class Relation:
    """`value = sum(multiplier * source) + offset`, in rad or m; `terms` are the sources, each once, with
    their multipliers."""

    terms: tuple[tuple[str, float], ...]
    offset: float = 0.0

    def mimic(self, joint: str) -> Mimic | None:
        """The one other joint that `joint` follows by it. None where there are several sources, or where it
        is what the joint's own motor moves it by."""
        (source, multiplier), *others = self.terms
        own = source == joint
        return None if others or own else Mimic(source, multiplier, self.offset)


def checked_relation(text: str) -> str:
    """The text; raises `UsageError` where `read_relation` cannot read it."""
    try:
        read_relation(text)
    except ValueError as error:
        hint = "write SOURCE*k+c, for example stage_1*1+0, or elbow*1+shoulder*-1"
        raise UsageError(str(error), hint=hint) from None
    return text


def read_relation(text: str) -> Relation:
    """The relation of a text `SOURCE`, `SOURCE*k`, `SOURCE*k+c`, or of several sources `A*k1+B*k2+c`;
    raises `ValueError` for another."""
    relation = _parsed(text.strip())
    if relation is None:
        raise ValueError(f"'{text}' is not SOURCE*k+c with numbers k and c")
    sources = [source for source, _ in relation.terms]
    if not all(map(math.isfinite, (relation.offset, *(k for _, k in relation.terms)))):
        raise ValueError(f"'{text}' holds no finite number")
    if relation.terms == ((sources[0], 0.0),):
        raise ValueError(f"'{text}' holds the joint still: lock it instead")
    for source, multiplier in relation.terms:
        if multiplier == 0.0 or sources.count(source) > 1:
            what = "has the factor 0" if multiplier == 0.0 else "is named twice"
            raise ValueError(f"in '{text}' '{source}' {what}")
    return relation


def _parsed(text: str) -> Relation | None:
    if _ALONE.fullmatch(text):
        return Relation(((text, 1.0),))
    terms: list[tuple[str, float]] = []
    at = 0
    while found := (_NEXT if terms else _FIRST).match(text, at):
        size = float(found["k"])
        terms.append((found["source"].strip(), -size if found["sign"] == "-" else size))
        at = found.end()
    rest = text[at:]
    read = terms and all(source for source, _ in terms)
    if not read or (rest and not _CONSTANT.fullmatch(rest)):
        return None
    return Relation(tuple(terms), float("".join(rest.split()) or 0.0))
