"""The DH chain of a table's rows: exact constants, the table's own numbers beside them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ikgen.importers.dh.constant_names import SymbolTable, symbol_of
from ikgen.importers.dh.row_merge import Merged, ModifiedRow
from ikgen.kinematics.file_frames import largest_deviation
from ikgen.kinematics.fixed_order import product
from ikgen.kinematics.forward import row_constant
from ikgen.kinematics.modified_dh import to_dh
from ikgen.kinematics.rigid import read_only
from ikgen.kinematics.snapping import SnapLog
from ikgen.model.arrays import Array
from ikgen.model.chain import PRISMATIC, REVOLUTE, ActuatedJoint, Chain, ChainAxis
from ikgen.model.dh import Angle, DHChain, DHRow, Length

__all__ = ["TableEnds", "chain_of_rows", "exact_chain"]

_TWIST = 2e-3
"""Twists within this (rad) of multiples of pi/12 are those: tables write 1.57 for pi/2."""

_OFFSET = 1e-9
"""Offsets are taken as written: unlike twists they do not change what can be solved."""


class TableEnds:
    """Names of the robot and its two ends."""

    def __init__(self, robot: str, base_link: str, tip_link: str) -> None:
        self.robot, self.base_link, self.tip_link = robot, base_link, tip_link


def exact_chain(
    merged: Merged,
    ends: TableEnds,
    *,
    free: tuple[str, ...],
    locked: tuple[tuple[str, float], ...],
) -> DHChain:
    """The rows as they are, with the user's names for lengths and angles."""
    log = SnapLog()
    book = SymbolTable(log)
    for row in merged.rows:
        for q in (row.alpha, row.a, row.theta, row.d):
            for name, _ in q.terms:
                if symbol_of(name) == name:
                    book.names.setdefault(name, ("user", name))
    rows = tuple(_row(i, row, book) for i, row in enumerate(merged.rows))
    dh = DHChain(
        robot=ends.robot,
        base_link=ends.base_link,
        tip_link=ends.tip_link,
        joints=_joints(merged.rows),
        rows=rows,
        X_base=read_only(merged.X_base + 0.0),
        X_tip=read_only(merged.X_tip + 0.0),
        file_frames=_file_frames(merged, rows),
        snaps=log.snaps,
        free=free,
        locked=locked,
        written=tuple(book.written().items()),
    )
    return replace(dh, deviation=largest_deviation(dh))


def chain_of_rows(
    merged: Merged,
    ends: TableEnds,
    *,
    free: tuple[str, ...],
    locked: tuple[tuple[str, float], ...],
) -> DHChain:
    """New rows from the axes in space, where a fixed row cannot be merged exactly."""
    axes: list[ChainAxis] = []
    pending = merged.X_base
    for row in merged.rows:
        pending = product(pending, row_constant(row))
        if row.kind != "fixed":
            axis = np.array([0.0, 0.0, 1.0])
            axes.append(ChainAxis(row.name, row.kind, pending, axis, len(axes)))
            pending = np.eye(4)
    moving = tuple(row for row in merged.rows if row.kind != "fixed")
    chain = Chain(
        ends.robot, ends.base_link, ends.tip_link, _joints(moving), tuple(axes),
        product(pending, merged.X_tip), locked,
    )  # fmt: skip
    return to_dh(chain, free=free)


def _joints(rows: tuple[ModifiedRow, ...]) -> tuple[ActuatedJoint, ...]:
    return tuple(
        ActuatedJoint(
            row.name, row.kind, row.limits, row.kind == REVOLUTE and np.isinf(row.limits.upper)
        )
        for row in rows
    )


def _row(i: int, row: ModifiedRow, book: SymbolTable) -> DHRow:
    none, zero = Length(0.0, None), book.angle(row.alpha.scaled(0.0), "", _OFFSET)
    revolute = row.kind == REVOLUTE
    alpha = book.angle(row.alpha, f"alpha_{i}", _TWIST)
    a = book.length(row.a, f"a_{i}")
    offset: Angle | Length
    if revolute:
        theta, d = zero, book.length(row.d, f"d_{i + 1}")
        offset = book.angle(row.theta, f"theta_offset_{i + 1}", _OFFSET)
    else:
        theta, d = book.angle(row.theta, f"theta_{i + 1}", _TWIST), none
        offset = book.length(row.d, f"d_offset_{i + 1}")
    return DHRow(
        name=row.name,
        kind=REVOLUTE if revolute else PRISMATIC,
        alpha=alpha,
        a=a,
        d=d,
        theta=theta,
        driver=i,
        scale=-1.0 if row.reversed else 1.0,
        offset=offset,
    )


def _file_frames(merged: Merged, rows: tuple[DHRow, ...]) -> tuple[Array, ...]:
    """The table's own numbers: F_{i-1} holds row i's constants and what its offset lost."""
    out: list[Array] = []
    pending = merged.X_base
    for own, row in zip(merged.rows, rows, strict=True):
        if row.revolute:
            theta = own.theta.value - row.offset.value
            theta = theta - 2 * np.pi * round(theta / (2 * np.pi))
            constant = _constant(own, 0.0 if abs(theta) < 1e-15 else theta, own.d.value)
        else:
            constant = _constant(own, own.theta.value, own.d.value - row.offset.value)
        out.append(read_only(product(pending, constant) + 0.0))
        pending = np.eye(4)
    out.append(read_only(product(pending, merged.X_tip) + 0.0))
    return tuple(out)


def _constant(row: ModifiedRow, theta: float, d: float) -> Array:
    shown = replace(
        row,
        theta=replace(row.theta, value=theta),
        d=replace(row.d, value=d),
    )
    return row_constant(shown)
