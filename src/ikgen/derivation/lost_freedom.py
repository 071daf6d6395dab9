"""Joints that move the tip in fewer ways than they are, in words."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

from ikgen.model.counted import counted, some_of_them
from ikgen.model.oddity import OddityKind

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from ikgen.emit.derivation import Reading
    from ikgen.model.dh import DHChain

__all__ = ["lost_freedom"]

_MOST = 6
"""Joints of an arm of which each may have a freedom of its own: of more it is no surprise."""


def lost_freedom(reading: Reading, asked: Collection[str], chosen: Collection[str] = ()) -> str:
    """Which joints of an arm with six at most move its tip in fewer ways than they are, wherever they
    stand, and why, where their axes say it; "" where all are independent, where one of these is held
    because it was `asked` for, or where a warning of the file says so. Some were `chosen` to be held."""
    dh = reading.dh
    found = _dependent(dh) if dh.dof <= _MOST else None
    if found is None or any(one.kind is OddityKind.ENDLESS for one in reading.source.warnings):
        return ""
    joints, ways = found
    if not {dh.joints[j].name for j in joints}.isdisjoint(asked):
        return ""
    held = [f"'{dh.joints[j].name}'" for j in joints if dh.joints[j].name in chosen]
    *names, last = (f"'{dh.joints[j].name}'" for j in joints)
    number, reason = counted(ways, "way"), _reason(dh, joints)
    way_out = f" unless {some_of_them(len(joints) - ways, 'is', 'are')} held or locked"
    if len(held) >= len(joints) - ways:
        way_out = f", so {' and '.join(held)} {'is' if len(held) == 1 else 'are'} held"
    return (
        f"joints {', '.join(names)} and {last} move the tip in {number} only"
        f"{f', as they {reason}' * bool(reason)}: a pose has infinitely many solutions{way_out}"
    )


def _dependent(dh: DHChain) -> tuple[tuple[int, ...], int] | None:
    """The fewest joints that are not independent, and in how many ways they move the tip."""
    from ikgen.tasks import POSE
    from ikgen.tasks.fitting import motion_ratios, rank, scaled_motion

    motion = scaled_motion(dh, POSE)
    for count in range(2, dh.dof + 1):
        for joints in combinations(range(dh.dof), count):
            ways = rank(motion_ratios(motion[None, :, :, list(joints)])[0])
            if ways < count:
                return joints, ways
    return None


def _reason(dh: DHChain, joints: Sequence[int]) -> str:
    """What their axes have in common; "" where that does not say it, or where some turn several."""
    from ikgen.kinematics.axis_relations import axis_relations

    rows = [i for i, row in enumerate(dh.rows) if row.driver in joints]
    if len(rows) != len(joints):
        return ""
    turning = [dh.rows[i].revolute for i in rows]
    relations = axis_relations(dh)
    parallel = relations.parallel.issuperset(combinations(rows, 2))
    if not any(turning):
        return {2: "slide in one direction", 3: "slide in one plane"}.get(len(rows), "slide")
    if all(turning) and parallel:
        return "turn about one line" if len(rows) == 2 else "turn about parallel axes"
    if all(turning) and relations.concurrent.issuperset(combinations(rows, 3)) and len(rows) > 3:
        return "turn about axes through one point"
    return ""
