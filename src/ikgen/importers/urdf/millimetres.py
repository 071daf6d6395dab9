"""Lengths of a description that are hardly in m: all of them, or those of a few joints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeVar

import numpy as np

from ikgen.importers.xml_document import Place
from ikgen.model.joint_tree import Joint, JointType

__all__ = ["longer_than_arms", "note_millimetres", "shorter_than_arms", "some_in_millimetres"]

_Name = TypeVar("_Name")

_FARTHEST = 20.0
"""Most (m) from a moving joint to the one before, along an axis: longer than the booms of robots. No arm's
links but the longest, a mast or a rail, add up to more."""

_NEAREST = 5e-3
"""Links (m) of no arm add up to less. Rows are right to 1e-9 m, which is no small part of shorter ones."""

_TIMES = 30.0
"""So many times as far as all others no joint of a robot lies: a mast, say, that carries a small arm."""


def note_millimetres(joints: Sequence[Joint], place: Place) -> None:
    """Warns of joints that are farther from the one before than those of any robot: of each where most are
    not, else of all at once where they are several. They are kept as they are."""
    moving = [joint for joint in joints if joint.type.moves_on_one_axis]
    lengths = {joint.name: _length(joint) for joint in _carried(moving, joints)}
    far = some_in_millimetres(lengths)
    if far:
        lines = {joint.name: joint.line for joint in joints}
        for name in far:
            where = f"joint '{name}': its origin {lengths[name]:g} m away"
            place.warn_at(lines[name], f"{where} looks like mm, others' like m: kept as it is")
        return
    if _longer_than_arms(joints):
        longest = max(map(_length, moving))
        text = f"joints lie up to {longest:g} m apart: lengths look like mm or cm: kept as they are"
        place.warn(None, text)
    if words := shorter_than_arms([_length(joint) + _travel(joint) for joint in joints]):
        place.warn(None, words)


def some_in_millimetres(lengths: Mapping[_Name, float]) -> list[_Name]:
    """Which lengths (m) are longer than those of any robot's links; none where most are."""
    near = [length for length in lengths.values() if 0.0 < length <= _FARTHEST]
    far = [name for name, length in lengths.items() if length > _FARTHEST]
    some = len(far) < len(near) and min((lengths[n] for n in far), default=0.0) > _TIMES * max(near)
    return far if some else []


def longer_than_arms(lengths: Sequence[float]) -> bool:
    """Whether links of these lengths (m) in a row are longer than those of any arm."""
    return sum(lengths) - max(lengths, default=0.0) > _FARTHEST


def shorter_than_arms(lengths: Sequence[float]) -> str:
    """What to tell where links and slides (m) are shorter than those of any arm; else ""."""
    total = sum(lengths)
    if not 0.0 < total < _NEAREST:
        return ""
    return (
        f"lengths add up to {1e3 * total:g} mm: kept as they are, but are they in m? "
        "Rows are right to 1e-6 mm, which may be too little for so small an arm"
    )


def _longer_than_arms(joints: Sequence[Joint]) -> bool:
    """Whether the coordinates of the origins of joints that move, from a root to some link, are."""
    below = _by_parent(joints)
    children = {joint.child for joint in joints}
    waiting = [(link, 0.0, 0.0) for link in below if link not in children]
    while waiting:
        link, total, longest = waiting.pop()
        for joint in below.pop(link, []):
            apart = np.abs(joint.T_parent_child[:3, 3]) * joint.type.moves_on_one_axis
            so_far, most = total + float(apart.sum()), max(longest, float(apart.max()))
            if so_far - most > _FARTHEST:
                return True
            waiting.append((joint.child, so_far, most))
    return False


def _by_parent(joints: Sequence[Joint]) -> dict[str, list[Joint]]:
    """Link -> the joints that it carries."""
    below: dict[str, list[Joint]] = {}
    for joint in joints:
        below.setdefault(joint.parent, []).append(joint)
    return below


def _length(joint: Joint) -> float:
    """The largest coordinate (m) of a joint in its parent's frame."""
    return max(abs(float(x)) for x in joint.T_parent_child[:3, 3])


def _travel(joint: Joint) -> float:
    """How far (m) a slide goes."""
    slides = joint.type is JointType.PRISMATIC
    return joint.limits.upper - joint.limits.lower if slides else 0.0


def _carried(moving: Sequence[Joint], joints: Sequence[Joint]) -> Sequence[Joint]:
    """The joints that move and those that they carry: what is fixed before stands anywhere in the world."""
    below = _by_parent(joints)
    found = {joint.name for joint in moving}
    waiting = list(moving)
    while waiting:
        new = [one for one in below.get(waiting.pop().child, []) if one.name not in found]
        found.update(joint.name for joint in new)
        waiting += new
    return [joint for joint in joints if joint.name in found]
