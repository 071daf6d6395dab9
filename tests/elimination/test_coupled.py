"""Six revolute joints of which one turns several axes: complete and exact, wherever the axes lie."""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Sequence
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.coupled_arms import coupled_table, hollow_wrist, parallelogram_arm
from tests.support.held_stacks import assert_solved_as_each_alone
from tests.support.multi_start import apart, searched
from tests.support.solving import NO_COMPILER, import_text

from ikgen.derivation.derive import derive
from ikgen.derivation.read import read
from ikgen.elimination import EliminationPlan, elimination_plan
from ikgen.elimination.routine import Plan, six_joints_batch
from ikgen.emit.python.python_emitter import emit_module
from ikgen.generation.generate import generate
from ikgen.records.request import Outputs, Request
from ikgen.runtime.python.arm.chain_kinematics import Chain, chain_of, forward, jacobian
from ikgen.runtime.python.elimination.coupled_angle import CoupledAngle, coupled_determinants
from ikgen.runtime.python.elimination.general_6r import Candidates, Elimination
from ikgen.runtime.python.rows.solution_rows import Turning

Array = NDArray[np.float64]
TURNS = (True,) * 6

RIGHT_ANGLES = {
    "q6=q2*1": (
        (0, 0, -1, 1, 1, 1, -1),
        (0.0, 0.0, 0.49, 0.0, 0.0, 0.28, 0.47),
        (0.0, 0.0, 0.19, 0.13, 0.0, 0.0, 0.0),
    ),
    "q3=q1*1": (
        (0, 0, 1, -1, 1, 0, 1),
        (0.0, 0.0, 0.0, 0.41, 0.0, 0.14, 0.0),
        (0.0, 0.39, 0.0, 0.11, 0.42, 0.44, 0.11),
    ),
}
"""Twists over 90 degrees and lengths of tables whose twelve equations are singular at every angle of the
coupled joint."""
COUPLED = ["q6=q5*-1", "q7=q2*1", "q3=q1*2", "q4=q3*-2", "q5=q4*3", "q4=q2*-1"]
"""What follows what with which ratio: of a hollow wrist, then of a general table."""
HOLLOW = COUPLED[0]
PARALLELOGRAM = {"q4": "q2*-1"}


@cache
def coupled_arm(relation: str) -> tuple[EliminationPlan, Chain]:
    """The plan of an arm, and its chain."""
    follower, _, words = relation.partition("=")
    with tempfile.TemporaryDirectory() as name:
        table = (hollow_wrist if relation == HOLLOW else general_table)(Path(name))
        plan = elimination_plan(read(Request(table, couple={follower: words})).dh)
    assert plan is not None, relation
    return plan, chain_of(plan.frames, plan.motions, 6)


def general_table(folder: Path) -> Path:
    rng = np.random.default_rng(3)
    alpha, a, d = rng.uniform(-1.5, 1.5, 7), rng.uniform(0.1, 0.6, 7), rng.uniform(0.1, 0.6, 7)
    alpha[0] = a[0] = 0.0
    return coupled_table(folder, alpha.tolist(), a.tolist(), d.tolist())


def solved(plan: EliminationPlan, poses: Array) -> list[Array]:
    find = plan.routine.find
    assert isinstance(find, type)
    finder = find(plan.motions, plan.crowded, plan.share)
    made = Plan(plan.length, plan.eliminations, TURNS, finder, motions=plan.motions)
    return six_joints_batch(plan.frames, made, poses)


def right_angled_table(folder: Path, relation: str = "q6=q2*1") -> Path:
    twists, a, d = RIGHT_ANGLES[relation]
    return coupled_table(folder, [0.5 * np.pi * k for k in twists], a, d)


@cache
def right_angled_arm(relation: str) -> tuple[EliminationPlan, Chain]:
    """The plan of an arm of `RIGHT_ANGLES`, and its chain."""
    follower, _, words = relation.partition("=")
    with tempfile.TemporaryDirectory() as name:
        table = right_angled_table(Path(name), relation)
        plan = elimination_plan(read(Request(table, couple={follower: words})).dh)
    assert plan is not None, relation
    return plan, chain_of(plan.frames, plan.motions, 6)


def regular(chain: Chain, count: int, seed: int) -> Array:
    q = np.random.default_rng(seed).uniform(-np.pi, np.pi, (3 * count, 6))
    return q[np.linalg.svd(jacobian(chain, q), compute_uv=False)[:, -1] > 2e-3][:count]


