"""Which closed form the geometry of the moving axes lets expect, before anything is derived.

The classes are those of the literature: orientation apart from position (Pieper, The Kinematics of
Manipulators under Computer Control, 1968), three parallel axes, three axes through a point elsewhere,
and what is left to quartics and to the elimination of all joints but one.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence

from ikgen.kinematics.axis_relations import AxisRelations
from ikgen.model.dh import DHRow

__all__ = ["FORM_WORDS", "form_class", "is_two_branch"]

FORM_WORDS = (
    "position apart from rotation, two branches a step",
    "three parallel axes",
    "three axes through a point",
    "position apart from rotation, a quartic",
    "pairs of axes that are parallel or meet",
    "no special axes",
    "no special axes, with slides",
)
"""What each class is, the best closed form first."""

_APART, _PARALLEL, _MIDDLE, _QUARTIC, _PAIRS, _NONE, _SLIDES = range(len(FORM_WORDS))


def is_two_branch(form: int) -> bool:
    """Whether a class lets expect two branches a step."""
    return form <= _MIDDLE


def form_class(rows: Sequence[DHRow], moving: Sequence[int], relations: AxisRelations) -> int:
    """The index in `FORM_WORDS` of a chain of which the rows `moving` (ascending) are not held.

    The relations are of all rows, so that held ones between may have any value.
    """
    apart = _rests(rows, moving, relations)
    if any(_two_branch(rows, rest, relations) for rest in apart):
        return _APART
    triples = list(zip(moving, moving[1:], moving[2:], strict=False))
    if any(
        {(i, j), (j, k)} <= relations.parallel and _turn(rows, (i, j, k)) for i, j, k in triples
    ):
        return _PARALLEL
    if relations.concurrent.intersection(triples):
        return _QUARTIC if apart else _MIDDLE
    pairs = set(itertools.pairwise(moving))
    if pairs & relations.parallel and pairs & relations.meeting:
        return _PAIRS
    return _NONE if all(rows[i].revolute for i in moving) else _SLIDES


def _turn(rows: Sequence[DHRow], indices: Sequence[int]) -> bool:
    return all(rows[i].revolute for i in indices)


def _rests(
    rows: Sequence[DHRow], moving: Sequence[int], relations: AxisRelations
) -> list[Sequence[int]]:
    """What is left to place a point for each way to take the rotation apart: three axes through one
    point at an end, or three slides anywhere, which leave the rotation alone."""
    rests: list[Sequence[int]] = []
    for end, rest in ((moving[-3:], moving[:-3]), (moving[:3], moving[3:])):
        if tuple(end) in relations.concurrent:
            rests.append(rest)
    slides = [i for i in moving if not rows[i].revolute]
    if len(moving) == 6 and len(slides) == 3:
        rests.append(slides)
    return rests


def _two_branch(rows: Sequence[DHRow], rest: Sequence[int], relations: AxisRelations) -> bool:
    """Whether joints that place a point do it without a quartic: two of three revolute axes that follow
    each other are parallel or meet, as are the two beside one slide; two slides always."""
    turning = [i for i in rest if rows[i].revolute]
    pairs = set(itertools.pairwise(turning))
    return len(turning) < 2 or bool(pairs & (relations.parallel | relations.meeting))
