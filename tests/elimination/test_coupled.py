"""Six revolute joints of which one turns several axes: complete and exact, wherever the axes lie."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.coupled_arms import coupled_table, hollow_wrist
from tests.support.solving import NO_COMPILER, import_text

from ikgen.elimination import EliminationPlan, elimination_plan
from ikgen.elimination.routine import Plan, runtime_policy, six_joints_batch
from ikgen.emit.python.python_emitter import emit_module
from ikgen.generation.derive import derive
from ikgen.generation.generate import generate
from ikgen.generation.read import read
from ikgen.generation.request import Outputs, Request
from ikgen.program.policy import SolvePolicy
from ikgen.runtime.python.chain_kinematics import Chain, chain_of, forward, jacobian
from ikgen.runtime.python.coupled_angle import CoupledAngle, coupled_determinants
from ikgen.runtime.python.refinement import newton
from ikgen.runtime.python.solution_rows import distinct_rows
from ikgen.runtime.python.whole_pose import PoseTask

Array = NDArray[np.float64]
POLICY = runtime_policy(SolvePolicy())
TURNS = (True,) * 6

COUPLED = ["q5*-1", "q2*1 q7", "q1*2 q3", "q3*-2 q4", "q4*3 q5", "q2*-1 q4"]
"""The source with its ratio, and what follows it: of a hollow wrist or of a general table."""


def coupled_arm(folder: Path, words: str) -> tuple[EliminationPlan, Chain]:
    """The plan of an arm, and its chain."""
    relation, _, follower = words.partition(" ")
    table = hollow_wrist(folder) if not follower else general_table(folder)
    dh = read(Request(table, couple={names(table, follower or "q6"): words_of(table, relation)})).dh
    plan = elimination_plan(dh)
    assert plan is not None, words
    return plan, chain_of(plan.frames, plan.motions, 6)


def general_table(folder: Path) -> Path:
    rng = np.random.default_rng(3)
    alpha, a, d = rng.uniform(-1.5, 1.5, 7), rng.uniform(0.1, 0.6, 7), rng.uniform(0.1, 0.6, 7)
    alpha[0] = a[0] = 0.0
    return coupled_table(folder, alpha.tolist(), a.tolist(), d.tolist())


def names(table: Path, short: str) -> str:
    """The joint's name in the file."""
    return read(Request(table)).dh.joints[int(short[1:]) - 1].name


def words_of(table: Path, relation: str) -> str:
    source, ratio = relation.split("*")
    return f"{names(table, source)}*{ratio}"


def solved(plan: EliminationPlan, poses: Array) -> list[Array]:
    find = CoupledAngle(plan.motions, plan.crowded)
    made = Plan(plan.length, plan.eliminations, TURNS, find, motions=plan.motions)
    return six_joints_batch(plan.frames, made, poses)


def regular(chain: Chain, count: int, seed: int) -> Array:
    q = np.random.default_rng(seed).uniform(-np.pi, np.pi, (3 * count, 6))
    return q[np.linalg.svd(jacobian(chain, q), compute_uv=False)[:, -1] > 2e-3][:count]


def apart(rows: Array, q: Array) -> Array:
    return np.asarray(np.abs(np.remainder(rows - q + np.pi, 2.0 * np.pi) - np.pi).max(axis=1))


def searched(plan: EliminationPlan, pose: Array, seed: int) -> Array:
    """An independent search: Newton's method from 600 random starts."""
    F, T = plan.frames.copy(), pose.copy()
    F[:, :3, 3] /= plan.length
    T[:3, 3] /= plan.length
    starts = np.random.default_rng(seed).uniform(-np.pi, np.pi, (600, 6))
    poses, chain = np.broadcast_to(T, (600, 4, 4)), chain_of(F, plan.motions, 6)
    q, error, *_ = newton(chain, PoseTask(1.0), range(6), starts, poses, 40, POLICY)
    ends = q[error < POLICY.arrived]
    return distinct_rows(ends, np.zeros(len(ends), dtype=np.intp), TURNS, 1e-5)[0]


