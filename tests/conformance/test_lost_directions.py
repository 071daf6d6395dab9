"""Solutions beside which a direction of the closed form is lost, or two of its branches are one."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from benchmarks.agreement import arm_of, runner_of
from numpy.typing import NDArray
from tests.support.sampled import PYTHON_OFTEN
from tests.support.serial_urdf import serial_urdf

from ikgen.derivation.derive import derive
from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

SHOULDER = [
    ("0 0 0.3", "0 0 0"), ("0 0 0", "-1.047 0 0"), ("0 0 0", "1.047 0 0"), ("0.3 0.02 0.3", "-1.571 0 0"),
    ("0.2 0 0.03", "0.785 0 0"), ("0.1 0.05 0", "1.571 0 0"),
]  # fmt: skip
"""At 0 joint 1 puts the axes of joints 0 and 2 on one line."""

OFFSET = [
    ("0 0 0.3", "0 0 0"), ("0.03 0 0", "-1.571 0 0"), ("0 -0.3 0", "1.571 0 0"), ("0 0 0", "-1.571 0 0"),
    ("0 -0.3 0", "1.571 0 0"), ("0 0 0", "-1.571 0 0"), ("0.08 0 0", "1.571 0 0"),
]  # fmt: skip
"""Rounded, of which a quartic has two roots in one at poses where the file's arm has two solutions."""

MEETING = [
    [-1.5707963267948966, 1.5717963267948964, 1.5707963267948966, 0.7853981633974483,
     1.5631442796531496, 0.7863981633974483, 0.7853981633974483],
    [-0.9922384194170122, -1.5749259525587025, -2.764850435788799, 0.8843494027308239,
     -1.5630775173094966, 1.9555871106122087, -0.3449949120907947],
]  # fmt: skip


ELBOW = [
    ("0 0 0.3", "0 0 0"), ("0 0 0", "-1.5708 0 0"), ("0 -0.3 0", "1.5708 0 0"), ("0.05 0 0", "-1.5708 0 0"),
    ("-0.05 -0.3 0", "1.5708 0 0"), ("0 0 0", "-1.5708 0 0"), ("0 0 0", "1.5708 0 0"),
]  # fmt: skip

TELESCOPE = [
    ("0 0 0.3", "0 0 0"), ("0.1 0 0.2", "-1.5708 0 0"), ("0.1 0 0", "0 1.571 0"), ("0 0 0.2", "0 0 0"),
    ("0 0 0.1", "1.5708 0 0"), ("0 0 0.1", "-1.5708 0 0"), ("0 0.02 0.1", "1.5708 0 0"),
]  # fmt: skip
"""Joints 2 and 3 slide, as far as each other."""

RANGES = [
    (-np.pi, np.pi),
    (-1.5, 1.2),
    (0.0, 0.5),
    (0.0, 0.5),
    (-2.0, 2.0),
    (-np.pi, np.pi),
    (-np.pi, np.pi),
]
STRAIGHT = [
    [0.17440544271208136, 0.0, 0.14720211053018623, -0.16784288461444197, -3.141592653589793,
     -2.2577628739930318],
    [np.pi, 0.0, 0.25, -0.6598977962130697, np.pi, -np.pi],
]  # fmt: skip


def found_at(found: NDArray[np.float64], q: NDArray[np.float64]) -> NDArray[np.float64]:
    """How far (rad) rows (n, dof) are from configurations (n, dof), on the shortest way."""
    return np.asarray(np.abs(np.remainder(found - q + np.pi, 2.0 * np.pi) - np.pi).max(axis=1))


