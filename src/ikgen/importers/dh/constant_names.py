"""Quantities of a table's rows as constants of the chain: exact, or with the user's own names."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

from ikgen.importers.dh.entry_expression import Quantity, Terms
from ikgen.kinematics.snapping import SnapLog, exact_angle, tidy, wrap_angle
from ikgen.model.angle_function import cosine_and_sine
from ikgen.model.dh import Angle, Length

__all__ = ["SymbolTable", "symbol_of"]

_ZERO = 1e-12
_TEXTBOOK = re.compile(r"[A-Za-z]{1,5}_\d+[A-Za-z]?")
_TAKEN = re.compile(r"(seed|sigma|cos|sin)_.*")


def symbol_of(name: str) -> str:
    """The user's name as a symbol that no variable, keyword or macro of emitted code can be: a_2 stays, a2
    becomes a_2, and words, of whatever letters, get an underscore."""
    split = re.fullmatch(r"([A-Za-z]{1,5})(\d+)", name)
    if split:
        name = f"{split.group(1)}_{split.group(2)}"
    taken = _TAKEN.fullmatch(name) or not _TEXTBOOK.fullmatch(name)
    return f"{name}_" if taken else name


@dataclass
class SymbolTable:
    """Gives out names: the user's where a quantity is one parameter or its negative, else new ones
    from the place in the table (a_2: before joint 3). Equal quantities share a name."""

    log: SnapLog
    names: dict[str, object] = field(default_factory=dict)
    """Symbol -> what it stands for."""

    def length(self, q: Quantity, place: str) -> Length:
        """A quantity in m."""
        if not q.symbolic and abs(q.value) <= _ZERO:
            return Length(0.0, None)
        if q.single is not None:
            name, sign = q.single
            symbol = self._claim(symbol_of(name), ("user", name))
            return Length(q.value, symbol, int(sign), q.symbolic)
        first = q.terms[0][1] if q.terms else q.value
        sign = 1 if first > 0 else -1
        key = (
            tuple((n, f * sign) for n, f in q.terms), round(q.constant * sign, 12)
        )  # fmt: skip
        symbol = next((s for s, k in self.names.items() if k == key), "")
        symbol = symbol or self._claim(place, key)
        value = q.value if q.terms else sign * tidy(abs(q.value))
        return Length(value, symbol, sign, q.symbolic)

    def angle(self, q: Quantity, place: str, tolerance: float) -> Angle:
        """A quantity in rad; a number within `tolerance` of a multiple of pi/12 becomes that."""
        if not q.symbolic:
            found = exact_angle(q.value, tolerance, place)
            if found.exact is not None:
                near = found.value + wrap_angle(q.value - found.value)
                self.log.add(place, near, found.value)
                return found
        key: object = (q.terms, round(q.constant, 12))
        if q.single is not None and q.single[1] > 0:
            place, key = symbol_of(q.single[0]), ("user", q.single[0])
        symbol = next((s for s, k in self.names.items() if k == key), place)
        return Angle(wrap_angle(q.value), None, self._claim(symbol, key, turns=True), q.symbolic)

    def written(self) -> dict[str, str]:
        """What symbols stand for in the table's own names, where these are others: a name, or a sum."""
        found = {}
        for symbol, key in self.names.items():
            match key:
                case ("user", str(name)) if name != symbol:
                    found[symbol] = name
                case (tuple(terms), float(constant)) if terms:
                    found[symbol] = _sum_text(terms, constant)
        return found

    def _claim(self, symbol: str, key: object, *, turns: bool = False) -> str:
        """The symbol, with underscores where another quantity has it, or what `turns` needs besides: the
        names of its cosine and sine."""
        while True:
            functions = cosine_and_sine(symbol) if turns else ()
            needed: dict[str, object] = {symbol: key, **{f.name: f for f in functions}}
            if all(self.names.get(name, what) == what for name, what in needed.items()):
                self.names.update(needed)
                return symbol
            symbol += "_"


def _sum_text(terms: Terms, constant: float) -> str:
    """A quantity as a table would have it."""
    parts = [_product_text(name, factor) for name, factor in terms]
    parts += [f"{constant:.12g}"] if constant else []
    return " + ".join(parts).replace("+ -", "- ")


def _product_text(name: str, factor: float) -> str:
    """A name times a number."""
    if abs(factor) == 1.0:
        return name if factor > 0.0 else f"-{name}"
    return f"{factor:.12g}*{name}"
