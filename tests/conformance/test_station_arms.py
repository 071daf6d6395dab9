"""Intervals of arms as those of a space station, with offsets between their axes and long links."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.both_languages import Both, in_both
from tests.support.redundant_arms import STATION_INSPECTOR, Joint, serial_urdf
from tests.support.solving import NO_COMPILER

from ikgen.generation.derive import derive
from ikgen.generation.request import Request

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


def test_a_curve_without_a_direction_is_given_up(tmp_path: Path) -> None:
    """Beside it an interval ends where halving finds its end."""
    both = station_arm(STATION_INSPECTOR, "pitch_2", tmp_path)
    q = (0.7106865278970234, 0.0, -0.49209827483843727, 0.25 * np.pi)
    own, other = intervals(both, (*q, -1.2856193821576292, -0.8283112918618798, -0.277020301))
    assert len(own) == len(other) > 2
    np.testing.assert_allclose(own, other, atol=1e-8)
