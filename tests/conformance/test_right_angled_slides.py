"""Arms of right angles with slides: roots that follow from double roots; two directions lost at once."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.both_languages import emitted_in_both
from tests.support.row_gaps import gaps_in_both
from tests.support.serial_urdf import serial_urdf
from tests.support.solving import NO_COMPILER

from ikgen.records.request import Request
from ikgen.verify.runners.cpp_header import CppHeader

pytestmark = [
    pytest.mark.usefixtures("solved_once"),
    pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles"),
]

QUARTER, HALF = "1.5707963267948966", "3.141592653589793"
TIP = ("0.05 0.02 0.11", "0 0 0")
ONE_SLIDE = (
    ("0 0.015 0", f"-{QUARTER} {QUARTER} 0"),
    ("0 -0.185 -0.337", f"{QUARTER} {HALF} {QUARTER}"),
    ("0 0.1 0.148", f"{HALF} {HALF} 0"),
    ("-0.334 0 -0.214", f"{QUARTER} -{QUARTER} 0"),
    ("0 0.251 0", f"{HALF} {HALF} {QUARTER}"),
    ("-0.251 0.221 0", f"{QUARTER} {QUARTER} {QUARTER}"),
)
OUTSIDE = np.array(  # next to the fold of joint 4, which leaves no other root for joint 5
    [
        [2.950108310, 2.633848381296331, -0.21015885, 1.5720715399983254, -2.4618406667, 2.47527544],
        [1.634338223, -0.06275634330530577, -0.39443317, 1.5678739581225836, -2.07609787, -2.67933463],
        [-0.626778965, 3.126328217993027, -0.389696697, -1.6010906258227361, 0.7956628887, -2.5472244],
    ]
)  # fmt: skip
TWO_SLIDES = (
    ("0.288 -0.221 0", f"0 0 {QUARTER}"),
    ("0 0 0", f"{QUARTER} -{QUARTER} -{QUARTER}"),
    ("0 -0.189 0", f"-{QUARTER} 0 {QUARTER}"),
    ("0 0 0", f"{HALF} {HALF} {QUARTER}"),
    ("-0.142 -0.045 0", f"{QUARTER} {HALF} 0"),
    ("-0.335 0 0.081", f"-{QUARTER} {HALF} {HALF}"),
)


def assert_answered(arm: ModuleType, header: CppHeader, poses: NDArray[np.float64]) -> None:
    """That both have rows for all poses, and right ones."""
    for found in (arm.solve_batch(poses)[0], header.solve_many(poses).q):
        there = ~np.isnan(found[..., 0])
        assert there.any(axis=1).all()
        off = np.abs(arm.forward(np.nan_to_num(found)) - poses[:, None]).max(axis=(2, 3))
        assert off[there].max() < 1e-8


@pytest.mark.long
def test_rows_of_roots_that_are_taken_outside_are_right(tmp_path: Path) -> None:
    axes = ("0 0 1", "1 0 0", "", "-1 0 0", "0 0 1", "1 0 0")
    path = serial_urdf(
        tmp_path / "one.urdf", ONE_SLIDE, axes=axes, slides={2: "0 0 -1"}, tip=TIP, limit=3.2
    )
    arm, header = emitted_in_both(Request(path, name="one"), tmp_path)
    random = np.random.default_rng(1)
    q = OUTSIDE[np.arange(300) % 3] + random.normal(size=(300, 6)) * 1e-4
    assert_answered(arm, header, arm.forward(q))
    assert gaps_in_both(arm, header, q).max() < 1e-4


def test_poses_at_which_two_directions_are_lost_are_answered(tmp_path: Path) -> None:
    axes = ("", "1 0 0", "0 1 0", "0 -1 0", "0 0 -1", "")
    slides = {0: "1 0 0", 5: "0 0 1"}
    path = serial_urdf(
        tmp_path / "two.urdf", TWO_SLIDES, axes=axes, slides=slides, tip=TIP, limit=3.0
    )
    arm, header = emitted_in_both(Request(path, name="two"), tmp_path)
    random = np.random.default_rng(0)
    q = random.uniform(-1.0, 1.0, (100, 6))
    q[:, 1:5] = random.choice([0.0, 0.5 * np.pi, -0.5 * np.pi], (100, 4))
    assert_answered(arm, header, arm.forward(q))
