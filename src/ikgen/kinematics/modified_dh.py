"""From a serial chain to modified Denavit-Hartenberg rows with exact constants."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ikgen.errors import UnknownNameError, UsageError
from ikgen.kinematics.file_frames import file_frames, largest_deviation
from ikgen.kinematics.links import Tolerance, orient, snapped_links
from ikgen.kinematics.offsets import distribute
from ikgen.kinematics.prismatic import place_prismatic
from ikgen.kinematics.row_ends import base_points_down, end_transforms
from ikgen.kinematics.rows import build_rows, drive_row
from ikgen.kinematics.snapping import ROUND_OFF, WRITTEN_IN_FULL, SnapLog
from ikgen.model.chain import PRISMATIC, Chain
from ikgen.model.dh import ARM_ANGLE_OPTION, DHChain

__all__ = ["to_dh"]


def to_dh(
    chain: Chain,
    *,
    angle_tolerance: float = 2e-3,
    length_tolerance: float = 1e-5,
    free: Sequence[str] = (),
) -> DHChain:
    """The chain as modified DH rows (Craig, Introduction to Robotics, section 3.4).

    Angles within `angle_tolerance` (rad) of multiples of pi/12 and lengths within
    `length_tolerance` (m) of zero or of each other become exact; `DHChain.snaps` lists them and
    `DHChain.deviation` is what they cost. Offsets of theta stay as in the file where that makes the
    rows exact: unlike twists they do not change what can be solved. Every alpha is in [0, pi),
    every a >= 0, row 1 has alpha = a = d = 0 and the last row d = 0. `free` names joints to be
    held free by the solver; they are only checked and passed on.

    Raises UsageError for a chain that does not move, UnknownNameError for a wrong name in `free`.
    """
    if not chain.axes:
        what = f"no moving joint between '{chain.base_link}' and '{chain.tip_link}'"
        raise UsageError(what, hint="choose links further apart; ikgen inspect shows the tree")
    names = [joint.name for joint in chain.joints]
    for name in free:
        if name not in (*names, ARM_ANGLE_OPTION):
            meant = name.replace("_", "-") in (ARM_ANGLE_OPTION, ARM_ANGLE_OPTION.replace("-", ""))
            hint = f"the arm angle is --free {ARM_ANGLE_OPTION}" if meant else ""
            raise UnknownNameError("joint in the chain", name, names, hint=hint)
    angle, length = max(angle_tolerance, WRITTEN_IN_FULL), max(length_tolerance, ROUND_OFF)
    rounded = _derive(chain, Tolerance(angle, length, angle), free)
    if max(rounded.deviation) <= WRITTEN_IN_FULL:
        return rounded
    # try again with the turns about the axes as written: same structure, perhaps nothing lost
    literal = _derive(chain, Tolerance(angle, length, WRITTEN_IN_FULL), free)
    same = _structure(literal) == _structure(rounded)
    return literal if same and max(literal.deviation) <= WRITTEN_IN_FULL else rounded


def _derive(chain: Chain, tolerance: Tolerance, free: Sequence[str]) -> DHChain:
    prismatic = tuple(axis.kind == PRISMATIC for axis in chain.axes)
    links, shifts = place_prismatic(snapped_links(chain, tolerance), prismatic, tolerance)
    shapes, signs = orient(links, base_points_down(chain, tolerance), tolerance)
    offsets = distribute(shapes, prismatic)
    X_base, X_tip, theta = end_transforms(chain, signs, shifts, offsets, tolerance)
    log = SnapLog()
    offsets = replace(offsets, theta=theta)
    rows = build_rows(chain.axes, shapes, signs, offsets, tolerance, log)
    home = tuple(row.offset.value for row in rows)
    dh = DHChain(
        robot=chain.robot,
        base_link=chain.base_link,
        tip_link=chain.tip_link,
        joints=chain.joints,
        rows=tuple(
            drive_row(row, axis.multiplier, axis.offset, i)
            for i, (row, axis) in enumerate(zip(rows, chain.axes, strict=True), start=1)
        ),
        X_base=X_base,
        X_tip=X_tip,
        file_frames=file_frames(chain, rows, signs, home, (X_base, X_tip)),
        snaps=log.snaps,
        free=tuple(free),
        locked=chain.locked,
    )
    return replace(dh, deviation=largest_deviation(dh))


def _structure(dh: DHChain) -> tuple[object, ...]:
    """What a symbolic solver sees: exact twists, which constants vanish, which share a name."""
    return tuple(
        (row.alpha.exact, row.alpha.name, row.a.name, row.d.name, row.theta.exact, row.theta.name)
        for row in dh.rows
    )
