"""The rows with constants as the file has them wherever a closed form does not need exact ones.

Closed forms need axes that are parallel and axes that meet; whether the others are at 90 or at 89.9998
degrees changes nothing but a constant. Where a file rounds its angles, the rows of its exact geometry
say which axes those are, and all other constants are chosen anew, so that the rows come nearest to
the file's chain: mostly they are the file's chain then.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

from ikgen.kinematics.classify import classify, parallel_to_previous
from ikgen.kinematics.file_frames import frames_beside, largest_deviation
from ikgen.kinematics.nearest import FIELDS, Constant, end_motions, fit_rows
from ikgen.kinematics.rigid import inverse
from ikgen.kinematics.snapping import WRITTEN_IN_FULL, exact_angle, tidy, wrap_angle
from ikgen.model.dh import Angle, DHChain, DHRow, Length, Snap

__all__ = ["keep_constants", "keep_ends", "keep_lengths", "kept_constants", "stray_lengths"]

_NOISE = 1e-13
"""Changes (rad or m) up to this leave a constant exact that costs operations: pi/2 in twelve digits."""

_ROUND_OFF = 1e-13
"""The same for constants that cost none whatever their value: offsets and lengths."""

_SAME = 1e-12
"""Constants (rad or m) that agree to this share a name."""


def keep_constants(dh: DHChain, strays: frozenset[Constant] = frozenset()) -> DHChain:
    """`dh` with twists, lengths and offsets as near to the file's chain as can be.

    Axes that are parallel or meet in the rows stay so, but for `strays`: lengths that are zero in `dh`
    and need not be. Constants that change by round-off only stay exact. Chains in which a joint drives
    several rows come back as they are.
    """
    if len(dh.rows) > dh.dof:
        return dh
    return _fitted(dh, (*_constants(dh, strays), *end_motions(dh)))


def keep_lengths(dh: DHChain, strays: frozenset[Constant], turned_ends: bool) -> DHChain:
    """`dh` with lengths and offsets as near to the file's chain as can be, and twists as they are.

    `strays` as in `keep_constants`. Base and tool become those of the file with `turned_ends`; else only
    those of their lengths change that are not zero, as what reads a part of the pose needs.
    """
    if len(dh.rows) > dh.dof:
        return dh
    inner = tuple(c for c in _constants(dh, strays) if c[1] != "alpha")
    ends = (c for c in end_motions(dh) if turned_ends or _is_end_length(dh, c))
    return _fitted(dh, (*inner, *ends))


def _is_end_length(dh: DHChain, constant: Constant) -> bool:
    """Whether a motion of base or tool is along an axis, and not zero."""
    end, motion = constant
    X = inverse(dh.X_base) if end < 0 else dh.X_tip
    return motion[0] == "T" and bool(X["xyz".index(motion[1]), 3] != 0.0)


def _fitted(dh: DHChain, constants: tuple[Constant, ...]) -> DHChain:
    """`dh` with changed constants, of which those that change by round-off only stay exact."""
    first = fit_rows(dh, constants)
    rest = tuple(c for c in constants if abs(first.change[c]) > _least(dh, c))
    fitted = fit_rows(dh, rest) if len(rest) < len(constants) else first
    book = _Names()
    rows = tuple(_row(row, i, fitted.change, book) for i, row in enumerate(dh.rows))
    ends = fitted.X_base, fitted.X_tip
    frames = frames_beside(dh, rows, ends)
    kept = replace(dh, rows=rows, X_base=ends[0], X_tip=ends[1], file_frames=frames)
    kept = replace(kept, deviation=largest_deviation(kept))
    exact = max(kept.deviation) <= WRITTEN_IN_FULL
    left = () if exact else tuple(s for s in dh.snaps if s.after == 0.0)
    return replace(kept, snaps=left)


def keep_ends(dh: DHChain) -> DHChain:
    """`dh` with the base and the tool as near to the file's chain as can be, and the rows as they are."""
    fitted = fit_rows(dh, end_motions(dh))
    ends = fitted.X_base, fitted.X_tip
    frames = frames_beside(dh, dh.rows, ends)
    kept = replace(dh, X_base=ends[0], X_tip=ends[1], file_frames=frames)
    kept = replace(kept, deviation=largest_deviation(kept))
    return replace(kept, snaps=() if max(kept.deviation) <= WRITTEN_IN_FULL else dh.snaps)


def kept_constants(dh: DHChain) -> tuple[Snap, ...]:
    """The constants that `dh` has as the file rounds them, each once: name, value, and the value that
    was meant (rad or m)."""
    found: dict[str, Snap] = {}
    for row in dh.rows:
        for x in (row.alpha, row.a, row.d):
            if x.name is not None and x.rounded:
                sign = x.sign if isinstance(x, Length) else 1
                found.setdefault(x.name, Snap(x.name, sign * x.value, x.nominal))
    return tuple(found.values())


