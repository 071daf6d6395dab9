"""A robot's joint tree and its DH rows as text."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import TYPE_CHECKING

from ikgen.cli.tables import table

if TYPE_CHECKING:
    from ikgen.model.dh import Angle, DHChain, DHRow, Length
    from ikgen.model.joint_tree import Joint, JointTree, Limits, Matrix

__all__ = ["angle_text", "constants", "dh_table", "joint_tree", "length_text", "transform_text"]

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
    rows = [("i", "joint", "alpha", "a", "theta", "d")]
    for i, row in enumerate(dh.rows, start=1):
        theta, d = _variable(row, dh), length_text(row.d)
        if not row.revolute:
            theta, d = angle_text(row.theta), theta
        rows.append((str(i), row.name, angle_text(row.alpha), length_text(row.a), theta, d))
    values = ", ".join(f"{name} = {value:.10g}" for name, value in constants(dh).items())
    return table(rows) + (f"\n  {values}" if values else "")


def constants(dh: DHChain) -> dict[str, float]:
    """Named constants (rad or m) in the order of the rows; None of them is exact."""
    found: dict[str, float] = {}
    for row in dh.rows:
        for constant in (row.alpha, row.a, row.d, row.theta, row.offset):
            if constant.name is not None:
                sign = getattr(constant, "sign", 1)
                found.setdefault(constant.name, sign * constant.value)
    return found


def _variable(row: DHRow, dh: DHChain) -> str:
    """The row's variable: `scale * q + offset` with the joint's name for q."""
    name = dh.joints[row.driver].name
    text = name if row.scale == 1 else f"-{name}" if row.scale == -1 else f"{row.scale:g} {name}"
    offset = angle_text(row.offset) if row.revolute else length_text(row.offset)  # type: ignore[arg-type]
    if offset == "0":
        return text
    return f"{text} - {offset[1:]}" if offset.startswith("-") else f"{text} + {offset}"


def angle_text(angle: Angle) -> str:
    """An exact angle as a multiple of pi, another one by its name or value."""
    exact = angle.exact
    if exact is None:
        return angle.name or f"{angle.value:.10g}"
    if exact == 0:
        return "0"
    sign = "-" if exact < 0 else ""
    size = Fraction(abs(exact))
    top = "pi" if size.numerator == 1 else f"{size.numerator} pi"
    return f"{sign}{top}" if size.denominator == 1 else f"{sign}{top}/{size.denominator}"


def length_text(length: Length) -> str:
    """A length by its signed name; exact zero is 0."""
    if length.name is None:
        return "0"
    return f"-{length.name}" if length.sign < 0 else length.name


def transform_text(T: Matrix) -> tuple[str, str]:
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
