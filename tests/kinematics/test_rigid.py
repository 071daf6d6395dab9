"""Rigid transforms: one home, each against matrices put together by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from ikgen.kinematics.rigid import (
    axis_motion,
    coordinate_motion,
    cross_matrix,
    dh_link,
    exact_cos_sin,
    inverse,
    read_only,
    rotation_about,
    rotation_rpy,
    rotation_x,
    rotation_z,
    z_motion,
)

ANGLES = st.floats(-10.0, 10.0)
LENGTHS = st.floats(-5.0, 5.0)


def unit(x, y, z):
    return np.array([x, y, z]) / math.sqrt(x * x + y * y + z * z)


def pose(R=None, p=(0.0, 0.0, 0.0)):
    T = np.eye(4)
    if R is not None:
        T[:3, :3] = R
    T[:3, 3] = p
    return T


@pytest.mark.parametrize("steps", range(-12, 13))
def test_multiples_of_a_twelfth_of_pi_are_exact(steps):
    angle = steps * math.pi / 12
    c, s = exact_cos_sin(angle)
    assert abs(c - math.cos(angle)) < 1e-15 and abs(s - math.sin(angle)) < 1e-15
    for value, place in ((c, steps), (s, steps - 6)):
        if place % 6 == 0 or place % 12 in (4, 8):
            assert value in (-1.0, -0.5, 0.0, 0.5, 1.0)


@given(ANGLES)
def test_rotations_about_the_axes_agree(angle):
    z, x = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])
    np.testing.assert_allclose(rotation_about(z, angle), rotation_z(angle), atol=2e-15)
    np.testing.assert_allclose(rotation_about(x, angle), rotation_x(angle), atol=2e-15)
    for k, axis in enumerate(np.eye(3)):
        turned = coordinate_motion(True, k, angle)[:3, :3]
        np.testing.assert_allclose(rotation_about(axis, angle), turned, atol=2e-15)


@given(ANGLES, st.tuples(LENGTHS, LENGTHS, LENGTHS).filter(lambda v: np.linalg.norm(v) > 0.1))
def test_a_rotation_keeps_its_axis_and_turns_by_its_angle(angle, direction):
    axis = unit(*direction)
    R = rotation_about(axis, angle)
    np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-14)
    np.testing.assert_allclose(R @ axis, axis, atol=1e-14)
    assert np.trace(R) == pytest.approx(1 + 2 * math.cos(angle), abs=1e-13)
    np.testing.assert_allclose(cross_matrix(axis) @ direction, np.zeros(3), atol=1e-13)


@given(ANGLES, ANGLES, ANGLES)
def test_rpy_turns_about_fixed_axes(roll, pitch, yaw):
    y = rotation_about(np.array([0.0, 1.0, 0.0]), pitch)
    expected = rotation_z(yaw) @ y @ rotation_x(roll)
    np.testing.assert_allclose(rotation_rpy(roll, pitch, yaw), expected, atol=1e-14)


@given(ANGLES, LENGTHS, ANGLES, LENGTHS)
def test_a_row_is_twist_length_turn_and_offset(alpha, a, theta, d):
    expected = pose(rotation_x(alpha)) @ pose(p=(a, 0, 0)) @ pose(rotation_z(theta), (0, 0, d))
    np.testing.assert_allclose(dh_link(alpha, a, theta, d), expected, atol=1e-14)
    many = dh_link(np.full(3, alpha), a, np.array([theta, 0.0, theta]), d)
    assert many.shape == (3, 4, 4)
    np.testing.assert_allclose(many[[0, 2]], [expected, expected], atol=1e-14)


@given(ANGLES, st.tuples(LENGTHS, LENGTHS, LENGTHS))
def test_an_inverse_undoes(angle, p):
    T = pose(rotation_about(unit(1, 2, 3), angle), p)
    np.testing.assert_allclose(inverse(T) @ T, np.eye(4), atol=1e-13)


def test_motions_of_one_value_and_of_many_agree():
    axis, values = unit(1, -2, 0.5), np.array([[0.3, -1.0], [2.0, 0.0]])
    for revolute in (True, False):
        for motion in (
            lambda v, r=revolute: axis_motion(r, axis, v),
            lambda v, r=revolute: z_motion(r, v),
        ):
            many = motion(values)
            assert many.shape == (2, 2, 4, 4)
            np.testing.assert_allclose(many[1, 0], motion(2.0), atol=1e-16)
    np.testing.assert_allclose(axis_motion(False, axis, 2.0)[:3, 3], 2.0 * axis)


def test_read_only_is_a_copy_that_cannot_be_written():
    given = np.eye(2)
    copy = read_only(given)
    given[0, 0] = 5.0
    assert copy[0, 0] == 1.0
    with pytest.raises(ValueError, match="read-only"):
        copy[0, 0] = 2.0
