"""Intervals of arms as those of a space station, with offsets between their axes and long links."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.both_languages import Both, in_both
from tests.support.redundant_arms import STATION_ARM, STATION_INSPECTOR, Joint, serial_urdf
from tests.support.solving import NO_COMPILER

from ikgen.derivation.derive import derive
from ikgen.records.request import Request

pytestmark = [
    pytest.mark.usefixtures("solved_once"),
    pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles"),
]

Array = NDArray[np.float64]


def station_arm(joints: tuple[Joint, ...], held: str, folder: Path) -> Both:
    path = folder / "arm.urdf"
    path.write_text(serial_urdf("arm", joints))
    return in_both(derive(Request(path, free={held: None})).module, folder, "0")


def intervals(both: Both, q: tuple[float, ...]) -> tuple[Array, Array]:
    """Of the pose of a configuration, in Python and in C++."""
    pose = both.arm.forward(q)
    own = [(one.low, one.high, one.branch) for one in both.arm.self_motion(pose)]
    return np.array(own), both.run(0, np.zeros(both.arm.DOF), pose[None])[1].reshape(-1, 3)


@pytest.mark.long
def test_a_curve_without_a_direction_is_given_up(tmp_path: Path) -> None:
    """Beside it an interval ends where halving finds its end."""
    both = station_arm(STATION_INSPECTOR, "pitch_2", tmp_path)
    q = (0.7106865278970234, 0.0, -0.49209827483843727, 0.25 * np.pi)
    own, other = intervals(both, (*q, -1.2856193821576292, -0.8283112918618798, -0.277020301))
    assert len(own) == len(other) > 2
    np.testing.assert_allclose(own, other, atol=1e-8)


@pytest.mark.long  # by itself: tests/runtime/held/test_branch_ends.py
def test_rows_that_move_far_before_they_meet_end_there(tmp_path: Path) -> None:
    """Some by more than a radian over a cell of the range: each pair that meets has one end, and so have
    all here."""
    both = station_arm(STATION_ARM, "roll_1", tmp_path)
    for q in (
        (1.08524993, -2.37264163, 0.49561850, 1.62388383, -2.9097176, 4.61925790, 2.32164830),
        (-0.66444776, 1.74461782, -3.23721455, -1.0771031, -4.5231624, -3.89893767, -2.6710073),
    ):
        own, other = intervals(both, q)
        assert own.shape == other.shape and np.abs(own - other).max() < 1e-9
        for found in (own, other):
            assert np.ptp(found[:, :2].reshape(8, -1), axis=0).max() < 1e-9
