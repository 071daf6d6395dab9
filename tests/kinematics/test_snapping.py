"""The tolerances by themselves."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

from ikgen.kinematics.rigid import exact_cos_sin, rotation_x, rotation_z
from ikgen.kinematics.snapping import (
    LengthBook,
    SnapLog,
    exact_angle,
    snap_angle,
    snap_axis,
    snap_rotation,
    tidy,
    wrap_angle,
)


@pytest.mark.parametrize("written", [1.57, 1.571, 1.5708, 1.57079632679, 1.57079])
def test_half_turns_as_files_write_them(written: float) -> None:
    assert snap_angle(written, 2e-3) == math.pi / 2
    assert exact_angle(written, 2e-3, "x").exact == Fraction(1, 2)


@pytest.mark.parametrize("written", [3.14, 3.1416, -3.14159, -3.1416])
def test_pi_is_always_positive(written: float) -> None:
    angle = exact_angle(written, 2e-3, "x")
    assert (angle.exact, angle.value, angle.name) == (1, math.pi, None)


def test_other_angles_keep_their_name() -> None:
    angle = exact_angle(0.3, 2e-3, "alpha_2")
    assert (angle.exact, angle.value, angle.name) == (None, 0.3, "alpha_2")


def test_wrap() -> None:
    assert wrap_angle(-math.pi) == math.pi
    assert wrap_angle(7.0) == pytest.approx(7.0 - 2 * math.pi)


@pytest.mark.parametrize("steps", range(-11, 13))
def test_cosines_are_exact(steps: int) -> None:
    c, s = exact_cos_sin(steps * math.pi / 12)
    assert c * c + s * s == pytest.approx(1.0, abs=1e-15)
    if steps % 6 == 0:
        assert {abs(c), abs(s)} == {0.0, 1.0}


def test_rotations_snap_in_each_euler_angle() -> None:
    written = rotation_z(0.4) @ rotation_x(1.5708) @ rotation_z(3.1416)
    exact = rotation_z(0.4) @ rotation_x(math.pi / 2) @ rotation_z(math.pi)
    np.testing.assert_allclose(snap_rotation(written, 2e-3, 2e-3), exact, atol=1e-15)


@pytest.mark.parametrize("alpha", [1e-4, -1e-4, math.pi - 1e-4, math.pi + 1e-4])
def test_nearly_parallel_axes_become_parallel(alpha: float) -> None:
    R = snap_rotation(rotation_z(0.7) @ rotation_x(alpha) @ rotation_z(-0.2), 2e-3, 2e-3)
    assert abs(R[2, 2]) == 1.0
    assert R[0, 2] == R[1, 2] == 0.0


def test_axes_with_noise_in_small_components() -> None:
    noisy = np.array([-0.00010901, 0.0, 1.0])
    noisy /= np.linalg.norm(noisy)
    np.testing.assert_array_equal(snap_axis(noisy, 2e-3), [0, 0, 1])
    skew = np.array([0.0, 0.6, 0.8])
    assert snap_axis(skew, 2e-3) is skew


def test_tidy_drops_round_off_only() -> None:
    assert tidy(0.1 + 0.2) == 0.3
    assert tidy(0.1234567890123) == 0.1234567890123


def test_lengths_share_names_up_to_sign() -> None:
    log = SnapLog()
    book = LengthBook(1e-5, log)
    first, again = book.enter(0.25, "a_2"), book.enter(-0.250004, "d_4")
    assert (first.name, first.value, first.sign) == ("a_2", 0.25, 1)
    assert (again.name, again.value, again.sign) == ("a_2", -0.25, -1)
    zero = book.enter(8e-6, "d_5")
    assert (zero.value, zero.name) == (0.0, None)
    assert book.enter(8e-5, "d_6").name == "d_6"
    assert book.enter(8e-5, "d_7", length_error=1e-4).name is None
    assert [snap.what for snap in log.snaps] == ["d_4", "d_5", "d_7"]