@PYTHON_OFTEN
def test_both_signs_of_a_joint_are_found_next_to_nothing(language: str, tmp_path: Path) -> None:
    """Newton steps from both go to one of them: they have lost in which direction each of them is."""
    path = serial_urdf(tmp_path / "arm.urdf", SHOULDER, tip=("0 0 0.1", "0 0 0"), limit=np.pi)
    derivation, rng = derive(Request(path)), np.random.default_rng(1)
    arm, runner = arm_of(derivation), runner_of(derivation, language, tmp_path)
    for off in (1e-6, 3e-6, 1e-5):
        q = rng.uniform(-2.5, 2.5, (120, 6))
        q[:, 1] = rng.choice([-off, off], 120)
        index, found, _ = runner.solve_many(arm.oracle.forward(q)).flat()
        near = np.unique(index[found_at(found, q[index]) < 1e-5])
        assert len(near) >= 119, off


@PYTHON_OFTEN
def test_two_solutions_are_found_where_a_quartic_has_one_root(
    language: str, tmp_path: Path
) -> None:
    path = serial_urdf(tmp_path / "arm.urdf", OFFSET, tip=("0 0 0.1", "0 0 0"), limit=np.pi)
    derivation, q = derive(Request(path, free={"j6": None})), np.array(MEETING)
    arm, runner = arm_of(derivation), runner_of(derivation, language, tmp_path)
    index, found, _ = runner.solve_many(arm.oracle.forward(q), free=q[:, 6:]).flat()
    near = index[found_at(found, q[index]) < 1e-6]
    assert sorted(near.tolist()) == [0, 1]


@PYTHON_OFTEN
def test_a_slide_s_elimination_does_not_hide_what_is_singular(
    language: str, tmp_path: Path
) -> None:
    """The pose itself has no roots of it, poses beside have."""
    slides = {2: "0 0 1", 3: "0 0 1"}
    path = serial_urdf(
        tmp_path / "arm.urdf", TELESCOPE, tip=("0 0 0.1", "0 0 0"), slides=slides, limit=RANGES
    )
    head, tail = path.read_text().split('<joint name="j3" type="prismatic">')
    path.write_text(f'{head}<joint name="j3" type="prismatic"><mimic joint="j2"/>{tail}')
    derivation, q = derive(Request(path)), np.array(STRAIGHT)
    arm, runner = arm_of(derivation), runner_of(derivation, language, tmp_path)
    index, found, _ = runner.solve_many(arm.oracle.forward(q)).flat()
    assert sorted(set(index[found_at(found, q[index]) < 1e-6].tolist())) == [0, 1]


@PYTHON_OFTEN
def test_a_straight_wrist_that_steps_come_to_from_aside_is_a_continuum(
    language: str, tmp_path: Path
) -> None:
    """Rounded, and beside a second singularity: what is solved has the wrist a little bent."""
    limits = [
        (-np.pi, np.pi),
        (-2.0, 2.0),
        (-np.pi, np.pi),
        (-0.1, 2.6),
        (-np.pi, np.pi),
        (-2.0, 2.0),
    ]
    path = serial_urdf(
        tmp_path / "arm.urdf", ELBOW, tip=("0 0 0.1", "0 0 0"), limit=[*limits, (-np.pi, np.pi)]
    )
    derivation, rng = derive(Request(path, free={"j2": None})), np.random.default_rng(0)
    arm, runner = arm_of(derivation), runner_of(derivation, language, tmp_path)
    q = rng.uniform(-2.0, 2.0, (150, 7))
    q[:, 3] = rng.uniform(0.3, 2.0, 150)
    q[:, 1] = rng.choice([0.0, 1e-3, 1e-6], 150) - 0.5 * q[:, 3]
    q[0, :3] = 2.6174313018863327, -0.6620645166057497, 0.1233645964353749
    q[0, 3:5] = 1.3244460644514895, -1.7564176110526317
    q[:, 5] = 0.0
    index, found, singular = runner.solve_many(
        arm.oracle.forward(q), free=q[:, 2:3], seeds=q
    ).flat()
    assert singular[arm.sigma(found) < 1e-9].all()
    assert np.unique(index[found_at(found, q[index]) < 1e-6]).tolist() == list(range(150))
