"""The robots of the IKBT paper and its repository, from their DH tables to the emitted module."""

from __future__ import annotations

import math
import sys
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from tests.support.solving import NO_COMPILER

from ikgen.derivation.derive import derive
from ikgen.derivation.read import read
from ikgen.emit.python.python_emitter import emit_module
from ikgen.equations.probes import arm_size
from ikgen.generation.emitted_checks import oracle_for
from ikgen.generation.generate import generate
from ikgen.records.request import Outputs, Request
from ikgen.verify.runners.python_module import PythonModule

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib

pytestmark = pytest.mark.usefixtures("solved_once")

HERE = Path(__file__).resolve().parent
FIXTURES = HERE.parents[1] / "urdf_fixtures"
EXPECTED = tomllib.loads((HERE / "expected.toml").read_text(encoding="utf-8"))
BY_RULES = [n for n, x in EXPECTED.items() if not (x["redundant"] or x.get("elimination"))]
SOLVED = [*BY_RULES, *(name for name, facts in EXPECTED.items() if facts.get("elimination"))]
REDUNDANT = [name for name, facts in EXPECTED.items() if facts["redundant"]]
POSES = 40

PAPER_Q = (30.0, 50.0, 40.0, 45.0, 120.0, 60.0)
PAPER_T = (
    (-0.15720, 0.97938, 0.12682, -1.68074),
    (-0.59374, -0.19635, 0.78032, 1.33902),
    (0.78914, 0.04737, 0.61237, -4.83022),
)
PAPER_SOLUTIONS = (
    (-287.08771, 130.00008, -191.92745, -6.78054, -66.24462, 4.13687),
    (29.99995, 49.99992, 39.99994, -135.00007, -119.99981, -120.00010),
    (29.99995, 148.48625, -191.92745, 142.01103, 95.78709, -151.06756),
    (-287.08771, 31.51375, 39.99994, 18.00641, 159.53838, 18.33206),
    (-287.08771, 130.00008, -191.92745, 173.21946, 66.24462, -175.86313),
    (29.99995, 148.48625, -191.92745, -37.98897, -95.78709, 28.93244),
    (29.99995, 49.99992, 39.99994, 44.99993, 119.99981, 59.99990),
    (-287.08771, 31.51375, 39.99994, -161.99359, -159.53838, -161.66794),
)
"""Table "Puma 560 Numerical Solutions" of the paper, in degrees."""


def module_of(table: Path, folder: Path, task: str | None = "pose") -> ModuleType:
    """The emitted Python module of a table, imported; for no task in particular it is the arm's own."""
    derivation = derive(Request(table, task=task))
    file = folder / f"{derivation.module.name}_ik.py"
    file.write_text(emit_module(derivation.module), encoding="utf-8")
    return PythonModule(file).module


@pytest.fixture
def puma(tmp_path: Path) -> ModuleType:
    return module_of(FIXTURES / "puma560_paper.toml", tmp_path)


def test_every_table_has_its_facts() -> None:
    assert sorted(EXPECTED) == sorted(p.stem for p in (HERE / "tables").glob("*.toml"))
    assert sum(facts["paper"] for facts in EXPECTED.values()) >= 19


@pytest.mark.parametrize("name", BY_RULES, scope="module")  # both tests of a table are neighbours
def test_claims_as_many_solutions_as_some_pose_has(name: str, tmp_path: Path) -> None:
    table = HERE / "tables" / f"{name}.toml"
    module = module_of(table, tmp_path, None)
    rng, dh = np.random.default_rng(5), read(Request(table)).dh
    revolute = np.array([j.kind == "revolute" for j in dh.joints])
    q = rng.uniform(-np.pi, np.pi, (1000, module.DOF)) * np.where(revolute, 1.0, arm_size(dh))
    special = np.where(revolute, rng.integers(-1, 3, q.shape) * (np.pi / 2), 0.0)
    q[500:] = np.where(rng.random(q.shape) < rng.random((1000, 1)), special, q)[500:]
    most, found = module.MAX_SOLUTIONS, 0
    for some in (q[at::10] for at in range(10)):  # there is no room for more than the most
        found = max(found, module.solve_batch(module.forward(some), limits=False)[1].max())
        if found == most:
            break
    assert most // 2 <= found < most if EXPECTED[name].get("bound") else found == most