def _least(dh: DHChain, constant: Constant) -> float:
    """The change up to which a constant stays as it is."""
    i, field = constant
    if field in FIELDS:
        row = dh.rows[i]
        variable = field == ("theta" if row.revolute else "d")
        length = row.a if field == "a" else row.d
        costless = variable or (field != "alpha" and length.name is not None)
    else:
        costless = _is_end_length(dh, constant)
    return _ROUND_OFF if costless else _NOISE


def stray_lengths(dh: DHChain) -> frozenset[Constant]:
    """Lengths that are zero in the rows and that a closed form may do without: those of axes that
    meet outside of spherical triples, and the offset along each inner run of parallel axes."""
    rows, triples = dh.rows, classify(dh).spherical_triples
    bound = {c for k in triples for c in ((k, "a"), (k + 1, "a"), (k, "d"))}
    parallel = [parallel_to_previous(row) for row in rows]
    found = set()
    for i in range(1, len(rows)):
        if rows[i].a.name is None and not parallel[i]:
            found.add((i, "a"))
    n = len(rows)
    ends = [i for i in range(n) if i == n - 1 or not parallel[i + 1]]
    for before, last in pairwise(ends[:-1]):
        run = range(before + 1, last + 1)
        if all(rows[i].revolute and rows[i].d.name is None for i in run):
            found.add((last, "d"))
    return frozenset(found - bound)


def _constants(dh: DHChain, strays: frozenset[Constant]) -> tuple[Constant, ...]:
    """What may change, in order of preference where constants can stand in for each other."""
    out: list[Constant] = []
    for i, row in enumerate(dh.rows):
        out.append((i, "theta" if row.revolute else "d"))
    out += [(i, "alpha") for i, row in enumerate(dh.rows) if i and row.alpha.exact != 0]
    for i, row in enumerate(dh.rows):
        out += [(i, "a")] if row.a.name is not None or (i, "a") in strays else []
        out += [(i, "d")] if row.d.name is not None or (i, "d") in strays else []
    return tuple(dict.fromkeys(out))


class _Names:
    """Constants with a symbol, so that equal ones share it."""

    def __init__(self) -> None:
        self._angles: list[Angle] = []
        self._lengths: list[Length] = []

    def angle(self, value: float, near: Fraction | None, name: str) -> Angle:
        value = wrap_angle(_short(value))
        for known in self._angles:
            if abs(known.value - value) <= _SAME and known.near == near:
                return known
        self._angles.append(Angle(value, None, name, near=near))
        return self._angles[-1]

    def length(self, value: float, name: str, stray: bool) -> Length:
        value, sign = _short(value), 1 if value > 0 else -1
        for known in self._lengths:
            if abs(abs(known.value) - abs(value)) <= _SAME and known.stray == stray:
                return replace(known, value=sign * abs(known.value), sign=sign)
        self._lengths.append(Length(value, name, sign, stray=stray))
        return self._lengths[-1]


def _short(value: float) -> float:
    """`value` with the fewest decimals that are the same number to the fit's round-off."""
    for decimals in range(4, 13):
        short = round(value, decimals)
        if abs(short - value) <= 4e-15 * max(1.0, abs(value)):
            return short + 0.0
    return tidy(value)


def _row(row: DHRow, i: int, change: dict[Constant, float], book: _Names) -> DHRow:
    """The row with its changed constants."""
    alpha, a, d, offset = row.alpha, row.a, row.d, row.offset
    moved = change.get((i, "alpha"), 0.0)
    if moved or alpha.name is not None:
        near = alpha.exact if alpha.exact is not None else alpha.near
        alpha = book.angle(alpha.value + moved, near, f"alpha_{i}")
    a = _length(a, change.get((i, "a"), 0.0), f"a_{i}", book)
    if row.revolute:
        d = _length(d, change.get((i, "d"), 0.0), f"d_{i + 1}", book)
        assert isinstance(offset, Angle)
        moved = change.get((i, "theta"), 0.0)
        if moved:
            value = wrap_angle(_short(offset.value + moved))
            offset = exact_angle(value, 0.0, f"theta_offset_{i + 1}")
    else:
        assert isinstance(offset, Length)
        moved = change.get((i, "d"), 0.0)
        if moved:
            value = _short(offset.value + moved)
            offset = Length(value, f"d_offset_{i + 1}", 1 if value > 0 else -1)
    return replace(row, alpha=alpha, a=a, d=d, offset=offset)


def _length(length: Length, moved: float, name: str, book: _Names) -> Length:
    if not moved and length.name is None:
        return length
    return book.length(length.value + moved, name, length.name is None)
