"""Rows of a DH table whose joints follow others."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

from ikgen.chains.related_joints import farthest_first, shared_limits
from ikgen.errors import UnknownNameError, UsageError
from ikgen.kinematics.rows import drive_row
from ikgen.model.dh import DHChain
from ikgen.model.joint_relation import Mimic

__all__ = ["related_dh"]


def related_dh(dh: DHChain, relations: Mapping[str, Mimic]) -> DHChain:
    """The chain with the relations; what follows another is no joint of its own any more.

    Raises `UnknownNameError` for a joint that is not there, `UsageError` for one that is held, that follows
    itself, or whose source cannot move it inside the limits.
    """
    for joint in farthest_first(relations):
        dh = _related(dh, joint, relations[joint])
    return dh


def _related(dh: DHChain, name: str, relation: Mimic) -> DHChain:
    names = [joint.name for joint in dh.joints]
    for one in (name, relation.joint):
        if one not in names:
            raise UnknownNameError("joint", one, names)
    if name in dh.free:
        raise UsageError(
            f"--couple {name}={relation.words}: joint '{name}' is held",
            hint="leave out --free for it",
        )
    follower, source = names.index(name), names.index(relation.joint)
    kept = [joint for joint in dh.joints if joint.name != name]
    limits = shared_limits(relation, name, dh.joints[follower].limits, dh.joints[source].limits)
    joints = tuple(
        replace(j, limits=limits, continuous=False) if j.name == relation.joint else j for j in kept
    )
    places = {names.index(joint.name): place for place, joint in enumerate(joints)}
    rows = []
    for number, row in enumerate(dh.rows, start=1):
        if row.driver == follower:
            row = drive_row(row, relation.multiplier, relation.offset, number)
            row = replace(row, driver=source)
        rows.append(replace(row, driver=places[row.driver]))
    return replace(dh, rows=tuple(rows), joints=joints)
