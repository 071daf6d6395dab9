"""Why no elimination solves six joints of which some turn several axes: the degree, or two of them."""

from __future__ import annotations

from collections import Counter

from ikgen.elimination.applies import axis_motions
from ikgen.elimination.coupled_plans import MOST_DEGREE, least_degree
from ikgen.elimination.loop_frames import held_frames
from ikgen.model.dh import DHChain

__all__ = ["coupled_refusal"]


def coupled_refusal(dh: DHChain) -> tuple[str, str] | None:
    """Why, in words, and a joint to make a constant; None where coupled joints are not the reason."""
    moving = [row for row in dh.rows if dh.joints[row.driver].name not in dh.free]
    drivers = Counter(row.driver for row in moving)
    several = [dh.joints[j].name for j, count in sorted(drivers.items()) if count > 1]
    one_row_each = len(dh.rows) - len(moving) == len(dh.free)
    if len(drivers) != 6 or not several or not one_row_each:
        return None
    if len(several) > 1:
        names = " and ".join(f"'{name}'" for name in several)
        cause = f"the joints {names} turn several axes each, and an elimination hides one"
        return cause, several[0]
    if not all(row.revolute for row in moving):
        return None
    degree = least_degree(held_frames(dh), axis_motions(dh, moving))
    if degree is None or degree <= MOST_DEGREE:
        return None
    name = several[0]
    cause = (
        f"'{name}' turns {max(drivers.values())} axes, at ratios that make the polynomial in its angle "
        f"of degree {degree}, and beyond {MOST_DEGREE} rounding leaves too little of its roots"
    )
    return cause, name
