"""What lies on a continuum of solutions, and what only has another solution beside it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.fake_arms import six_axis_oracle
from tests.support.rolling_forearm import FLAT_FOLDS, forearm_file, forearm_under_test

from ikgen.importers.dh.dh_table import read_dh_table
from ikgen.tasks import find_task
from ikgen.verify.arm import ArmUnderTest, arm_under_test
from ikgen.verify.oracle import Oracle, oracle_from_dh
from ikgen.verify.search import converge
from ikgen.verify.singularities import on_continuum, singular_configurations
from ikgen.verify.task_space import task_space

TWO_FOLDS = [
    ((0.0, 0.10166065335799836, 0.4530465960327399, 0.12107605454281573, 0.5678744437942167,
      1.4912238313977095, 1.3711233463636863),
     ((0.0, 2.4297427473867215, 0.8624464312172002), (0.0, 2.489742747387918, 0.8624464196452686))),
    ((0.3317149587542502, 0.40920065923873955, 0.14388590336774662, 0.617104418947296,
      0.09169564420632535, 0.7005216844918253, 2.573171868640501),
     ((0.0, -1.444335363304468, 2.365161668653258), (0.0, -1.4185323951501898, 2.4193299881261208))),
    ((0.3296127757736316, 0.5032174242435857, 0.16309611022035342, 0.015835525002738184,
      0.10431112386680558, 0.9311697474647748, 0.8857321499483216),
     ((0.0, -2.324155538457022, 1.583227412594267), (0.0, -2.303209384575399, 1.6394524838491218))),
]  # fmt: skip
"""Lengths and twists (a_1, a_2, tool, d_2, d_3, alpha_1, alpha_2; m, rad) of three-joint arms, and two
singular configurations, 0.06 rad apart, that reach the same radius and height: each a fold."""


def three_joints(lengths: tuple[float, ...], folder: Path) -> ArmUnderTest:
    """The arm of a row of `TWO_FOLDS`, for its tip's position."""
    a1, a2, tool, d2, d3, alpha1, alpha2 = lengths
    rows = ((0.0, 0.0, 0.0), (alpha1, a1, d2), (alpha2, a2, d3))
    joints = (
        f'[[joints]]\ntype = "revolute"\nalpha = {alpha!r}\na = {a!r}\nd = {d!r}\ntheta = 0\n'
        for alpha, a, d in rows
    )
    table = folder / "arm.toml"
    table.write_text(
        'name = "arm"\nconvention = "modified"\n' + "".join(joints)
        + f"[tool]\nxyz = [{tool!r}, 0, 0]\nrpy = [0, 0, 0]\n", encoding="utf-8",
    )  # fmt: skip
    return under_test(oracle_from_dh(read_dh_table(table)[1]), "position")


def of_rows(folder: Path, rows: Sequence[tuple[str, float, float, float, float]]) -> ArmUnderTest:
    """The arm of kind, alpha, a, theta (turns of 180 degrees) and d of each row, for the whole pose."""
    joints = (
        f'[[joints]]\ntype = "{kind}"\nalpha = "{alpha}*pi"\na = {a}\ntheta = "{theta}*pi"\nd = {d}\n'
        for kind, alpha, a, theta, d in rows
    )
    table = folder / "rows.toml"
    table.write_text('name = "arm"\nconvention = "modified"\n' + "".join(joints), encoding="utf-8")
    return under_test(oracle_from_dh(read_dh_table(table)[1]), "pose")


R, P = "revolute", "prismatic"
TWO_SLIDES = (
    (P, 0.0, 0.0, 0.0, 0.0), (R, 0.5, 0.0, 0.0, 0.0), (P, -0.5, 0.906, 0.5, 0.0),
    (R, -0.5, 0.549, 0.0, 0.0), (P, -0.5, 0.0, -0.5, 0.0), (R, -0.5, 0.0, 0.0, 0.0),
)  # fmt: skip
"""Slides whose directions an angle between them tells apart."""
THREE_AND_A_SLIDE = (
    (R, 0.0, 0.0, 0.0, 0.0), (R, 0.5, 0.0, 0.0, 0.0), (R, 0.5, 0.0, 0.0, 0.0),
    (R, 0.0, 0.9088601291442826, 0.0, 0.0), (R, 0.5, 0.0, 0.0, 0.8282191617670496),
    (P, 0.5, 0.5005600331837693, 0.0, 0.0),
)  # fmt: skip


def under_test(oracle: Oracle, task: str) -> ArmUnderTest:
    """An arm without limits."""
    free = np.full(oracle.dof, np.inf)
    return arm_under_test(oracle, task_space(find_task(task)), (-free, free), ())


@pytest.mark.parametrize(("lengths", "folds"), TWO_FOLDS)
def test_another_singular_solution_nearby_is_no_continuum(
    tmp_path: Path, lengths: tuple[float, ...], folds: tuple[tuple[float, ...], ...]
) -> None:
    arm = three_joints(lengths, tmp_path)
    q = np.array(folds)
    targets = arm.oracle.forward(q)
    assert (arm.sigma(q) < 1e-9).all()
    ends = [converge(arm, q + step * direction(arm, q), targets)[0] for step in (0.2, 0.05)]
    led_astray = [np.abs(end - q).max(axis=1) > 0.05 for end in ends]
    assert (led_astray[0] & led_astray[1]).any(), (
        "no step leaves the solution: the test shows nothing"
    )
    assert not on_continuum(arm, q, targets).any()