def test_no_branch_is_claimed_that_another_joint_tells() -> None:
    """Of the first angle's two the third angle always rules one out, which the rules alone do not see."""
    table = HERE / "tables" / "ICP5p5_A21.toml"
    assert derive(Request(table, task="pose")).module.max_solutions == 1


@pytest.mark.parametrize("name", SOLVED, scope="module")
def test_robot_is_solved(name: str, tmp_path: Path) -> None:
    table = HERE / "tables" / f"{name}.toml"
    module = module_of(table, tmp_path)
    oracle = oracle_for(read(Request(table)))
    q = np.random.default_rng(7).uniform(-2.5, 2.5, (POSES, module.DOF))
    poses = oracle.forward(q)
    rows, count, _ = module.solve_batch(poses, limits=False)
    size = max(1.0, float(np.abs(poses[:, :3, 3]).max()))
    revolute = np.array([j.kind == "revolute" for j in read(Request(table)).dh.joints])
    for i in range(POSES):
        found = rows[i, : count[i]]
        assert len(found), f"no solution for {q[i]}"
        np.testing.assert_allclose(
            oracle.forward(found), np.broadcast_to(poses[i], (len(found), 4, 4)), atol=1e-9 * size
        )
        gap = np.abs(found - q[i])
        gap = np.where(revolute, np.abs((gap + math.pi) % (2 * math.pi) - math.pi), gap / size)
        assert gap.max(axis=1).min() < 1e-5, f"{q[i]} is missing"
    assert count.max() <= module.MAX_SOLUTIONS
    assert count.max() >= max(EXPECTED[name]["solutions"])


@pytest.mark.long
def test_elimination_passes_every_check_in_both_languages(tmp_path: Path) -> None:
    languages = ("python",) if NO_COMPILER else ("python", "cpp")
    made = generate(
        Request(HERE / "tables" / "KawasakiRS05L.toml"),
        Outputs(emit=languages, out=tmp_path, samples=40),
    )
    assert made.derivation.module.plan is not None
    assert set(made.reports) == set(languages)
    for report in made.reports.values():
        assert report.passed and report.solutions[2] >= 4
        assert report.check("singular flags").count > 20


@pytest.mark.parametrize("name", REDUNDANT)
def test_redundant_robot_is_pointed_out(name: str) -> None:
    request = Request(HERE / "tables" / f"{name}.toml")
    warnings = read(request).source.warnings
    assert any("turn about one line" in text and "infinitely many" in text for text in warnings)
    found = derive(request)
    assert [found.reading.dh.joints[j].name for j in found.module.free_indices] == ["theta_6"]


@pytest.mark.parametrize("name", REDUNDANT)
def test_redundant_robot_is_solved_with_a_joint_held(name: str) -> None:
    request = Request(HERE / "tables" / f"{name}.toml", free={"theta_6": 0.3})
    assert derive(request).module.max_solutions >= 2


def test_forward_kinematics_of_the_papers_example(puma: ModuleType) -> None:
    T = puma.forward(np.radians(PAPER_Q))
    np.testing.assert_allclose(T[:3], PAPER_T, rtol=0, atol=1.1e-5)  # printed cut, not rounded


def test_the_papers_table_of_solutions(puma: ModuleType) -> None:
    solutions = puma.solve(puma.forward(np.radians(PAPER_Q)), limits=False)
    assert len(solutions) == 8
    left = [np.degrees(row) for row in solutions]
    for row in PAPER_SOLUTIONS:
        gaps = [np.max(np.abs((r - row + 180) % 360 - 180)) for r in left]
        assert min(gaps) < 1.2e-3  # the paper's own error: its T differs by 3e-5 for its pose 1
        left.pop(int(np.argmin(gaps)))
