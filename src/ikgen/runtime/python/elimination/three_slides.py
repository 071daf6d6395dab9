"""Approximate solutions of three revolute joints and three slides.

The rotation gives the angles, the position the lengths, linearly.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ikgen.runtime.python.arrays.array_types import Array
from ikgen.runtime.python.elimination.general_6r import Candidates, Elimination
from ikgen.runtime.python.elimination.loop_equations import joint_values, loop_constants
from ikgen.runtime.python.elimination.revolute_loop import (
    displacement,
    revolute_loop,
    slide_lengths,
)
from ikgen.runtime.python.elimination.spherical_triple import spherical_triple
from ikgen.runtime.python.rows.solution_rows import Turning

__all__ = ["three_slide_candidates"]

_SLIDES_FOLD = 1e-3  # imaginary part of an angle that may be a fold's round-off
_SLIDES_APART = 1e-6


def three_slide_candidates(
    F: Sequence[Array], T: Array, elimination: Elimination, turning: Turning
) -> Candidates:
    """Approximate solutions of a chain with three joints that are not `turning`; the loop begins at a
    revolute joint. The result is that of `candidates`."""
    start, reverse, _ = elimination
    order, C = loop_constants(F, T, start, reverse)
    turns = [turning[j] for j in order]
    loop = revolute_loop(C, turns, len(T))
    h, c, s = spherical_triple(loop.K[:2], np.swapaxes(loop.K[2], -1, -2))
    off = np.maximum(np.abs(c[0, 1].imag), np.abs(s[0, 1].imag))
    pose = np.flatnonzero(off < _SLIDES_FOLD)
    twice = np.tile(pose, 2)
    branch = np.repeat([0, 1], len(pose))
    p, u = displacement(loop, c, s)
    values = np.empty((len(twice), 6))
    values[:, np.flatnonzero(turns)] = np.arctan2(
        s[branch, :, twice].real, c[branch, :, twice].real
    )
    slides = slide_lengths(p[branch, twice], u[:, branch, twice])
    values[:, np.flatnonzero(~np.array(turns))] = slides
    simple = (np.abs(s[0, 1] - s[1, 1]) + np.abs(c[0, 1] - c[1, 1]) > _SLIDES_APART) & (
        h > _SLIDES_APART
    )
    return twice, joint_values(values, order), np.where(off < 1e-12, 2, 0).astype(np.intp), simple
