"""Rows are told apart by what they are, not by where they stand."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import ikgen

pytestmark = pytest.mark.usefixtures("solved_once")

ROOT = Path(__file__).resolve().parents[3]
SIDES = ("ur5e.urdf", "abb_irb2400.urdf", "puma560_paper.toml", "doosan_m1013.urdf")


def arm(name: str) -> ikgen.Arm:
    return ikgen.load(ROOT / "urdf_fixtures" / name, verify=False, cache=False)


@pytest.mark.parametrize("name", SIDES)
def test_every_row_has_a_name_of_its_own_that_it_keeps(name: str) -> None:
    robot, rng = arm(name), np.random.default_rng(3)
    for _ in range(40):
        q = rng.uniform(-2.5, 2.5, 6)
        pose = robot.forward(q)
        found = robot.solve(pose, limits=False)
        names = dict(zip(found.branch, found.q, strict=True))
        assert len(names) == len(found)
        assert all(text.count(",") == 2 and "shoulder" in text for text in names)
        again = robot.solve(pose, limits=False, seed=rng.uniform(-2.0, 2.0, 6))
        for text, row in zip(again.branch, again.q, strict=True):
            assert np.allclose((row - names[text] + np.pi) % (2 * np.pi), np.pi, atol=1e-6)


@pytest.mark.parametrize("name", SIDES)
def test_a_name_stays_along_a_path(name: str) -> None:
    """Between singularities: the branch that a small motion leads to has the name of the one before."""
    robot, rng = arm(name), np.random.default_rng(5)
    for _ in range(20):
        q = rng.uniform(-2.0, 2.0, 6)
        if abs(np.linalg.det(robot.jacobian(q))) < 1e-2:
            continue
        near = q + 1e-3 * rng.uniform(-1.0, 1.0, 6)
        one = robot.solve(robot.forward(q), seed=q, limits=False)
        other = robot.solve(robot.forward(near), seed=near, limits=False)
        assert np.allclose(one[0], q, atol=1e-8) and one.branch[0] == other.branch[0]


def test_sides_are_where_they_are_said_to_be() -> None:
    """The elbow of a Puma above its shoulder and wrist, stretched to one side."""
    robot = arm("puma560_paper.toml")
    dh = robot.derivation.dh
    from ikgen.report.skeleton_bones import skeleton

    seen, rng = set(), np.random.default_rng(7)
    for _ in range(30):
        found = robot.solve(robot.forward(rng.uniform(-2.0, 2.0, 6)), limits=False)
        for row, text in zip(found, found.branch, strict=True):
            frames = skeleton(dh, row).frames
            shoulder, elbow, wrist = (frames[i][:3, 3] for i in (2, 3, 5))
            level = np.cross(frames[2][:3, 2], (0.0, 0.0, 1.0))  # in the plane of the two links
            out, up = level @ (wrist - shoulder), (wrist - shoulder)[2]
            bent = level @ (elbow - shoulder)
            height = (elbow - shoulder)[2] - bent * up / out  # of the elbow over the line
            if abs(out) > 0.2 and abs(height) > 0.02:
                assert ("elbow up" in text) == (height > 0.0)
                seen.add(text)
    assert len(seen) == 8


def test_other_arms_have_numbers() -> None:
    panda = arm("franka_fr3.urdf")
    q = np.array([0.1, 0.3, -0.2, -1.4, 0.3, 1.8, 0.4])
    held = {name: float(q[panda.joint_names.index(name)]) for name in panda.free_joints}
    found = panda.solve(panda.forward(q), free=held, limits=False)
    assert len(found) > 1 and len(set(found.branch)) == len(found)
    assert all(text.startswith("branch ") for text in found.branch)
    backwards = panda.solve(panda.forward(q), free=held, limits=False, seed=-q)
    assert sorted(backwards.branch) == sorted(found.branch)


def test_rows_are_a_sequence() -> None:
    robot = arm("ur5e.urdf")
    found = robot.solve(robot.forward([0.2, -0.9, 1.1, 0.3, 0.6, -0.4]))
    assert np.array_equal(found[0], found.q[0]) and np.array_equal(found[-1], found.q[-1])
    assert np.array_equal(found[1:3], found.q[1:3]) and len(found[::2]) == 4
    with pytest.raises(IndexError):
        found[8]
    nothing = robot.solve(np.eye(4) * np.nan)
    assert nothing.branch == () and len(nothing[:]) == 0 and "finite" in nothing.reason
