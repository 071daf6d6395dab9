"""Values of a held joint that alone reach a pose: of a stretched arm, with several joints on limits."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.both_languages import Both, in_both
from tests.support.redundant_arms import SHOULDER_ELBOW_WRIST, serial_urdf
from tests.support.solving import NO_COMPILER

from ikgen.derivation.derive import derive
from ikgen.records.request import Request

pytestmark = [
    pytest.mark.usefixtures("solved_once"),
    pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles"),
]

Array = NDArray[np.float64]

ELBOW_TO_ONE_SIDE = tuple(
    (name, kind, axis, xyz, (0.0, 2.1) if name == "elbow" else limits)
    for name, kind, axis, xyz, limits in SHOULDER_ELBOW_WRIST
)


@pytest.fixture(scope="module")
def both(tmp_path_factory: pytest.TempPathFactory) -> Both:
    folder = tmp_path_factory.mktemp("lone")
    path = folder / "arm.urdf"
    path.write_text(serial_urdf("arm", ELBOW_TO_ONE_SIDE))
    return in_both(derive(Request(path, free={"shoulder_yaw": None})).module, folder, "0123")


def stretched(arm: ModuleType) -> Array:
    """The line of the arm leaves the held joint one value of each side of the shoulder."""
    q = np.random.default_rng(3).uniform(0.9 * arm.LOWER, 0.9 * arm.UPPER, (3, arm.DOF))
    q[:, 3] = 0.0
    return np.asarray(q)


def on_limits(arm: ModuleType) -> Array:
    """Several joints on their limits, at many of which these meet where one alone could go on."""
    quarters = np.random.default_rng(4).integers(-2, 3, (8, arm.DOF)) * (np.pi / 2)
    return np.clip(quarters, arm.LOWER, arm.UPPER)


@pytest.mark.long
@pytest.mark.parametrize("drawn", [stretched, on_limits])
def test_they_are_found(both: Both, drawn: Callable[[ModuleType], Array]) -> None:
    arm = both.arm
    seed, lost = np.zeros(arm.DOF), 0
    for q in drawn(arm):
        pose = arm.forward(q)
        for prefer, mode in (("centre", 2), ("dexterous", 3)):
            own = arm.search(pose, prefer=prefer)
            other = both.run(mode, seed, pose[None])[1].reshape(-1, arm.DOF)
            lost += (not len(own)) + (not len(other))
            for rows in (own.q, other):
                assert np.all((rows >= arm.LOWER - 1e-9) & (rows <= arm.UPPER + 1e-9))
                assert np.abs(arm.forward(rows) - pose).max(initial=0.0) < 3e-9
        ends = both.run(0, seed, pose[None])[1].reshape(-1, 3)[:, :2]
        mine = np.array([[one.low, one.high] for one in arm.self_motion(pose)])
        lost += (not len(mine)) + (not len(ends))
    assert lost == 0
