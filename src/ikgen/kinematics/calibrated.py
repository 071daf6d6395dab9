"""A calibrated arm: the rows of its model, and its own chain written with their variables.

Calibration turns axes that are parallel or meet into axes that nearly do, of which no rule knows. So the
closed form is that of the model's geometry, and Newton steps take its rows to the arm's own chain.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ikgen.kinematics.axis_relations import reach
from ikgen.kinematics.file_frames import (
    frames_of_chain,
    largest_deviation,
    random_configurations,
)
from ikgen.kinematics.fixed_order import product
from ikgen.kinematics.forward import file_forward, pose_difference
from ikgen.kinematics.rigid import dh_link, inverse, read_only
from ikgen.model.chain import Chain
from ikgen.model.dh import DHChain
from ikgen.model.oddity import Oddity

__all__ = ["Calibration", "calibrated_dh", "calibration_of", "offset_dh"]

_FAR = 0.05
"""From this angle on (rad; m by the arm's reach) a calibration is told to be far off: what is measured of
arms is some 1e-3, 1e-2 at most, while a wrong sign, unit or angle is more."""


@dataclass(frozen=True, slots=True)
class Calibration:
    """A calibration that was read: its file, how far (m, rad) the tip is off the model's at most, over
    random configurations, and whether that is more than what is measured of arms."""

    file: Path
    off: tuple[float, float]
    far: bool

    @property
    def words(self) -> str:
        """One line."""
        return f"{self.file}: up to {self.off[0]:.2g} m and {self.off[1]:.2g} rad off the model"

    @property
    def warnings(self) -> tuple[Oddity, ...]:
        """What there is to warn of."""
        why = "arms are measured to be off by some mm and 1e-3 rad: check its numbers and units"
        return (Oddity(f"{self.words}; {why}"),) if self.far else ()


def calibration_of(file: Path, model: DHChain, own: DHChain) -> Calibration:
    """How far the arm's `own` chain is off that of its `model`, as the `file` has it."""
    q = random_configurations(model)
    off = pose_difference(file_forward(model, q), file_forward(own, q))
    return Calibration(file, off, off[1] > _FAR or off[0] > _FAR * reach(model))


def calibrated_dh(dh: DHChain, chain: Chain) -> DHChain:
    """The rows of `dh` with the file frames of the calibrated `chain`, which has the same joints."""
    return _with_frames(dh, frames_of_chain(chain, dh))


def offset_dh(dh: DHChain, offsets: Sequence[Mapping[str, float]]) -> DHChain:
    """The rows of `dh` with file frames to whose rows the offsets alpha, a, d, theta are added; the last of
    these to the link behind the rows."""
    frames = [np.array(F) for F in dh.file_frames]
    for i, one in enumerate(offsets):
        # Rx and Tx commute, and so do Rz and Tz; a row's frame has both, the first row's behind the base
        link = dh_link(one["alpha"], one["a"], 0.0, 0.0)
        if i == 0:
            link = product(product(dh.X_base, link), inverse(dh.X_base))
        frames[i] = product(product(link, frames[i]), dh_link(0.0, 0.0, one["theta"], one["d"]))
    return _with_frames(dh, tuple(read_only(F) for F in frames))


def _with_frames(dh: DHChain, frames: tuple[np.ndarray, ...]) -> DHChain:
    moved = replace(dh, file_frames=frames)
    return replace(moved, deviation=largest_deviation(moved))
