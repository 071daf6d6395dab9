"""All solutions of poses near singularities, and of those that leave joints free."""

from __future__ import annotations

import numpy as np

from ikgen.runtime.python.arm.solved_arm import Arm, Found
from ikgen.runtime.python.arrays.array_types import Array
from ikgen.runtime.python.rows.row_placement import place_rows
from ikgen.runtime.python.singular.limit_rows import rows_inside
from ikgen.runtime.python.singular.meeting_rows import repeats
from ikgen.runtime.python.solving.asked_poses import Answer, Asked
from ikgen.runtime.python.solving.doubtful_rows import FoundRows, add_new, led_to, rows_from
from ikgen.runtime.python.solving.rows_elsewhere import take_along, take_hidden, take_nearest

__all__ = ["placed_rows"]


def placed_rows(arm: Arm, asked: Asked, limits: bool) -> list[Answer]:
    """The rows of each pose, placed. Where it leaves a joint free and the given value leads nowhere, others
    are tried, and in the end the nearest pose's row; so too where limits leave none, but a continuum may go
    on inside, and where all that the closed form has is singular and leads to none."""
    out = [Answer() for _ in asked.T]
    left = np.arange(len(out))
    eliminated = arm.branches is None  # no joint has a value of its own then
    more = [] if eliminated else [range(1, arm.policy.tries)]
    for tries in (range(1), *more):
        if not len(left):
            break
        which = np.repeat(left, len(tries))
        some = asked.at(which)
        turn = np.tile(tries, len(left))
        start = some.starts(arm, turn * arm.policy.try_step)
        rows = rows_from(arm, some, start, turn)
        seeded = _seeded(arm, some, start, rows, limits) if asked.near is not None else {}
        going = np.ones(len(out), dtype=bool)
        for k, i in enumerate(which.tolist()):
            if going[i]:
                going[i] = _goes_on(arm, some, k, rows[k], seeded.get(k, []), limits, out[i])
        left = left[going[left]]
    if not (arm.rounded or eliminated) and len(left):
        take_hidden(arm, asked, left, limits, out)
    doubtful = set(left.tolist())
    doubtful |= {i for i, x in enumerate(out) if x.loose or (x.led and not x.real)}
    lost = sorted(i for i in doubtful if not out[i].rows)
    if lost:
        take_nearest(arm, asked, np.array(lost), limits, out)
    take_along(arm, asked, limits, out)
    return out


def _goes_on(
    arm: Arm,
    asked: Asked,
    k: int,
    rows: FoundRows,
    seeded: list[Found],
    limits: bool,
    answer: Answer,
) -> bool:
    """Adds rows to an answer, and says whether other values have to be tried."""
    (kept, free, led), near = rows, asked.seed(k)
    aim = asked.aim(arm, slice(k, k + 1))
    if not free and any(flag for _, flag in kept):
        kept[:] = [one for one in kept if not (one[1] and repeats(arm, aim[0], one[0], seeded))]
        add_new(arm, aim[0], seeded, kept)
    answer.real, answer.led = answer.real or bool(kept), answer.led or led
    answer.loose = [one for one in kept if one[1]] or answer.loose
    add_new(arm, aim[0], rows_inside(arm, aim, kept, near, limits), answer.rows)
    if not answer.rows:
        answer.rows = rows_inside(arm, aim, seeded, near, limits)
    led = led if arm.rounded else answer.stands
    return free and not (answer.rows and led)


def _seeded(
    arm: Arm, asked: Asked, start: Array, rows: list[FoundRows], limits: bool
) -> dict[int, list[Found]]:
    """What Newton steps from the seeds lead to, where no row is inside the limits, or one is singular."""
    some = [
        k
        for k, (kept, free, _) in enumerate(rows)
        if (not free and any(flag for _, flag in kept))
        or not place_rows(arm, kept, asked.seed(k), limits)
    ]
    return dict(zip(some, led_to(arm, asked.at(np.array(some, dtype=np.intp)), start[some])))
