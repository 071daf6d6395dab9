"""Arms of which more than two solutions meet: pairs with just room for them, and four on one curve."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.both_languages import emitted_in_both
from tests.support.row_gaps import gaps_in_both
from tests.support.serial_urdf import serial_urdf
from tests.support.solving import NO_COMPILER

from ikgen.records.request import Request

pytestmark = [
    pytest.mark.usefixtures("solved_once"),
    pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles"),
]

FIVE = (
    ("-0.01125 0 0.034", "0 0 0"),
    ("0 0 0.0635", "0 0 0"),
    ("0.0415 0 0.11315", "0 0 0"),
    ("0.162 0 0", "0 0 0"),
    ("0.0287 0 0", "0 0 0"),
)
TWO_PAIRS = np.array(  # next to straight elbows, in front and behind
    [
        [1.76624322525944, -0.921951370826616, -1.219263546640325, -2.576608031037773, 1.517923834081345],
        [2.441802859558683, -1.21091501818179, -1.219265114834966, -2.784551132191366, -1.48846989831823],
        [2.626048317761774, -2.922482625798344, -1.219267149485453, 2.846523492194994, 1.522686797263169],
    ]
)  # fmt: skip
FOUR = (  # right angles and half turns as a file of a kit has them
    ("0.1 0.03 0.435", "1.570795 0 1.570795"),
    ("0 0.019 0", "-1.570795 1.570795 3.14159"),
    ("0 0 -0.0415", "0 3.14159 0"),
    ("0 0 0.0645", "0 3.14159 0"),
    ("0 0 -0.0415", "0 3.14159 0"),
    ("0 0 0.0645", "0 3.14159 0"),
    ("0 0 -0.0415", "0 3.14159 0"),
    ("0 0 0.0265", "0 3.14159 -3.14159"),
)


@pytest.mark.long
def test_a_row_beside_a_known_pair_takes_no_place(tmp_path: Path) -> None:
    axes, tip = ("0 0 1", "0 1 0", "0 1 0", "0 1 0", "1 0 0"), ("0.09193 -0.0016 0", "0 0 0")
    path = serial_urdf(tmp_path / "crowded.urdf", FIVE, axes=axes, tip=tip, limit=6.283185307179586)
    arm, header = emitted_in_both(Request(path, name="crowded"), tmp_path)
    random = np.random.default_rng(1)
    q = TWO_PAIRS[random.integers(3, size=1500)] + random.normal(size=(1500, 5)) * 1e-8
    assert gaps_in_both(arm, header, q, limits=False).max() < 1e-6


@pytest.mark.long
def test_all_four_on_one_curve_are_found(tmp_path: Path) -> None:
    """A straight elbow under an upright tool: what is left bends twice along it."""
    axes = ("", "0 0 -1", "0 1 0", "", "0 1 0", "", "0 1 0", "")
    path = serial_urdf(
        tmp_path / "curve.urdf",
        FOUR,
        axes=axes,
        tip=("0 0 -0.019", "1.570795 3.14159 1.570795"),
        limit=3.0,
    )
    request = Request(path, name="curve", task="position-pitch", tool_axis="z")
    arm, header = emitted_in_both(request, tmp_path)
    random = np.random.default_rng(2)
    q = random.uniform(-1.0, 1.0, (1200, 4))
    sign = np.sign(random.uniform(-1.0, 1.0, (2, 1200)))
    q[:, 2] = sign[0] * 10.0 ** random.uniform(-2.5, -2.0, 1200)
    lean = sign[1] * 10.0 ** random.uniform(-4.5, -4.0, 1200)
    q[:, 3] = lean - 0.5 * np.pi - q[:, 1] - q[:, 2]
    assert gaps_in_both(arm, header, q, limits=False).max() < 1e-4