@pytest.mark.parametrize("relation", COUPLED)
def test_every_row_is_right_and_every_configuration_found(relation: str) -> None:
    plan, chain = coupled_arm(relation)
    q = regular(chain, 40, seed=5)
    poses = forward(chain, q)
    for rows, pose, row in zip(solved(plan, poses), poses, q, strict=True):
        assert np.abs(forward(chain, rows) - pose).max() < 1e-9
        assert apart(rows, row).min() < 1e-5
        assert len(rows) <= plan.most


@pytest.mark.parametrize("relation", RIGHT_ANGLES)
def test_right_angles_that_leave_no_rank_take_half_angles_of_both_angles(relation: str) -> None:
    plan, chain = right_angled_arm(relation)
    assert plan.both
    q = regular(chain, 40, seed=6)
    poses = forward(chain, q)
    for rows, pose, row in zip(solved(plan, poses), poses, q, strict=True):
        assert np.abs(forward(chain, rows) - pose).max() < 1e-9
        assert apart(rows, row).min() < 1e-5
        assert len(rows) % 2 == 0
    for rows, pose in zip(solved(plan, poses[:2]), poses, strict=False):
        for other in searched(plan.frames, plan.motions, TURNS, plan.length, pose, seed=3):
            assert apart(rows, other).min() < 1e-4


@pytest.mark.parametrize("place", [1, 3, 6])
def test_poses_with_held_values_of_their_own_are_solved_as_each_is_alone(place: int) -> None:
    plan, _ = coupled_arm(HOLLOW)
    rng = np.random.default_rng(place)
    held = rng.uniform(-0.2, 0.2, (3, 1))
    angle = CoupledAngle(plan.motions, plan.crowded)
    made = Plan(plan.length, plan.eliminations, TURNS, angle, motions=plan.motions)
    assert_solved_as_each_alone(made, plan.frames, plan.motions, place, held, rng, 1e-7)


def test_a_wrist_held_nearly_straight() -> None:
    """Two axes are nearly in line there, and the determinant is small whatever the pose."""
    plan, chain = coupled_arm(HOLLOW)
    assert plan.crowded
    q = np.random.default_rng(7).uniform(-np.pi, np.pi, (80, 6))
    q[:, plan.coupled] = plan.crowded[0][0] + np.random.default_rng(8).uniform(-0.1, 0.1, 80)
    q = q[np.linalg.svd(jacobian(chain, q), compute_uv=False)[:, -1] > 1e-3]
    assert len(q) > 40
    for rows, row in zip(solved(plan, forward(chain, q)), q, strict=True):
        assert apart(rows, row).min() < 1e-6
    general, _ = coupled_arm("q3=q1*2")
    assert not general.crowded


def test_roots_that_lie_close_together_are_told_apart(tmp_path: Path) -> None:
    """Beside multiples of 45 degrees up to six solutions have nearly the same coupled angle, at regular
    configurations too; rounding of the whole circle's polynomial moves its roots there by 1e-2 rad."""
    plan = elimination_plan(read(Request(parallelogram_arm(tmp_path), couple=PARALLELOGRAM)).dh)
    assert plan is not None
    chain = chain_of(plan.frames, plan.motions, 6)
    rng = np.random.default_rng(2)
    q = np.pi / 4 * rng.integers(-4, 5, (400, 6))
    q = q + 10.0 ** rng.uniform(-10, -1, (400, 1)) * rng.normal(size=(400, 6))
    q = q[np.linalg.svd(jacobian(chain, q), compute_uv=False)[:, -1] > 2e-3]
    assert len(q) > 250
    for rows, row in zip(solved(plan, forward(chain, q)), q, strict=True):
        assert len(rows) % 2 == 0
        assert apart(rows, row).min() < 1e-5


class Doubting(CoupledAngle):
    """Finds the same, and leaves it open whether that is all."""

    def __call__(
        self, F: Sequence[Array], T: Array, elimination: Elimination, turning: Turning
    ) -> Candidates:
        pose, q, least, clear = super().__call__(F, T, elimination, turning)
        return pose, q, np.zeros_like(least), np.zeros_like(clear)


