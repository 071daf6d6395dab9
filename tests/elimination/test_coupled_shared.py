"""Chains with followers of which several solutions share each value of the joint that is followed."""

from __future__ import annotations

import re
import tempfile
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.coupled_arms import coupled_table
from tests.support.multi_start import apart, searched
from tests.support.solving import NO_COMPILER

from ikgen.derivation.read import read
from ikgen.elimination import EliminationPlan, elimination_plan
from ikgen.elimination.refusal import coupled_refusal
from ikgen.elimination.routine import Plan, six_joints_batch
from ikgen.generation.generate import generate
from ikgen.records.request import Outputs, Request
from ikgen.runtime.python.arm.chain_kinematics import Chain, chain_of, forward, jacobian
from ikgen.runtime.python.elimination.coupled_shared import (
    CoupledSharedAngle,
    shared_determinants,
)

Array = NDArray[np.float64]
TURNS = (True,) * 6
ROUND: Array = 2.0 * np.pi / 96 * np.arange(96, dtype=float)

CHAINED = {"q3": "q2*1+0.1", "q4": "q2*-2-0.2"}
MULTIPLES = {"q3": "q2*2", "q4": "q2*-2"}
"""Followers on parallel axes: of the first the rotation does not hang on the joint that they follow."""


def followers_and_wrist(folder: Path) -> Path:
    """Joints 2 to 4 on parallel axes, joint 5, and three axes that meet."""
    quarter = 0.5 * np.pi
    alpha = [0.0, -quarter, 0.0, 0.0, quarter, quarter, -quarter, quarter]
    return coupled_table(
        folder, alpha, [0, 0, 0.3, 0.25, 0.1, 0.05, 0, 0], [0.3, 0, 0, 0, 0, 0.2, 0, 0]
    )


@cache
def arm_of(*couple: tuple[str, str]) -> tuple[EliminationPlan, Chain]:
    """The plan of the arm with these followers, and its chain."""
    with tempfile.TemporaryDirectory() as name:
        table = followers_and_wrist(Path(name))
        plan = elimination_plan(read(Request(table, couple=dict(couple))).dh)
    assert plan is not None
    return plan, chain_of(plan.frames, plan.motions, 6)


def solved(plan: EliminationPlan, poses: Array) -> list[Array]:
    find = CoupledSharedAngle(plan.motions, plan.crowded, plan.share)
    made = Plan(plan.length, plan.eliminations, TURNS, find, motions=plan.motions)
    return six_joints_batch(plan.frames, made, poses)


def regular(chain: Chain, count: int, seed: int) -> Array:
    q = np.random.default_rng(seed).uniform(-np.pi, np.pi, (4 * count, 6))
    return q[np.linalg.svd(jacobian(chain, q), compute_uv=False)[:, -1] > 2e-3][:count]


@pytest.mark.parametrize("couple", [CHAINED, MULTIPLES], ids=["chained", "multiples"])
def test_every_row_is_right_and_every_configuration_found(couple: dict[str, str]) -> None:
    plan, chain = arm_of(*couple.items())
    assert plan.share > 1 and plan.routine.shared
    q = regular(chain, 8, seed=5)
    poses = forward(chain, q)
    found = solved(plan, poses)
    for rows, pose, row in zip(found, poses, q, strict=True):
        assert np.abs(forward(chain, rows) - pose).max() < 1e-9
        assert apart(rows, row).min() < 1e-5
        assert len(rows) % 2 == 0 and len(rows) <= plan.most
    for k, (rows, pose) in enumerate(zip(found[:2], poses, strict=False)):
        for other in searched(plan.frames, plan.motions, TURNS, plan.length, pose, seed=k):
            assert apart(rows, other).min() < 1e-4


def test_all_equations_have_multiple_roots_where_sums_have_simple_ones() -> None:
    plan, chain = arm_of(*CHAINED.items())
    q = regular(chain, 12, seed=3)
    poses, frames = forward(chain, q), [*plan.frames[:, None]]
    nodes = q[:, plan.coupled, None] + np.array([5e-3, 1e-2])

    def order(size: int) -> float:
        args = (size, plan.motions, frames, poses, plan.eliminations[0])
        near, far = np.log2(np.abs(shared_determinants(*args, nodes))).T
        return float(np.median(far - near))

    assert order(13 - plan.share) == pytest.approx(1.0, abs=0.2)
    assert order(12) == pytest.approx(plan.share, abs=0.8)


def test_the_degree_is_that_of_the_sums() -> None:
    plan, chain = arm_of(*CHAINED.items())
    poses = forward(chain, regular(chain, 4, seed=2))
    args = (plan.motions, [*plan.frames[:, None]], poses, plan.eliminations[0], ROUND)
    spectrum = np.abs(np.fft.fft(shared_determinants(13 - plan.share, *args), axis=1))
    largest = spectrum.max(axis=1)
    assert (spectrum[:, plan.degree + 1 : 96 - plan.degree].max(axis=1) < 1e-11 * largest).all()
    assert (spectrum[:, plan.degree] > 1e-12 * largest).any()


@pytest.mark.long
@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER)
@pytest.mark.parametrize("couple", [CHAINED, MULTIPLES], ids=["chained", "multiples"])
def test_it_is_verified_in_both_languages(couple: dict[str, str], tmp_path: Path) -> None:
    request = Request(followers_and_wrist(tmp_path), couple=couple)
    made = generate(request, Outputs(("python", "cpp"), tmp_path / "out", samples=12))
    assert sorted(made.reports) == ["cpp", "python"]
    assert all(report.passed for report in made.reports.values())


def general_chain(folder: Path) -> Path:
    rng = np.random.default_rng(4)
    alpha, a, d = rng.uniform(-1.5, 1.5, 8), rng.uniform(0.1, 0.6, 8), rng.uniform(0.1, 0.6, 8)
    alpha[0] = a[0] = 0.0
    return coupled_table(folder, alpha.tolist(), a.tolist(), d.tolist())


def test_a_degree_that_is_too_high_is_said(tmp_path: Path) -> None:
    request = Request(general_chain(tmp_path), couple={"q4": "q3*4", "q5": "q3*5"})
    refusal = coupled_refusal(read(request).dh)
    assert refusal is not None
    assert re.search(r"'q3' turns 3 axes.* of degree \d\d\d?, and beyond 60", refusal[0])
    assert refusal[1] == "q3"


def test_two_joints_that_turn_several_axes_are_named(tmp_path: Path) -> None:
    request = Request(general_chain(tmp_path), couple={"q3": "q2*1", "q6": "q5*1"})
    refusal = coupled_refusal(read(request).dh)
    assert refusal is not None
    assert "'q2' and 'q5' turn several axes each" in refusal[0] and refusal[1] == "q2"


def test_what_is_solved_is_not_refused() -> None:
    with tempfile.TemporaryDirectory() as name:
        dh = read(Request(followers_and_wrist(Path(name)), couple=CHAINED)).dh
    assert coupled_refusal(dh) is None
