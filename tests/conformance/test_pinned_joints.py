"""Held joints that limits leave one value, or two neighbouring ones."""

from __future__ import annotations

from math import nextafter
from pathlib import Path

import numpy as np
import pytest
from tests.support.both_languages import in_both
from tests.support.redundant_arms import SHOULDER_ELBOW_WRIST, serial_urdf
from tests.support.solving import NO_COMPILER

from ikgen.derivation.derive import derive
from ikgen.records.request import Request

pytestmark = [
    pytest.mark.usefixtures("solved_once"),
    pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles"),
    pytest.mark.filterwarnings("error"),
]


@pytest.mark.long
@pytest.mark.parametrize("upper", [0.3, nextafter(0.3, 1.0)])
def test_each_row_is_an_interval_without_width(upper: float, tmp_path: Path) -> None:
    """Once, in both languages, and `search` has it."""
    limits = {"shoulder_roll": (0.3, upper)}
    path = tmp_path / "arm.urdf"
    path.write_text(
        serial_urdf("arm", [(*j[:4], limits.get(j[0], j[4])) for j in SHOULDER_ELBOW_WRIST])
    )
    both = in_both(derive(Request(path, free={"shoulder_roll": None})).module, tmp_path, "02")
    arm, rng, seed = both.arm, np.random.default_rng(7), np.zeros(7)
    for _ in range(5):
        pose = arm.forward(rng.uniform(arm.LOWER, arm.UPPER))
        own = [(one.low, one.high, one.branch) for one in arm.self_motion(pose)]
        names = arm.solve(pose, free=[0.3]).branch
        assert sorted(f"branch {branch}" for *_, branch in own) == sorted(names) and names
        np.testing.assert_allclose([ends for *ends, _ in own], 0.3, atol=1e-15)
        other = both.run(0, seed, pose[None])[1].reshape(-1, 3)
        np.testing.assert_allclose(other, own, atol=1e-15)
        best = both.run(2, seed, pose[None])[1].reshape(-1, 7)
        found = arm.search(pose, prefer="centre")
        assert len(best) == len(found) >= len(own)
        np.testing.assert_allclose(best[0], found[0], atol=1e-9)
