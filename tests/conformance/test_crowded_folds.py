"""Arms whose solutions meet in pairs where there is just room for all of them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.both_languages import emitted_in_both
from tests.support.serial_urdf import serial_urdf
from tests.support.solving import NO_COMPILER

from ikgen.generation.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

ORIGINS = (
    ("-0.01125 0 0.034", "0 0 0"),
    ("0 0 0.0635", "0 0 0"),
    ("0.0415 0 0.11315", "0 0 0"),
    ("0.162 0 0", "0 0 0"),
    ("0.0287 0 0", "0 0 0"),
)
AXES = ("0 0 1", "0 1 0", "0 1 0", "0 1 0", "1 0 0")
TIP = ("0.09193 -0.0016 0", "0 0 0")
TWO_PAIRS = np.array(  # next to straight elbows, in front and behind
    [
        [1.76624322525944, -0.921951370826616, -1.219263546640325, -2.576608031037773, 1.517923834081345],
        [2.441802859558683, -1.21091501818179, -1.219265114834966, -2.784551132191366, -1.48846989831823],
        [2.626048317761774, -2.922482625798344, -1.219267149485453, 2.846523492194994, 1.522686797263169],
    ]
)  # fmt: skip


@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles")
def test_a_row_beside_a_known_pair_takes_no_place(tmp_path: Path) -> None:
    path = serial_urdf(
        tmp_path / "crowded.urdf", ORIGINS, axes=AXES, tip=TIP, limit=6.283185307179586
    )
    arm, header = emitted_in_both(Request(path, name="crowded"), tmp_path)
    random = np.random.default_rng(1)
    q = TWO_PAIRS[random.integers(3, size=1500)] + random.normal(size=(1500, 5)) * 1e-8
    poses = arm.forward(q)
    batch, _, _ = arm.solve_batch(poses, limits=False)
    for found in (header.solve_many(poses, limits=False).q, batch):
        off = np.abs((found - q[:, None] + np.pi) % (2.0 * np.pi) - np.pi).max(axis=2)
        assert np.nanmin(np.where(np.isnan(off), np.inf, off), axis=1).max() < 1e-6
