"""The drawn skeleton: where the arm's own kinematics puts it, named as the formulas are, one SVG."""

from __future__ import annotations

import re
import xml.dom.minidom
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from ikgen.derivation.read import read
from ikgen.kinematics.forward import dh_forward
from ikgen.model.dh import DHChain
from ikgen.records.request import Request
from ikgen.report.camera import hull, look_at
from ikgen.report.skeleton import Style, skeleton_camera, skeleton_svg
from ikgen.report.skeleton_bones import skeleton

ROOT = Path(__file__).resolve().parents[2]
ROBOTS = (
    "urdf_fixtures/puma560_paper.toml",
    "urdf_fixtures/ur5e.urdf",
    "urdf_fixtures/franka_fr3.urdf",
    "urdf_fixtures/scara_standard.toml",
    "tests/robots/tables/Olson13.toml",
    "tests/robots/tables/Wrist.toml",
)


@cache
def chain(robot: str) -> DHChain:
    tip = "tool0" if robot.endswith("ur5e.urdf") else None
    return read(Request(ROOT / robot, tip=tip)).dh


def values(dh: DHChain, seed: int = 3) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-1.2, 1.2, dh.dof)


@pytest.mark.parametrize("robot", ROBOTS)
def test_bones_lead_from_the_base_to_the_tip(robot: str) -> None:
    dh = chain(robot)
    q = values(dh)
    arm = skeleton(dh, q)
    np.testing.assert_allclose(arm.frames[-1], dh_forward(dh, q), atol=1e-12)
    for one, two in zip(arm.bones, arm.bones[1:], strict=False):
        np.testing.assert_allclose(one.end, two.start, atol=1e-8)
    np.testing.assert_allclose(arm.bones[-1].end, arm.frames[-1][:3, 3], atol=1e-8)


@pytest.mark.parametrize("robot", ROBOTS)
def test_joints_stand_on_their_axes(robot: str) -> None:
    """Turning or sliding a joint moves no joint before it, and turns those after it about its axis."""
    dh = chain(robot)
    q = values(dh)
    arm = skeleton(dh, q)
    for j, mark in enumerate(arm.joints):
        moved = q.copy()
        moved[dh.rows[j].driver] += 0.4
        other = skeleton(dh, moved)
        for before, after in zip(arm.joints[:j], other.joints[:j], strict=True):
            np.testing.assert_allclose(before.at, after.at, atol=1e-12)
        if mark.revolute:
            for T, moved_T in zip(arm.frames[j + 1 :], other.frames[j + 1 :], strict=True):
                far = np.cross(T[:3, 3] - mark.at, mark.along)
                moved_far = np.cross(moved_T[:3, 3] - mark.at, mark.along)
                assert abs(np.linalg.norm(far) - np.linalg.norm(moved_far)) < 1e-12


def test_lengths_are_named_as_in_the_formulas() -> None:
    dh = chain(ROBOTS[0])
    arm = skeleton(dh, values(dh))
    for bone in arm.bones:
        if bone.name:
            value = {"a_2": 5, "a_3": 1, "d_3": 2, "d_4": 4}[bone.name]
            assert abs(np.linalg.norm(bone.end - bone.start) - value) < 1e-12
    drawn = skeleton_svg(dh, values(dh))
    names = re.findall(r'arm-length"[^>]*><tspan[^>]*>(\w)</tspan><tspan[^>]*>(\w)<', drawn)
    assert sorted(names) == [("a", "2"), ("a", "3"), ("d", "3"), ("d", "4")]
    assert "arm-length" not in skeleton_svg(dh, values(dh), style=Style(190, 170, named=False))


@pytest.mark.parametrize("robot", ROBOTS)
def test_the_drawing_is_whole_and_inside_its_frame(robot: str) -> None:
    dh = chain(robot)
    style = Style(300, 260)
    rows = [values(dh, seed) for seed in range(4)]
    camera = skeleton_camera(dh, rows, style)
    for q in rows:
        text = skeleton_svg(dh, q, style=style, camera=camera, title="a < b")
        assert text == skeleton_svg(dh, q, style=style, camera=camera, title="a < b")
        root = xml.dom.minidom.parseString(text).documentElement
        assert root is not None and root.tagName == "svg" and "nan" not in text
        places = camera.place(skeleton(dh, q).points)
        assert places.min() >= 15 and np.all(places <= (285, 245))


def test_the_camera_keeps_angles_and_depth() -> None:
    points = np.random.default_rng(1).normal(size=(20, 3))
    camera = look_at(points, 200, 100, 10)
    np.testing.assert_allclose(camera.axes @ camera.axes.T, np.eye(3), atol=1e-12)
    assert camera.place(np.array([0, 0, 1.0]))[1] < camera.place(np.zeros(3))[1]
    assert camera.depth(camera.axes[2]) > camera.depth(np.zeros(3))


def test_hull_of_a_square_with_a_point_inside() -> None:
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1], [0.5, 0.5], [0.5, 0.0]])
    assert sorted(map(tuple, hull(square).tolist())) == [(0, 0), (0, 1), (1, 0), (1, 1)]