def test_one_run_is_enough_where_roots_leave_no_doubt() -> None:
    plan, chain = coupled_arm(HOLLOW)
    q = np.random.default_rng(9).uniform(-np.pi, np.pi, (120, 6))
    straight = 10.0 ** np.random.default_rng(10).uniform(-4.0, -1.0, 60)
    q[60:, plan.coupled] = plan.crowded[0][0] + straight
    poses, find = forward(chain, q), CoupledAngle(plan.motions, plan.crowded)
    _, _, least, clear = find([*plan.frames[:, None]], poses, plan.eliminations[0], TURNS)
    assert clear[:60].mean() > 0.8
    assert clear.mean() < 0.9
    made = (
        Plan(plan.length, plan.eliminations, TURNS, kind, motions=plan.motions)
        for kind in (find, Doubting(plan.motions, plan.crowded))
    )
    one, all_runs = (six_joints_batch(plan.frames, each, poses) for each in made)
    assert [len(rows) for rows in one] == [len(rows) for rows in all_runs]
    assert [len(rows) for rows, sure in zip(one, clear, strict=True) if sure] == least[
        clear
    ].tolist()


@pytest.mark.parametrize("relation", [HOLLOW, "q3=q1*2"])
def test_as_many_solutions_as_a_multi_start_search_finds(relation: str) -> None:
    plan, chain = coupled_arm(relation)
    for k, pose in enumerate(forward(chain, regular(chain, 3, seed=8))):
        (rows,) = solved(plan, pose[None])
        for other in searched(plan.frames, plan.motions, TURNS, plan.length, pose, seed=k):
            assert apart(rows, other).min() < 1e-4


def test_the_degree_is_that_of_the_determinant() -> None:
    plan, chain = coupled_arm(HOLLOW)
    nodes = np.linspace(0.0, 2.0 * np.pi, 96, endpoint=False)
    poses = forward(chain, regular(chain, 4, seed=2))
    spectrum = np.abs(
        np.fft.fft(
            coupled_determinants(
                plan.motions, [*plan.frames[:, None]], poses, plan.eliminations[0], nodes
            )
        )
    )
    degree = plan.eliminations[0][2]
    assert degree == 16
    largest = spectrum.max(axis=1)
    assert (spectrum[:, degree + 1 : 96 - degree].max(axis=1) < 1e-11 * largest).all()
    assert (spectrum[:, degree] > 1e-12 * largest).any()


def test_two_coupled_joints_have_no_plan(tmp_path: Path) -> None:
    alpha = [0.0, 1.1, -0.7, 0.9, 1.3, -0.8, 0.6, 1.2]
    table = coupled_table(tmp_path, alpha, [0.0, *[0.3] * 7], [0.2] * 8)
    relations = {"q3": "q2*1", "q6": "q5*1"}
    assert elimination_plan(read(Request(table, couple=relations)).dh) is None


@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER)
@pytest.mark.parametrize(
    ("table", "couple"),
    [
        (hollow_wrist, {"q6": "q5*-1"}),
        (right_angled_table, {"q6": "q2*1"}),
        pytest.param(parallelogram_arm, PARALLELOGRAM, marks=pytest.mark.long),
    ],
)
def test_it_is_verified_in_both_languages(
    table: Callable[[Path], Path], couple: dict[str, str], tmp_path: Path
) -> None:
    request = Request(table(tmp_path), couple=couple)
    made = generate(request, Outputs(("python", "cpp"), tmp_path / "out", samples=12))
    assert sorted(made.reports) == ["cpp", "python"]
    assert all(report.passed for report in made.reports.values())
    assert made.derivation.module.plan is not None


def test_a_held_slide_is_merged_into_the_chain(tmp_path: Path) -> None:
    table = hollow_wrist(tmp_path)
    rail = (
        'name = "rail"\ntype = "prismatic"\nalpha = 0\na = 0\nd = 0\ntheta = 0\nlimits = [0.0, 1.0]'
    )
    table.write_text(table.read_text().replace("[[joints]]", f"[[joints]]\n{rail}\n[[joints]]", 1))
    module = derive(Request(table, couple={"q6": "q5*-1"}, free={"rail": 0.2})).module
    arm = import_text(emit_module(module), tmp_path)
    q = np.random.default_rng(6).uniform(0.2, 1.0, (6, 7))
    for row in q:
        rows = arm.solve(arm.forward(row), free=row[:1], limits=False).q
        assert np.abs(arm.forward(rows) - arm.forward(row)).max() < 1e-9
        assert np.abs(rows - row).max(axis=1).min() < 1e-6
