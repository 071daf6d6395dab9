"""What `ikgen inspect` found, as a dictionary."""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from ikgen.library.dh_text import angle_text, length_text

if TYPE_CHECKING:
    from ikgen.derivation.advice import Attempt
    from ikgen.derivation.inspection import Inspection
    from ikgen.kinematics.classify import GeometryClass
    from ikgen.model.dh import DHChain, DHRow
    from ikgen.model.joint_tree import JointTree

__all__ = ["as_dict"]


def as_dict(found: Inspection) -> dict[str, Any]:
    """For --json."""
    record: dict[str, Any] = {"warnings": list(found.warnings)}
    if found.tree is not None:
        record |= _tree(found.tree)
        record["candidates"] = [asdict(candidate) for candidate in found.candidates]
        record["other_ends"] = list(found.other_ends)
    if found.dh is not None and found.geometry is not None:
        record["arm_angle"] = found.arm_angle
        record["chain"] = _chain(found.dh, found.geometry)
        own = found.calibration
        record["chain"]["calibration"] = None if own is None else own.words
    record["attempts"] = [_attempt(one) for one in found.attempts]
    why = found.hindrance
    record["hindrance"] = None if why is None else {"message": why.message, "hint": why.hint}
    return record


def _tree(tree: JointTree) -> dict[str, Any]:
    joints = [
        {
            "name": j.name,
            "type": j.type.value,
            "parent": j.parent,
            "child": j.child,
            "limits": [_finite(j.limits.lower), _finite(j.limits.upper)],
            "mimic": None if j.mimic is None else j.mimic.joint,
        }
        for j in tree.joints
    ]
    return {"robot": tree.name, "root": tree.root_link, "joints": joints}


def _attempt(attempt: Attempt) -> dict[str, Any]:
    return {
        "task": attempt.task,
        "free": list(attempt.free),
        "closed": attempt.closed,
        "weak": list(attempt.weak),
        "max_solutions": attempt.max_solutions,
        "order": list(attempt.order),
        "left": list(attempt.left),
        "options": attempt.options,
        "default": attempt.default,
        "ranking": attempt.ranking or None,
    }


def _chain(dh: DHChain, geometry: GeometryClass) -> dict[str, Any]:
    from ikgen.kinematics.kept import kept_constants

    names = [joint.name for joint in dh.joints]
    return {
        "base": dh.base_link,
        "tip": dh.tip_link,
        "dof": dh.dof,
        "joints": names,
        "geometry": {"name": geometry.name, "words": geometry.words},
        "base_transform": dh.X_base.tolist(),
        "tool_transform": dh.X_tip.tolist(),
        "dh": [_row(row) for row in dh.rows],
        "constants": dh.named_constants(),
        "snaps": [{"what": s.what, "before": s.before, "after": s.after} for s in dh.snaps],
        "kept": [{"what": s.what, "value": s.before, "meant": s.after} for s in kept_constants(dh)],
        "motors": [] if dh.transmission is None else list(dh.transmission.words(names)),
        "deviation": {"m": dh.deviation[0], "rad": dh.deviation[1]},
    }


def _row(row: DHRow) -> dict[str, Any]:
    return {
        "name": row.name,
        "type": row.kind,
        "alpha": {"text": angle_text(row.alpha), "value": row.alpha.value},
        "a": {"text": length_text(row.a), "value": row.a.value},
        "d": {"text": length_text(row.d), "value": row.d.value},
        "theta": {"text": angle_text(row.theta), "value": row.theta.value},
        "scale": row.scale,
        "offset": row.offset.value,
    }


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
