"""Searches of arms that hold a slide of a travel much longer than they are: a rail, a mobile base."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from tests.conformance.test_cpp_self_motion import Both, in_both
from tests.support.redundant_arms import SHOULDER_ELBOW_WRIST, serial_urdf
from tests.support.sampled import sampled
from tests.support.solving import NO_COMPILER, solver_module

from ikgen.derivation.read import read
from ikgen.records.request import Request
from ikgen.runtime.python.held.slide_range import slide_range

LIFT = ("lift", "prismatic", "0 1 1", "0 0 0.1", (0.0, 0.3))
RAIL = ("rail", "prismatic", "0 -1 0", "0.2 0 0.5", (-200.0, 300.0))
REACH = 0.3 + 0.4 + 0.35 + 0.1 + 0.3 / 2**0.5  # of the arm, and of the lift along the rail


@pytest.fixture(scope="module")
def both(tmp_path_factory: pytest.TempPathFactory) -> Both:
    if NO_COMPILER:
        pytest.skip(NO_COMPILER)
    folder = tmp_path_factory.mktemp("long")
    path = folder / "long.urdf"
    path.write_text(serial_urdf("long", (LIFT, RAIL, *SHOULDER_ELBOW_WRIST)))
    free = dict.fromkeys(("lift", "rail", "wrist_roll"))
    module = replace(solver_module(read(Request(path, free=free)).dh), name="long")
    return in_both(module, folder, "123")


def drawn(both: Both) -> np.ndarray:
    rng = np.random.default_rng(5)
    return rng.uniform(both.arm.LOWER, both.arm.UPPER, (6, both.arm.DOF))


@pytest.mark.long
def test_a_pose_lies_in_the_range_that_it_is_reached_from(both: Both) -> None:
    arm = both.arm
    for q in drawn(both):
        low, high = slide_range(arm._ARM, arm.forward(q), 1)
        assert low <= q[1] <= high and high - low < 2.0 * REACH
        assert slide_range(arm._ARM, arm.forward(q), 3) == (-np.inf, np.inf)
        # of the lift, which is not at a right angle to the rail, all the rail's travel remains
        assert np.subtract(*slide_range(arm._ARM, arm.forward(q), 0)) < -300.0


@pytest.mark.parametrize("mode", sampled([1, 2, 3], [3]))
def test_rows_are_found_wherever_on_the_rail(both: Both, mode: int) -> None:
    arm = both.arm
    seed = np.zeros(arm.DOF)
    for q in drawn(both)[:1]:
        pose = arm.forward(q)
        status, numbers = both.run(mode, seed, pose[None])
        found = arm.search(pose, seed=seed, prefer=("near", "centre", "dexterous")[mode - 1])
        assert status == found.status.value == "OK"
        for rows in (numbers.reshape(-1, arm.DOF), found.q):
            assert len(rows) and np.abs(arm.forward(rows) - pose).max() < 1e-9
