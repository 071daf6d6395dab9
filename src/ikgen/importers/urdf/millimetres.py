"""Lengths of a description that look like mm: all of them, or those of a few joints."""

from __future__ import annotations

from collections.abc import Sequence

from ikgen.importers.xml_document import Place
from ikgen.model.joint_tree import Joint

__all__ = ["FARTHEST_JOINT", "note_millimetres"]

FARTHEST_JOINT = 20.0
"""Most (m) from a moving joint to the one before, along an axis: longer than the booms of robots."""

_TIMES = 30.0
"""So many times as far as all others no joint of a robot lies: a mast, say, that carries a small arm."""


def note_millimetres(joints: Sequence[Joint], place: Place) -> None:
    """Warns of joints that are farther from the one before than those of any robot: of each where most are
    not, else of all at once where they are several. They are kept as they are."""
    moving = [joint for joint in joints if joint.type.moves_on_one_axis]
    lengths = {joint.name: _length(joint) for joint in _carried(moving, joints)}
    near = [length for length in lengths.values() if 0.0 < length <= FARTHEST_JOINT]
    far = {name: length for name, length in lengths.items() if length > FARTHEST_JOINT}
    if len(far) < len(near) and min(far.values(), default=0.0) > _TIMES * max(near):
        lines = {joint.name: joint.line for joint in joints}
        for name, length in far.items():
            text = f"joint '{name}': its origin {length:g} m away looks like mm, others' like m"
            place.warn_at(lines[name], f"{text}: kept as it is")
        return
    apart = [abs(float(x)) for joint in moving for x in joint.T_parent_child[:3, 3]]
    apart = [x for x in apart if x > FARTHEST_JOINT]
    if len(apart) > 1:
        text = f"joints lie up to {max(apart):g} m apart: lengths look like mm: kept as they are"
        place.warn(None, text)


def _length(joint: Joint) -> float:
    """The largest coordinate (m) of a joint in its parent's frame."""
    return max(abs(float(x)) for x in joint.T_parent_child[:3, 3])


def _carried(moving: Sequence[Joint], joints: Sequence[Joint]) -> Sequence[Joint]:
    """The joints that move and those that they carry: what is fixed before stands anywhere in the world."""
    below: dict[str, list[Joint]] = {}
    for joint in joints:
        below.setdefault(joint.parent, []).append(joint)
    found = {joint.name for joint in moving}
    waiting = list(moving)
    while waiting:
        new = [one for one in below.get(waiting.pop().child, []) if one.name not in found]
        found.update(joint.name for joint in new)
        waiting += new
    return [joint for joint in joints if joint.name in found]
