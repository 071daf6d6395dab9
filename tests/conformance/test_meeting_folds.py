"""Where two folds meet, as of a stretched elbow and a tool that points straight down, four solutions do."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.both_languages import emitted_in_both
from tests.support.row_gaps import gaps_in_both
from tests.support.serial_urdf import serial_urdf
from tests.support.solving import NO_COMPILER

from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

HALF, RIGHT = "3.14159", "1.570795"
JOINTS = (
    ("0.1 0.03 0.435", "0 0 0", "", 0.0),
    ("0 0 0", f"{RIGHT} 0 {RIGHT}", "", 0.0),
    ("0 0.019 0", f"-{RIGHT} {RIGHT} {HALF}", "0 0 -1", 2.617),
    ("0 0 -0.0415", f"0 {HALF} 0", "0 1 0", 2.617),
    ("0 0 0.0645", f"0 {HALF} 0", "", 0.0),
    ("0 0 -0.0415", f"0 {HALF} 0", "0 1 0", 2.617),
    ("0 0 0.0645", f"0 {HALF} 0", "", 0.0),
    ("0 0 -0.0415", f"0 {HALF} 0", "0 1 0", 1.745),
    ("0 0 0.0265", f"0 {HALF} -{HALF}", "", 0.0),
    ("0 0 -0.019", f"{RIGHT} {HALF} {RIGHT}", "", 0.0),
)
"""Origins, and axes and limits of the four that move: right angles that are rounded to five digits."""


@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles")
@pytest.mark.long
def test_all_are_found_where_two_folds_meet(tmp_path: Path) -> None:
    origins, axes, most = zip(*((joint[:2], *joint[2:]) for joint in JOINTS), strict=True)
    limits = [(-x, x) for x in most]
    path = serial_urdf(tmp_path / "turret.urdf", origins, axes=axes, limit=limits)
    arm, header = emitted_in_both(Request(path, name="turret"), tmp_path)
    random = np.random.default_rng(7)
    q = np.zeros((200, 4))
    q[:, 0] = random.uniform(-2.5, 2.5, 200)
    q[:, 3] = -np.pi / 2
    q[100:] += 10.0 ** random.uniform(-12.0, -5.0, (100, 1)) * random.normal(size=(100, 4))
    poses = arm.forward(q)
    rows, (batch, _, _) = header.solve_many(poses), arm.solve_batch(poses)
    for found in (rows.q, batch):
        gap = np.abs(found - q[:, None]).max(axis=2)
        assert np.nanmin(gap, axis=1).max() < 1e-4


TABLE = """
convention = "modified"
joints = [
    {alpha = 0, a = 0, d = 0.7, theta = 0, type = "revolute"},
    {alpha = 0, a = 0.5, d = 0, theta = 0, type = "revolute"},
    {alpha = "pi/2", a = 0.45, d = 0, theta = 0, type = "revolute"},
    {alpha = "pi/2", a = 0, d = 0, theta = 0, type = "revolute"},
    {alpha = "-pi/2", a = 0, d = 0, theta = 0, type = "revolute"},
    {alpha = "pi/2", a = 0.55, d = 0, theta = 0, type = "revolute"},
]
"""


@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles")
@pytest.mark.long
def test_a_root_of_what_a_double_root_leaves_is_taken(tmp_path: Path) -> None:
    """Of exact geometry: where one root is a double one, what the next is taken of has half the digits."""
    path = tmp_path / "folding.toml"
    path.write_text(TABLE)
    arm, header = emitted_in_both(Request(path, name="folding"), tmp_path)
    random = np.random.default_rng(7)
    q = random.uniform(-np.pi, np.pi, (300, 6))
    q[:, 1:3] = random.choice([0.0, np.pi], (300, 2))
    q[150:] += 10.0 ** random.uniform(-12.0, -6.0, (150, 1)) * random.normal(size=(150, 6))
    assert gaps_in_both(arm, header, q).max() < 2e-3  # solutions lie as close together