def direction(arm: ArmUnderTest, q: NDArray[np.float64]) -> NDArray[np.float64]:
    """The null direction of each configuration (N, dof)."""
    return np.asarray(np.linalg.svd(arm.scaled_jacobian(q)[1])[2][:, -1])


def test_aligned_axes_are_a_continuum() -> None:
    arm = under_test(six_axis_oracle(), "pose")
    q = np.array([[0.3, 0.5, 0.7, 0.4, 0.0, -1.0], [-1.0, 0.2, 0.9, 2.0, 0.0, 0.1]])
    assert on_continuum(arm, q, arm.oracle.forward(q)).all()


def test_a_tip_on_its_last_axis_is_a_continuum(tmp_path: Path) -> None:
    arm = three_joints((0.69, 0.62, 0.0, 0.69, 0.15, 1.58, 0.83), tmp_path)
    q = np.array([[0.1, -0.5, -1.8]])
    assert on_continuum(arm, q, arm.oracle.forward(q)).all()


def test_a_stretched_elbow_is_no_continuum() -> None:
    arm = under_test(six_axis_oracle(), "pose")
    q = np.array([[0.3, 0.5, 0.0, 0.4, 0.6, -1.0]])
    assert arm.sigma(q)[0] < 1e-9
    assert not on_continuum(arm, q, arm.oracle.forward(q)).any()


def test_slides_far_out_whose_directions_are_nearly_parallel_are_no_continuum(
    tmp_path: Path,
) -> None:
    arm = of_rows(tmp_path, TWO_SLIDES)
    wrist = (-3.1417317533, -8.0982153e-5, 1.5708010291)
    q = np.array([[1e4, aside, -1e4, *wrist] for aside in (-1.7e-4, 0.0)])
    assert (arm.sigma(q) < 1e-9).all()
    assert on_continuum(arm, q, arm.oracle.forward(q)).tolist() == [False, True]


def test_an_isolated_row_that_is_nearly_singular_is_no_continuum(tmp_path: Path) -> None:
    """Beside it poses are as near as the singular value times the way, which is not rounding."""
    arm = of_rows(tmp_path, THREE_AND_A_SLIDE)
    beside = -4.268089212392862, -3.1515147549873475, 2.696350427460675, 1.5709195369737774
    row = np.array([[*beside, 2.308266611278576, -0.0050883255596016275]])
    on_it = np.array([[-1.0, 0.0, 0.4, 0.3, 0.2, 0.1]])
    assert 1e-11 < arm.sigma(row)[0] < 1e-10 and arm.sigma(on_it)[0] < 1e-14
    q = np.concatenate([row, on_it])
    assert on_continuum(arm, q, arm.oracle.forward(q)).tolist() == [False, True]


@pytest.mark.parametrize("axis", FLAT_FOLDS)
def test_where_branches_meet_is_no_continuum_though_steps_leave_rounding(
    tmp_path: Path, axis: str
) -> None:
    """Farther on they leave more, to one side or both."""
    arm = forearm_under_test(forearm_file(tmp_path / "forearm.urdf"), axis)
    q = np.array(FLAT_FOLDS[axis])
    targets = arm.oracle.forward(q)
    assert (arm.sigma(q) < 1e-11).all()
    ends, reached = converge(arm, q + 0.2 * direction(arm, q), targets, enough=2e-13)
    far = np.abs(ends - q).max(axis=1) > 0.05
    assert (reached & far).any(), "no step leaves the solution: the test shows nothing"
    assert not on_continuum(arm, q, targets).any()


def test_the_same_arm_has_continua(tmp_path: Path) -> None:
    """Yaw and roll turn against each other below a tool that points straight up."""
    arm = forearm_under_test(forearm_file(tmp_path / "forearm.urdf"), "z")
    q = singular_configurations(arm, 300, np.random.default_rng(0))
    targets = arm.oracle.forward(q)
    upright = targets[:, 2, 2] > 1.0 - 1e-15
    assert upright.sum() > 20
    assert on_continuum(arm, q[upright], targets[upright]).all()


@pytest.mark.parametrize("tool", [0.0, 3e-13])
def test_what_rounding_alone_breaks_is_a_continuum(tmp_path: Path, tool: float) -> None:
    """All around the tip moves by less than rows may be off."""
    arm = three_joints((0.69, 0.62, tool, 0.69, 0.15, 1.58, 0.83), tmp_path)
    q = np.array([[0.1, -0.5, -1.8]])
    assert on_continuum(arm, q, arm.oracle.forward(q)).all()


def test_a_tip_that_turns_about_a_point_nearby_is_on_no_continuum(tmp_path: Path) -> None:
    arm = three_joints((0.69, 0.62, 1e-9, 0.69, 0.15, 1.58, 0.83), tmp_path)
    q = np.array([[0.1, -0.5, -1.8]])
    assert not on_continuum(arm, q, arm.oracle.forward(q)).any()
