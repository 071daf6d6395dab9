"""The kinematic family of a chain, from its DH rows; rounded constants count as what was meant.

Axes are numbered from 1 and compared with their neighbours. The families are those whose closed
forms differ: three axes that meet in a point (Pieper, The Kinematics of Manipulators under Computer
Control, 1968), three that are parallel, and the offset wrists that have neither.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction

from ikgen.model.dh import DHChain, DHRow, Length

__all__ = [
    "GeometryClass",
    "classify",
    "meets_previous",
    "parallel_to_previous",
    "same_line_as_previous",
]

_HALF = Fraction(1, 2)


@dataclass(frozen=True, slots=True)
class GeometryClass:
    """The family's short `name`, its `words`, and the facts behind it; axes are numbered from 1.

    Pairs and triples are given by their first axis: 2 in `parallel_pairs` means axes 2 and 3. Only
    revolute axes count in triples.
    """

    name: str
    words: str
    kinds: str
    parallel_pairs: tuple[int, ...]
    intersecting_pairs: tuple[int, ...]
    perpendicular_pairs: tuple[int, ...]
    same_line_pairs: tuple[int, ...]
    spherical_triples: tuple[int, ...]
    parallel_triples: tuple[int, ...]


def parallel_to_previous(row: DHRow) -> bool:
    """Whether the row's axis is exactly parallel to the previous row's (alpha = 0)."""
    return row.alpha.exact == 0


def _vanishes(length: Length) -> bool:
    """Whether a length is zero, or was meant to be."""
    return length.name is None or length.stray


def same_line_as_previous(row: DHRow) -> bool:
    """Whether the row's axis is the previous row's line (alpha = a = 0)."""
    return parallel_to_previous(row) and _vanishes(row.a)


def meets_previous(row: DHRow) -> bool:
    """Whether the row's axis meets the previous row's in one point (a = 0, alpha not 0)."""
    return not parallel_to_previous(row) and _vanishes(row.a)


def classify(dh: DHChain) -> GeometryClass:
    """The family of `dh` and the facts that make it one."""
    rows = dh.rows
    pairs = range(1, len(rows))
    kinds = "".join("R" if row.revolute else "P" for row in rows)
    turning = [k for k in range(1, len(rows) - 1) if kinds[k - 1 : k + 2] == "RRR"]
    facts = GeometryClass(
        name="",
        words="",
        kinds=kinds,
        parallel_pairs=tuple(k for k in pairs if parallel_to_previous(rows[k])),
        intersecting_pairs=tuple(k for k in pairs if meets_previous(rows[k])),
        perpendicular_pairs=tuple(k for k in pairs if _perpendicular(rows[k])),
        same_line_pairs=tuple(k for k in pairs if same_line_as_previous(rows[k])),
        spherical_triples=tuple(k for k in turning if _spherical(rows[k : k + 2])),
        parallel_triples=tuple(
            k for k in turning if all(parallel_to_previous(row) for row in rows[k : k + 2])
        ),
    )
    name = "coupled" if len(rows) > dh.dof else _family(facts)
    return replace(facts, name=name, words=_words(name, facts))


def _perpendicular(row: DHRow) -> bool:
    """Whether the row's axis is at a right angle to the previous row's, or was meant to be."""
    alpha = row.alpha.exact if row.alpha.exact is not None else row.alpha.near
    return alpha is not None and abs(alpha) == _HALF


def _spherical(rows: tuple[DHRow, ...]) -> bool:
    """Whether the axes of two rows and the one before meet in one point."""
    return all(meets_previous(row) for row in rows) and _vanishes(rows[0].d)


def _family(facts: GeometryClass) -> str:
    """The first family whose facts hold."""
    kinds = facts.kinds
    if kinds == "R" * 6:
        return _six_revolute(facts)
    if kinds == "R" * 7:
        return _seven_revolute(facts)
    if set(kinds) == {"P"}:
        return "gantry"
    if kinds == "RRPR" and facts.parallel_pairs == (1, 2, 3):
        return "SCARA"
    if len(kinds) in (4, 5) and facts.parallel_triples:
        return f"{len(kinds)}-DOF three parallel"
    if len(kinds) > 6:
        return "redundant with prismatic" if "P" in kinds else "redundant"
    return f"{len(kinds)}-DOF {kinds}"


def _six_revolute(facts: GeometryClass) -> str:
    spherical, meeting = facts.spherical_triples, facts.intersecting_pairs
    if 4 in spherical:
        ortho_parallel = 2 in facts.parallel_pairs and 1 in facts.perpendicular_pairs
        return "6R spherical wrist, ortho-parallel" if ortho_parallel else "6R spherical wrist"
    if 1 in spherical:
        return "6R spherical shoulder"
    if spherical:
        return "6R spherical middle"
    if 2 in facts.parallel_triples:
        plain = 4 in meeting and 5 in meeting
        return f"6R three parallel 2-4, {'orthogonal' if plain else 'offset'} wrist"
    if facts.parallel_triples:
        return "6R three parallel elsewhere"
    if 2 in facts.parallel_pairs and meeting:
        return "6R offset wrist"
    return "6R general"


def _seven_revolute(facts: GeometryClass) -> str:
    if 1 in facts.spherical_triples and 5 in facts.spherical_triples:
        return "7R S-R-S"
    return "7R one spherical triple" if facts.spherical_triples else "7R no spherical triple"


def _words(name: str, facts: GeometryClass) -> str:
    """The facts as one sentence, most telling first."""
    parts = [
        *(_triple_words(k, facts) for k in facts.spherical_triples),
        *(f"axes {first}-{last} parallel" for first, last in _runs(facts.parallel_triples)),
    ]
    told = {k + step for k in facts.parallel_triples for step in (0, 1)}
    parallel = [k for k in facts.parallel_pairs if k not in told and k not in facts.same_line_pairs]
    parts += [f"axes {k} and {k + 1} parallel" for k in parallel]
    parts += [f"axes {k} and {k + 1} on one line" for k in facts.same_line_pairs]
    met = {k + step for k in facts.spherical_triples for step in (0, 1)}
    meeting = [f"{k}&{k + 1}" for k in facts.intersecting_pairs if k not in met]
    if meeting:
        parts.append(f"{', '.join(meeting)} meet")
    if 1 in facts.perpendicular_pairs and 2 in facts.parallel_pairs:
        parts.append("1 perpendicular to 2: ortho-parallel base")
    return f"{name}: {', '.join(parts)}" if parts else f"{name}: no special axes"


def _runs(triples: Sequence[int]) -> list[tuple[int, int]]:
    """The first and last axes of runs that triples, in order and named by their first, make up."""
    out: list[tuple[int, int]] = []
    for k in triples:
        first = out.pop()[0] if out and out[-1][1] == k + 1 else k
        out.append((first, k + 2))
    return out


def _triple_words(k: int, facts: GeometryClass) -> str:
    place = "wrist" if k == len(facts.kinds) - 2 else "shoulder" if k == 1 else "triple"
    return f"spherical {place} (axes {k}-{k + 2} meet)"
