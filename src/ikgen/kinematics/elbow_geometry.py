"""The arm angle of an arm with a spherical shoulder and a spherical wrist: what it is measured by.

With S the point that the first three axes go through, W that of the last three, and E the point of
the fourth axis that is nearest to the third: the angle by which the half plane from the line S-W
through E is turned, about the direction from S to W, from the half plane to the side of the first
axis' direction (Shimizu et al., Analytical inverse kinematic computation for 7-DOF redundant
manipulators with joint limits and its application to redundancy resolution, 2008; the first axis in
place of their joint 3 at 0, which is the same plane). Where W is on the first axis, its direction
from that counts as x of the DH base frame."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ikgen.errors import UsageError
from ikgen.kinematics.classify import parallel_to_previous
from ikgen.kinematics.fixed_order import length, product
from ikgen.kinematics.forward import row_constant
from ikgen.kinematics.rigid import dh_link, inverse, z_motion
from ikgen.model.arrays import Array
from ikgen.model.chain import REVOLUTE
from ikgen.model.dh import ARM_ANGLE_OPTION, DHChain, DHRow, Length

__all__ = ["ElbowGeometry", "elbow_geometry", "without_arm_angle"]

_JOINTS = 7


@dataclass(frozen=True, slots=True)
class ElbowGeometry:
    """`shoulder` (4, 4) in the base link: origin S, z along the first axis as the joint turns about it;
    `wrist` (3,): W in the tip link; `elbow`: four frames F of `F_0 M_1 F_1 M_2 F_2 M_3 F_3` from the base
    link to a frame at E, M of the first three rows; `upper`, `fore`: E-S and W-E (m)."""

    shoulder: Array
    wrist: Array
    elbow: tuple[Array, ...]
    upper: float
    fore: float


def without_arm_angle(dh: DHChain) -> str:
    """What an arm lacks to have an arm angle, in words; empty where it has one."""
    rows = dh.rows
    if dh.free_indices:
        held = " and ".join(dh.joints[j].name for j in dh.free_indices)
        return f"a joint to spare: with {held} held there is none"
    if len(rows) != _JOINTS or dh.dof != _JOINTS or any(row.kind != REVOLUTE for row in rows):
        return f"seven joints that turn: {dh.dof} joints move it, about or along {len(rows)} axes"
    for first, place in ((1, "shoulder"), (5, "wrist")):
        parts = (rows[first].a, rows[first].d, rows[first + 1].a)
        if any(not _zero(x) for x in parts) or any(
            map(parallel_to_previous, rows[first : first + 2])
        ):
            return f"a spherical {place}: axes {first}, {first + 1} and {first + 2} do not meet in a point"
    if any(map(parallel_to_previous, rows[3:5])):
        return "an elbow: axis 4 is parallel to one beside it"
    found = _geometry(dh)
    return "" if min(found.upper, found.fore) > 0.0 else "links between shoulder, elbow and wrist"


def elbow_geometry(dh: DHChain) -> ElbowGeometry:
    """The elbow geometry of the exact rows. Raises UsageError for an arm without an arm angle."""
    lack = without_arm_angle(dh)
    if lack:
        raise UsageError(
            f"--free {ARM_ANGLE_OPTION}: the arm lacks {lack}",
            hint="leave it out, and ikgen chooses joints to hold; of more than seven joints --lock "
            "JOINT=VALUE makes constants",
        )
    return _geometry(dh)


def _geometry(dh: DHChain) -> ElbowGeometry:
    rows, turn = dh.rows, np.copysign(1.0, dh.rows[0].scale)
    elbow = (
        product(dh.X_base, row_constant(rows[0])),
        row_constant(rows[1]),
        row_constant(rows[2]),
        _link(rows[3]),
    )
    shoulder = product(elbow[0], np.diag([1.0, turn, turn, 1.0]))
    wrist = product(inverse(dh.X_tip), _along(-rows[6].d.value))[:3, 3]
    upper = product(_along(rows[2].d.value), _link(rows[3]))[:3, 3]
    fore = product(_along(rows[3].d.value), _link(rows[4]), _along(rows[4].d.value))[:3, 3]
    return ElbowGeometry(shoulder, wrist, elbow, length(upper), length(fore))


def _link(row: DHRow) -> Array:
    """`Rx(alpha) Tx(a)`"""
    return dh_link(row.alpha.value, row.a.value, 0.0, 0.0)


def _along(d: float) -> Array:
    return np.asarray(z_motion(False, d))


def _zero(x: Length) -> bool:
    return x.name is None
