"""The matrix equations that scalar equations come from, and how the report names their entries."""

from __future__ import annotations

import numpy as np

from ikgen.equations.equation import Equation
from ikgen.equations.equation_set import EquationSet
from ikgen.formulas import mathtext as m
from ikgen.formulas.mathtext import Math
from ikgen.report.document import Block, Formulas, Inline, Paragraph

__all__ = ["equation_anchor", "origin", "place", "splits_section"]

_WORDS = {
    "p.p": "squared length of column 4",
    "px2+py2": "sum of the squares of rows 1 and 2 of column 4",
    "qx2+qy2": "sum of the squares of rows 1 and 2 of column 4 of the inverse",
}
_MOST_FACTORS = 3


def splits_section(system: EquationSet) -> list[Block]:
    """How the equations are made, and what the tables of candidates say."""
    a, c, v = (m.name(letter, "i") for letter in "ACV")
    twist = m.function("Rot", m.name("x"), m.name("alpha", "i-1"))
    turn = m.function("Rot", m.name("z"), m.name("theta", "i"))
    link = twist + m.space() + m.function("Trans", m.name("x"), m.name("a", "i-1"))
    move = turn + m.space() + m.function("Trans", m.name("z"), m.name("d", "i"))
    words: list[Inline] = [
        "Row ", m.name("i"), " of the table is the matrix ", a + m.relation() + c + m.space() + v, " with ",
        c + m.relation() + link, " and ", v + m.relation() + move, ". Known joints are moved to the "
        "side of the pose: the split (k, m) moves the first k to its left and those after m to its "
        "right, for example:",
    ]  # fmt: skip
    k, last = min(1, system.n - 1), max(system.n - 1, 1)
    return [
        Paragraph(tuple(words)),
        Formulas((_matrices(system, k, max(last, k + 1)),)),
        Paragraph((
            "Each split gives 12 scalar equations and the norms in which whole rotations drop out. "
            "Those with one or two unknowns are compared with the forms that the leaves can solve. In "
            "the tables of candidates, (k,m) r12 is row 1, column 2 of a split, px to pz are rows 1 "
            "to 3 of column 4, qx to qz those of the inverse matrices; the least divisor is the "
            "smallest relative size of what the form divides by, over configurations where the arm "
            "is regular; the cost counts operations not computed before, each as often as there are "
            "branches to compute it for.",
        )),
    ]  # fmt: skip


def equation_anchor(e: Equation) -> str:
    """The place of a scalar equation in the document, for links: eq-3-4-py."""
    entry = "".join(ch if ch.isalnum() else "-" for ch in e.entry)
    return f"eq-{e.k}-{e.m}-{entry}"


def place(e: Equation) -> str:
    """Which split and which entry of it, in words."""
    return f"split ({e.k},{e.m}): {_entry(e.entry)}"


def _entry(entry: str) -> str:
    if entry in _WORDS:
        return _WORDS[entry]
    if entry[0] == "r":
        return f"row {entry[1]}, column {entry[2]}"
    row = f"row {'xyz'.index(entry[1]) + 1}, column 4"
    return f"{row} of the inverse" if entry[0] == "q" else row


def origin(system: EquationSet, sources: tuple[Equation, ...]) -> list[Block]:
    """The matrix equations that a candidate was taken from, and which of their entries."""
    splits: dict[tuple[int, int], list[str]] = {}
    for e in dict.fromkeys(sources):
        splits.setdefault((e.k, e.m), []).append(_entry(e.entry))
    out: list[Block] = []
    for i, ((k, last), entries) in enumerate(splits.items()):
        where = f"{', and '.join(entries)} of the split ({k},{last}):"
        lead = f"and {where}" if i else where[0].upper() + where[1:]
        out += [Paragraph((lead,)), Formulas((_matrices(system, k, last),))]
    return out


def _matrices(system: EquationSet, k: int, last: int) -> Math:
    """`[A_1 ... A_k C_{k+1}]^-1 T_d [A_{m+1} ... A_n]^-1 = V_{k+1} A_{k+2} ... A_m`."""
    dh, n = system.dh, system.n
    row = dh.rows[k]
    whole = row.alpha.exact == 0 and row.a.name is None
    tool = system.tool_on_right and not np.array_equal(dh.X_tip, np.eye(4))
    end = [m.name("E")] if tool else []
    taken = [*_product(1, k), *([] if whole else [m.name("C", str(k + 1))])]
    left = [*_inverse(taken), m.name("T", "d")]
    left += _inverse([*_product(last + 1, n), *end]) if last < n else []
    right = [m.name("A" if whole else "V", str(k + 1)), *_product(k + 2, last)]
    right += end if last == n else []
    return m.join(left, m.space()) + m.relation() + m.join(right, m.space())


def _product(first: int, last: int) -> list[Math]:
    if last - first + 1 <= _MOST_FACTORS:
        return [m.name("A", str(i)) for i in range(first, last + 1)]
    return [m.name("A", str(first)), m.dots(), m.name("A", str(last))]


def _inverse(factors: list[Math]) -> list[Math]:
    if len(factors) <= 1:
        return [m.power(factor, -1) for factor in factors]
    return [m.power(m.group(m.join(factors, m.space())), -1)]
