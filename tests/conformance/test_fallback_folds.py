"""Folds of a form with two branches where the one behind it, which has one, loses its divisor as well."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from benchmarks.agreement import arm_of, runner_of
from numpy.typing import NDArray
from tests.support.sampled import BOTH
from tests.support.serial_urdf import serial_urdf

from ikgen.derivation.derive import derive
from ikgen.records.request import Request
from ikgen.verify.arm import ArmUnderTest

pytestmark = pytest.mark.usefixtures("solved_once")

H = "1.571"
FOUR_TURNS = [
    ("0 0 0.1", "0 0 0"), ("0.05 0 0.05", f"-{H} 0 0"), ("0.13 0.024 0", f"{H} 0 0"),
    ("0.124 0 0", f"-{H} 0 0"),
]  # fmt: skip
"""With joint 2 at 0 the arm lies in a plane, and both of its elbow's sides have one value of joint 0."""


def beside_stretched(arm: ArmUnderTest, held: float, off: float) -> NDArray[np.float64]:
    """Configurations (200, 4) with joint 2 held there, joint 3 so far (rad) from where the rest is
    singular."""
    rng = np.random.default_rng(3)
    q = rng.uniform(-2.5, 2.5, (200, 4))
    q[:, 2] = held
    ends = np.array([np.full(200, -0.5), np.full(200, 0.9)])
    for _ in range(60):
        middle = ends.mean(axis=0)
        same = np.sign(volume(arm, q, middle)) == np.sign(volume(arm, q, ends[0]))
        ends[0], ends[1] = np.where(same, middle, ends[0]), np.where(same, ends[1], middle)
    q[:, 3] = ends[0] + off * rng.choice([-1.0, 1.0], 200)
    return q


def volume(
    arm: ArmUnderTest, q: NDArray[np.float64], last: NDArray[np.float64]
) -> NDArray[np.float64]:
    """What the positions that joints 0, 1 and 3 lead to span."""
    J = arm.oracle.jacobian(np.column_stack([q[:, :3], last]))
    return np.asarray(np.linalg.det(J[:, :3][:, :, [0, 1, 3]]))


@pytest.mark.long
@BOTH
def test_both_sides_are_found_beside_a_fold_at_which_the_fallback_tells_nothing(
    language: str, tmp_path: Path
) -> None:
    path = serial_urdf(
        tmp_path / "arm.urdf", FOUR_TURNS, tip=("0.126 0 0.05", f"0 {H} 0"), limit=np.pi
    )
    derivation = derive(Request(path, task="position", free={"j2": None}))
    arm, runner = arm_of(derivation), runner_of(derivation, language, tmp_path)
    for held in (0.0, 1e-5):
        for off in (1e-3, 1e-4):
            q = beside_stretched(arm, held, off)
            rows = runner.solve_many(arm.oracle.forward(q), free=q[:, 2:3])
            index, found, _ = rows.flat()
            gap = np.abs(np.remainder(found - q[index] + np.pi, 2.0 * np.pi) - np.pi).max(axis=1)
            assert np.unique(index[gap < 1e-6]).tolist() == list(range(200)), (held, off)
