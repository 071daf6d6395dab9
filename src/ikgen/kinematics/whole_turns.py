"""What whole turns of a joint do where mimic joints follow it.

A row's angle is `scale * q + offset` and counts modulo 2 pi. Where the variable that stands for a joint
has the scale ±1 and all rows turn whole multiples of it, `q + 2 pi` is the same configuration, and no
smaller step is. With another scale the step is `2 pi / |scale|`: a whole turn of the joint is then
another configuration, or one of several that are the same. Where that step is several turns, and the limits
leave out some of them, values are looked for inside the limits alone, and there is no step.
"""

from __future__ import annotations

import math

from ikgen.errors import UnsolvedChainError
from ikgen.model.dh import DHChain, DHRow
from ikgen.model.gear_ratio import MOST_PARTS, common_share, is_whole

__all__ = ["check_couplings", "middle_of", "most_parts", "period_of", "range_of"]

_WHOLE = 1e-12

_BEYOND = 1e-2
"""How far (rad) beyond its limits values of a joint are looked for: poses that lie on them have rows."""


_MOST_ROUND = 60
"""How many times a row turns, at most, where values are looked for on a circle of several turns."""


def period_of(dh: DHChain, joint: int) -> float:
    """How far apart (rad) values of the joint are that are the same configuration; 0 where none are, or
    where what the joint moves comes round together after several turns only, and its limits hold fewer."""
    rows, lead = _rows(dh, joint), dh.lead_row(joint)
    ratios = [row.scale / lead.scale for row in rows]
    if not lead.revolute or not all(map(is_whole, ratios)):
        return 0.0
    period, limits = 2.0 * math.pi / abs(lead.scale), dh.joints[joint].limits
    short = _alike(dh, joint) or abs(lead.scale) >= 1.0 - _WHOLE
    around = limits.upper - limits.lower + 2.0 * _BEYOND >= period
    return period if short or (around and max(map(abs, ratios)) <= _MOST_ROUND) else 0.0


def middle_of(dh: DHChain, joint: int) -> float:
    """The value (rad or m) that an arctangent's value is counted from: 0 where periods place it, else the
    middle of the limits, since they span one turn of what it stands for at most (`check_couplings`)."""
    row, limits = dh.lead_row(joint), dh.joints[joint].limits
    span = limits.upper - limits.lower
    if not row.revolute or period_of(dh, joint) or not math.isfinite(span):
        return 0.0
    return limits.lower + 0.5 * span


def _alike(dh: DHChain, joint: int) -> bool:
    """Whether all rows of the joint turn as fast as each other."""
    return all(abs(dh.follows(row)[0]) == 1.0 for row in _rows(dh, joint))


def range_of(dh: DHChain, joint: int) -> tuple[float, float]:
    """Where values of a joint's DH variable (rad) are looked for: on the whole circle, or, where several
    turns of the joint are on it and its rows do not turn alike, inside the limits."""
    lead, limits = dh.lead_row(joint), dh.joints[joint].limits
    half = (0.5 * (limits.upper - limits.lower) + _BEYOND) * abs(lead.scale)
    if _alike(dh, joint) or abs(lead.scale) >= 1.0 - _WHOLE or half >= math.pi:
        return -math.pi, math.pi
    middle = lead.scale * middle_of(dh, joint) + lead.offset.value
    return middle - half, middle + half


def most_parts(dh: DHChain) -> int:
    """How many times the variable that stands for a joint the fastest row turns, of all joints that
    turn."""
    return max((round(abs(dh.follows(row)[0])) for row in dh.rows if row.revolute), default=1)


def check_couplings(dh: DHChain) -> None:
    """Raises `UnsolvedChainError` where mimic joints make a joint's value no function of a pose: an angle
    and a length that follow one joint, a ratio that is no whole number, or limits wider than a period."""
    for joint in range(dh.dof):
        rows = _rows(dh, joint)
        cause = _cause(dh, joint, rows)
        if cause:
            name = dh.joints[joint].name
            raise UnsolvedChainError(
                f"no closed form for the mimic joints of '{name}': {cause[0]}",
                hint=_hint(dh, name, cause[1]),
            )


def _hint(dh: DHChain, name: str, other: str) -> str:
    """What would help; a joint that is locked leaves others to solve for only where others move."""
    if len(dh.free_indices) + 1 < dh.dof:
        return f"give --lock {name}=VALUE, which makes it a constant, or {other}"
    return f"give {other}"


def _cause(dh: DHChain, joint: int, rows: tuple[DHRow, ...]) -> tuple[str, str] | None:
    """Why the joint has no closed form, and what else than locking it would help."""
    lead = dh.lead_row(joint)
    for row in rows:
        if row.revolute != lead.revolute:
            text = f"of '{lead.name}' and '{row.name}' one turns and the other slides, so the equations are"
            return f"{text} not algebraic", "--base and --tip with one of the two between them"
    if lead.revolute and not all(is_whole(row.scale / lead.scale) for row in rows):
        return _odd_ratio(dh, joint, rows)
    limits, held = dh.joints[joint].limits, dh.joints[joint].name in dh.free
    if not lead.revolute or held or period_of(dh, joint):
        return None
    period = 2.0 * math.pi / abs(lead.scale)
    if limits.upper - limits.lower <= period * (1.0 + _WHOLE):
        return None
    names = " and ".join(dict.fromkeys(f"'{row.name}'" for row in rows))
    text = (
        f"{names} come round together, so a pose has solutions every {period:.6g} of "
        f"'{dh.joints[joint].name}', and the limits span {limits.upper - limits.lower:.6g}"
    )
    return text, f"limits that span {period:.6g} at most"


def _odd_ratio(dh: DHChain, joint: int, rows: tuple[DHRow, ...]) -> tuple[str, str]:
    """What is told of rows that turn in no ratio of whole numbers, and what would do: it names those of
    which that is true by themselves, else all."""
    own = dh.joints[joint].name
    slowest = min(rows, key=lambda row: abs(row.scale))
    ratios = {row.name: abs(row.scale / slowest.scale) for row in rows}
    odd = [name for name, x in ratios.items() if common_share([x]) == 1 and not is_whole(x)]
    named = [slowest.name, *(odd[:1] or (name for name in ratios if name != slowest.name))]
    turns = " : ".join(
        f"{abs(row.scale):.9g}" for name in named for row in rows if row.name == name
    )
    names = " and ".join(f"'{name}'" for name in named)
    followers = [name for name in named if name != own]
    text = (
        f"{names} turn in the ratio {turns}, and closed forms need a ratio of whole numbers up to "
        f"{MOST_PARTS:,}"
    )
    return text, f"--couple {followers[-1]}={own}*k with fewer digits"


def _rows(dh: DHChain, joint: int) -> tuple[DHRow, ...]:
    """The rows that a joint drives."""
    return tuple(row for row in dh.rows if row.driver == joint)
