"""A calibrated arm: the rows of its model, and its own chain written with their variables.

Calibration turns axes that are parallel or meet into axes that nearly do, of which no rule knows. So the
closed form is that of the model's geometry, and Newton steps take its rows to the arm's own chain.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ikgen.kinematics.file_frames import frames_of_chain, largest_deviation
from ikgen.kinematics.fixed_order import product
from ikgen.kinematics.rigid import dh_link, read_only
from ikgen.model.chain import Chain
from ikgen.model.dh import DHChain

__all__ = ["calibrated_dh", "offset_dh"]


def calibrated_dh(dh: DHChain, chain: Chain) -> DHChain:
    """The rows of `dh` with the file frames of the calibrated `chain`, which has the same joints."""
    return _with_frames(dh, frames_of_chain(chain, dh))


def offset_dh(dh: DHChain, offsets: Sequence[Mapping[str, float]]) -> DHChain:
    """The rows of `dh` with file frames to whose rows the offsets alpha, a, d, theta are added."""
    frames = [np.array(F) for F in dh.file_frames]
    for i, one in enumerate(offsets):
        # Rx Tx before a motion about z, and Rz Tz beside it, each commute among themselves
        frames[i] = product(frames[i], dh_link(one["alpha"], one["a"], one["theta"], one["d"]))
    return _with_frames(dh, tuple(read_only(F) for F in frames))


def _with_frames(dh: DHChain, frames: tuple[np.ndarray, ...]) -> DHChain:
    moved = replace(dh, file_frames=frames)
    return replace(moved, deviation=largest_deviation(moved))
