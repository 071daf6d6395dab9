"""Poses at which an elimination has no rank: all that is left of some equations then is round-off."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.both_languages import header_of
from tests.support.dh_files import Row, dh_file
from tests.support.solving import NO_COMPILER

from ikgen.derivation.derive import derive
from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")


def joint(quarters: int, a: float, d: float) -> Row:
    return "revolute", f"{quarters}*pi/2", a, d, 0.0


FLAT = [
    joint(0, 0.0, 0.0), joint(-1, 0.74, 0.31), joint(-1, 0.0, 0.0),
    joint(-1, 0.83, 0.83), joint(-1, 0.77, 0.98), joint(0, 0.26, 0.0),
]  # fmt: skip
"""Axes 1, 3, 5 and 6 are parallel with joints 2 and 4 at 0 or pi."""
MEETING = [
    joint(0, 0.0, 0.0), joint(0, 0.48, 0.26), joint(1, 0.0, 0.0),
    joint(1, 0.37, 0.0), joint(-1, 0.0, 0.91), joint(0, 0.41, 0.0),
]  # fmt: skip
"""Many solutions meet next to right angles."""


@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles")
@pytest.mark.long
@pytest.mark.parametrize("rows", [FLAT, MEETING], ids=["flat", "meeting"])
def test_every_pose_has_a_row(rows: list[Row], tmp_path: Path) -> None:
    header = header_of(derive(Request(dh_file(tmp_path / "arm.toml", rows))).module, tmp_path)
    random = np.random.default_rng(2)
    q = random.integers(-4, 5, (1600, 6)) * np.pi / 4
    some = random.random((800, 6)) < 0.5
    q[::2] = np.where(some, random.uniform(-3.0, 3.0, (800, 6)), q[::2])
    q[1::2] += random.normal(size=(800, 6)) * 10.0 ** random.uniform(-12.0, -5.0, (800, 1))
    if rows is FLAT:
        q[:, 1], q[:, 3] = random.choice([0.0, np.pi], (2, 1600))
    status = np.array(header.solve_many(header.forward(q)).status)
    assert (status == "OK").all(), q[status != "OK"]
