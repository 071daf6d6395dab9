"""A robot's joint tree and its DH rows as text."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from ikgen.cli.tables import table
from ikgen.library.dh_text import row_texts

if TYPE_CHECKING:
    from ikgen.model.arrays import Array
    from ikgen.model.dh import Angle, DHChain, Length
    from ikgen.model.joint_tree import Joint, JointTree, Limits

__all__ = ["dh_table", "joint_tree", "transform_text"]

_WIDEST = 120
"""Characters of indent; what lies deeper is not indented further."""


def joint_tree(tree: JointTree) -> str:
    """Links and joints, one a line, below their parents."""
    below: dict[str, list[Joint]] = {}
    for joint in tree.joints:
        below.setdefault(joint.parent, []).append(joint)

    lines = [tree.root_link]
    waiting = _hanging(below, tree.root_link, "")
    while waiting:
        joint, indent, last = waiting.pop()
        lines.append(f"{indent}{'└─ ' if last else '├─ '}{joint.child}  {_joint(joint)}")
        deeper = indent + ("   " if last else "│  ")
        waiting += _hanging(below, joint.child, deeper if len(indent) < _WIDEST else indent)
    return "\n".join(lines)


def _hanging(
    below: Mapping[str, Sequence[Joint]], link: str, indent: str
) -> list[tuple[Joint, str, bool]]:
    """The joints below a link, last to first, each with its indent and whether it is the last."""
    joints = below.get(link, ())
    return [(joint, indent, joint is joints[-1]) for joint in reversed(joints)]


def _joint(joint: Joint) -> str:
    """A joint in a few words."""
    words = f"[{joint.name}: {joint.type.value}"
    if joint.type.moves_on_one_axis:
        words += f" {_range(joint.limits)}"
    if joint.mimic is not None:
        words += f", mimics {joint.mimic.joint}"
    return words + "]"


def _range(limits: Limits) -> str:
    if math.isinf(limits.lower) and math.isinf(limits.upper):
        return "unlimited"
    return f"{limits.lower:.4g}..{limits.upper:.4g}"


def dh_table(dh: DHChain) -> str:
    """The modified DH rows, then the values of their constants."""
    rows = [("i", "joint", "alpha (rad)", "a (m)", "theta (rad)", "d (m)"), *row_texts(dh)]
    angles = {x.name for row in dh.rows for x in (row.alpha, row.theta, row.offset) if _turns(x)}
    values = ", ".join(
        f"{name} = {value:.10g} {'rad' if name in angles else 'm'}"
        for name, value in dh.named_constants().items()
    )
    return table(rows) + (f"\n  {values}" if values else "")


def _turns(constant: Angle | Length) -> bool:
    return not hasattr(constant, "sign")


def transform_text(T: Array) -> tuple[str, str]:
    """A rigid transform (4, 4) as URDF writes it: `xyz` (m) and `rpy` (rad: turns about the fixed x, y and
    z axes, one after the other)."""
    level = math.hypot(T[0, 0], T[1, 0])
    pitch = math.atan2(-T[2, 0], level)
    if level > 1e-9:
        roll = math.atan2(T[2, 1], T[2, 2])
        yaw = math.atan2(T[1, 0], T[0, 0])
    else:  # roll and yaw turn about one axis: all of it is roll
        roll = math.atan2(-T[2, 0] * T[0, 1], T[1, 1])
        yaw = 0.0
    xyz = " ".join(_short(float(x)) for x in T[:3, 3])
    return f"xyz {xyz}", f"rpy {' '.join(_short(x) for x in (roll, pitch, yaw))}"


def _short(value: float) -> str:
    """Nine digits; round-off of zero is 0."""
    return f"{value:.9g}" if abs(value) > 1e-12 else "0"
