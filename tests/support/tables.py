"""Chains from a few words a row: twists in right angles, lengths, no offsets."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np

from ikgen.model.chain import PRISMATIC, REVOLUTE, ActuatedJoint
from ikgen.model.dh import Angle, DHChain, DHRow, Length
from ikgen.model.joint_tree import Limits

__all__ = ["Row", "geared", "table"]

Row = tuple[str, str, float, float]


def table(*rows: Row) -> DHChain:
    """A chain from (kind, twist in right angles, a, d)."""
    made: list[DHRow] = []
    joints: list[ActuatedJoint] = []
    frames = [np.eye(4)]
    straight = Angle(0.0, Fraction(0))
    for i, (kind, twist, a, d) in enumerate(rows):
        exact = Fraction(twist) / 2
        alpha = Angle(float(exact) * np.pi, exact)
        lengths = [Length(x, f"{n}_{i}" if x else None) for x, n in ((a, "a"), (d, "d"))]
        kind_name = REVOLUTE if kind == "R" else PRISMATIC
        offset: Angle | Length = straight if kind == "R" else Length(0.0, None)
        made.append(DHRow(f"q{i}", kind_name, alpha, *lengths, straight, i, 1.0, offset))
        joints.append(ActuatedJoint(f"q{i}", kind_name, Limits(-np.inf, np.inf)))
        link = np.eye(4)
        c, s = round(np.cos(alpha.value)), round(np.sin(alpha.value))
        link[1:3, 1:3] = [[c, -s], [s, c]]
        link[0, 3] = a
        frames[-1] = frames[-1] @ link
        after = np.eye(4)
        after[2, 3] = d
        frames.append(after)
    eye = np.eye(4)
    return DHChain("arm", "base", "tip", tuple(joints), tuple(made), eye, eye, tuple(frames))


def geared(dh: DHChain) -> DHChain:
    """The chain whose third row turns three times as far as its second, as one joint."""
    places = [0, 1, 1, *range(2, dh.dof - 1)]
    rows = [replace(row, driver=place) for row, place in zip(dh.rows, places, strict=True)]
    rows[2] = replace(rows[2], scale=3.0)
    return replace(dh, rows=tuple(rows), joints=(*dh.joints[:2], *dh.joints[3:]))
