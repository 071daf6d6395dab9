"""Line drawings in a terminal: a character holds two by four dots (Unicode's Braille patterns)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ikgen.model.dh import DHChain

__all__ = ["drawn", "skeleton_text"]

_DOTS = ((0x01, 0x08), (0x02, 0x10), (0x04, 0x20), (0x40, 0x80))
"""The bit of each dot, by row and column."""

_COLUMNS, _ROWS = 34, 13


def drawn(strokes: NDArray[np.float64], columns: int, rows: int) -> str:
    """Strokes (n, 2, 2) between places in dots, x to the right and y downwards, as lines of text without
    blanks at their ends."""
    bits = np.zeros((rows, columns), dtype=int)
    for start, end in strokes:
        count = int(np.abs(end - start).max()) * 2 + 2
        for x, y in np.rint(np.linspace(start, end, count)).astype(int):
            if 0 <= x < 2 * columns and 0 <= y < 4 * rows:
                bits[y // 4, x // 2] |= _DOTS[y % 4][x % 2]
    lines = ["".join(chr(0x2800 + b) if b else " " for b in row).rstrip() for row in bits]
    shown = [i for i, line in enumerate(lines) if line]
    return "\n".join(lines[shown[0] : shown[-1] + 1]) if shown else ""


def skeleton_text(dh: DHChain) -> str:
    """The arm as a skeleton: its links, a small cross at each joint, the base's foot."""
    from ikgen.report.camera import look_at
    from ikgen.report.skeleton_bones import skeleton
    from ikgen.report.worked_example import shown_configuration

    arm = skeleton(dh, shown_configuration(dh))
    width, height = 2 * _COLUMNS, 4 * _ROWS
    camera = look_at(arm.points, width - 1, height - 1, 3.0)
    links = [camera.place(np.array([bone.start, bone.end])) for bone in arm.bones]
    arms = ([[-2, 0], [2, 0]], [[0, -2], [0, 2]])
    marks = [camera.place(mark.at) + np.array(arm) for mark in arm.joints for arm in arms]
    foot = camera.place(np.zeros(3)) + np.array([[-6, 2], [6, 2]])
    return drawn(np.array([*links, *marks, foot]), _COLUMNS, _ROWS)
