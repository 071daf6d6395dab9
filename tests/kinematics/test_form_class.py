"""The class of closed form that geometry lets expect, with joints held."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.support.redundant_arms import SHOULDER_ELBOW_WRIST, TORSO, serial_urdf

from ikgen.derivation.read import read
from ikgen.kinematics.axis_relations import axis_relations
from ikgen.kinematics.form_class import FORM_WORDS, form_class, is_two_branch
from ikgen.records.request import Request

FIXTURES = Path(__file__).resolve().parents[2] / "urdf_fixtures"


def words(robot: Path, *held: int) -> str:
    """The class of the robot's arm with rows held, numbered from 1."""
    dh = read(Request(robot)).dh
    moving = [i for i in range(len(dh.rows)) if i + 1 not in held]
    return FORM_WORDS[form_class(dh.rows, moving, axis_relations(dh))]


@pytest.mark.parametrize(
    ("file", "expected"),
    [
        ("abb_irb2400.urdf", "position apart from rotation, two branches a step"),
        ("ur5e.urdf", "three parallel axes"),
    ],
)
def test_six_joints(file: str, expected: str) -> None:
    assert words(FIXTURES / file) == expected


def test_panda_like_arm_by_held_joint() -> None:
    """The spherical shoulder is lost with any of its axes, a wrist is not there."""
    found = {held: words(FIXTURES / "franka_fr3.urdf", held) for held in range(1, 8)}
    apart = "position apart from rotation, two branches a step"
    assert found[7] == apart
    assert all(found[held] != apart for held in (1, 2, 3))
    assert found[5] == "position apart from rotation, a quartic"


def test_joint_held_inside_a_spherical_shoulder_leaves_the_wrist(tmp_path: Path) -> None:
    path = tmp_path / "srs.urdf"
    path.write_text(serial_urdf("srs", SHOULDER_ELBOW_WRIST))
    relations = axis_relations(read(Request(path)).dh)
    assert {(0, 1, 2), (4, 5, 6)} <= relations.concurrent
    assert (0, 2) in relations.meeting and (0, 3) not in relations.meeting
    for held in (1, 2, 3, 5, 6, 7):
        assert words(path, held) == FORM_WORDS[0]


def test_three_slides_leave_the_rotation_alone(tmp_path: Path) -> None:
    slides = [(f"slide_{c}", "prismatic", a, "0 0 0.1", (0.0, 1.0)) for c, a in AXES.items()]
    path = tmp_path / "gantry.urdf"
    path.write_text(serial_urdf("gantry", [*slides, *SHOULDER_ELBOW_WRIST[3:6]]))
    assert words(path) == FORM_WORDS[0]
    path.write_text(serial_urdf("lift", [TORSO, *SHOULDER_ELBOW_WRIST[:4], TORSO_AT_TIP]))
    assert words(path) != FORM_WORDS[0]


AXES = {"x": "1 0 0", "y": "0 1 0", "z": "0 0 1"}
TORSO_AT_TIP = ("probe", "prismatic", "1 0 1", "0 0.1 0", (0.0, 0.2))


def test_two_branches_are_expected_of_the_first_classes_alone() -> None:
    expected = [is_two_branch(form) for form in range(len(FORM_WORDS))]
    assert expected == sorted(expected, reverse=True)
    assert not is_two_branch(FORM_WORDS.index("position apart from rotation, a quartic"))