@pytest.mark.parametrize("words", COUPLED)
def test_every_row_is_right_and_every_configuration_found(words: str, tmp_path: Path) -> None:
    plan, chain = coupled_arm(tmp_path, words)
    q = regular(chain, 40, seed=5)
    poses = forward(chain, q)
    for rows, pose, row in zip(solved(plan, poses), poses, q, strict=True):
        assert np.abs(forward(chain, rows) - pose).max() < 1e-9
        assert apart(rows, row).min() < 1e-5
        assert len(rows) <= plan.most


def test_a_wrist_held_nearly_straight(tmp_path: Path) -> None:
    """Two axes are nearly in line there, and the determinant is small whatever the pose."""
    plan, chain = coupled_arm(tmp_path, "q5*-1")
    assert plan.crowded
    q = np.random.default_rng(7).uniform(-np.pi, np.pi, (80, 6))
    q[:, plan.coupled] = plan.crowded[0] + np.random.default_rng(8).uniform(-0.1, 0.1, 80)
    q = q[np.linalg.svd(jacobian(chain, q), compute_uv=False)[:, -1] > 1e-3]
    assert len(q) > 40
    for rows, row in zip(solved(plan, forward(chain, q)), q, strict=True):
        assert apart(rows, row).min() < 1e-6
    general, _ = coupled_arm(tmp_path, "q1*2 q3")
    assert not general.crowded


@pytest.mark.parametrize("words", ["q5*-1", "q1*2 q3"])
def test_as_many_solutions_as_a_multi_start_search_finds(words: str, tmp_path: Path) -> None:
    plan, chain = coupled_arm(tmp_path, words)
    for k, pose in enumerate(forward(chain, regular(chain, 3, seed=8))):
        (rows,), others = solved(plan, pose[None]), searched(plan, pose, seed=k)
        assert len(others) and all(apart(rows, other).min() < 1e-4 for other in others)


def test_the_degree_is_that_of_the_determinant(tmp_path: Path) -> None:
    plan, chain = coupled_arm(tmp_path, "q5*-1")
    nodes = np.linspace(0.0, 2.0 * np.pi, 96, endpoint=False)
    poses = forward(chain, regular(chain, 4, seed=2))
    spectrum = np.abs(
        np.fft.fft(
            coupled_determinants(plan.motions, plan.frames, poses, plan.eliminations[0], nodes)
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
    relations = {
        names(table, "q3"): words_of(table, "q2*1"),
        names(table, "q6"): words_of(table, "q5*1"),
    }
    assert elimination_plan(read(Request(table, couple=relations)).dh) is None


@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER)
def test_a_hollow_wrist_is_verified_in_both_languages(tmp_path: Path) -> None:
    table = hollow_wrist(tmp_path)
    request = Request(table, couple={names(table, "q6"): words_of(table, "q5*-1")})
    made = generate(request, Outputs(("python", "cpp"), tmp_path / "out", samples=12))
    assert sorted(made.reports) == ["cpp", "python"]
    assert all(report.passed for report in made.reports.values())
    assert made.derivation.module.plan is not None


def test_a_held_slide_is_merged_into_the_chain(tmp_path: Path) -> None:
    table = hollow_wrist(tmp_path)
    rail = 'type = "prismatic"\nalpha = 0\na = 0\nd = 0\ntheta = 0\nlimits = [0.0, 1.0]'
    table.write_text(table.read_text().replace("[[joints]]", f"[[joints]]\n{rail}\n[[joints]]", 1))
    couple = {names(table, "q7"): words_of(table, "q6*-1")}
    module = derive(Request(table, couple=couple, free={names(table, "q1"): 0.2})).module
    arm = import_text(emit_module(module), tmp_path)
    q = np.random.default_rng(6).uniform(0.2, 1.0, (6, 7))
    for row in q:
        rows = arm.solve(arm.forward(row), free=row[:1], limits=False).q
        assert np.abs(arm.forward(rows) - arm.forward(row)).max() < 1e-9
        assert np.abs(rows - row).max(axis=1).min() < 1e-6
