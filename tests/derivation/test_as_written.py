"""Closed forms of the file's own chain in place of those of its exact geometry."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from tests.support.rounded_arms import EXACT, IN_TEN_DIGITS, spherical_wrist, three_parallel
from tests.support.solving import emitted, import_text, module_of, solver_module

from ikgen.derivation.as_written import solve_as_written
from ikgen.derivation.derive import derive
from ikgen.emit.python.python_emitter import emit_module
from ikgen.emit.solver_module import CLOSE
from ikgen.kinematics.kept import kept_constants
from ikgen.kinematics.modified_dh import to_dh
from ikgen.model.chain import Chain
from ikgen.model.dh import DHChain
from ikgen.records.request import Request
from ikgen.solver import solve
from ikgen.solver.solution_graph import SolutionGraph

pytestmark = pytest.mark.usefixtures("solved_once")

HALF = Fraction(1, 2)


def attempt(dh: DHChain, among: Collection[str] | None) -> SolutionGraph:
    return solve.solve_chain(dh, among=among)


def written(chain: Chain) -> tuple[DHChain, SolutionGraph, SolutionGraph]:
    """The rows chosen, their solution, and that of the exact geometry."""
    dh = to_dh(chain)
    graph = solve.solve_chain(dh)
    chosen, other = solve_as_written(dh, graph, attempt)
    return chosen, other, graph


def described(folder: Path, joints: Sequence[tuple[str, ...]]) -> Path:
    """A URDF of joints: name, type, origin's xyz and rpy, axis."""
    text = '<robot name="short"><link name="link0"/>'
    for i, (name, kind, xyz, rpy, axis) in enumerate(joints):
        text += f"""<link name="link{i + 1}"/><joint name="{name}" type="{kind}">
          <parent link="link{i}"/><child link="link{i + 1}"/><origin xyz="{xyz}" rpy="{rpy}"/>
          <axis xyz="{axis}"/><limit lower="0" upper="0.5"/></joint>"""
    path = folder / "short.urdf"
    path.write_text(f"{text}</robot>")
    return path


def branches(graph: SolutionGraph) -> int:
    return math.prod(step.branches for step in graph.steps)


@pytest.mark.parametrize(
    "chain",
    [
        three_parallel(),
        three_parallel(IN_TEN_DIGITS),
        pytest.param(spherical_wrist(1.571), marks=pytest.mark.long),
    ],
)
def test_files_own_chain_has_a_closed_form(chain: Chain, tmp_path: Path) -> None:
    dh, graph, exact = written(chain)
    assert max(dh.deviation) < 1e-14
    assert branches(graph) == branches(exact) == 8
    assert not solver_module(dh).rounded
    module = emitted(dh, tmp_path)
    for q in np.random.default_rng(5).uniform(-3, 3, (60, 6)):
        T = module.forward(q)
        rows = np.array(list(module.solve(T, limits=False)))
        assert max(np.abs(module.forward(row) - T).max() for row in rows) < 1e-12
        assert np.abs(np.remainder(rows - q + np.pi, 2 * np.pi) - np.pi).max(axis=1).min() < 1e-8


def test_rows_next_to_a_stretched_elbow_are_the_files(tmp_path: Path) -> None:
    """A fold moves by the root of what the rows are off: 2e-10 would hide these."""
    module = emitted(written(three_parallel(IN_TEN_DIGITS))[0], tmp_path)
    for elbow in 10.0 ** -np.arange(1.0, 7.0):
        q = np.array([-0.85, -2.27, elbow, 2.91, 1.05, -3.1])
        rows = np.array(list(module.solve(module.forward(q), limits=False)))
        off = np.abs(np.remainder(rows - q + np.pi, 2 * np.pi) - np.pi).max(axis=1).min()
        assert off < 1e-13 / elbow + 1e-8


def test_branches_lie_half_a_turn_apart_but_for_rounding() -> None:
    _, graph, _ = written(three_parallel())
    wrist = next(
        step.candidate for step in graph.steps if step.candidate.unknown.text == "theta_234"
    )
    assert wrist.judgement is not None and wrist.judgement.almost_tangent


def test_exact_geometry_is_solved_once() -> None:
    dh = to_dh(three_parallel(EXACT))
    graph = solve.solve_chain(dh)
    assert solve_as_written(dh, graph, lambda *_: pytest.fail("solved again")) == (dh, graph)


def test_equations_of_the_exact_solution_are_looked_at_first() -> None:
    dh = to_dh(three_parallel())
    graph = solve.solve_chain(dh)
    tried: list[Collection[str] | None] = []

    def first_fails(dh: DHChain, among: Collection[str] | None) -> SolutionGraph:
        tried.append(among)
        found = attempt(dh, among)
        return replace(found, open_joints=(5,)) if among is not None else found

    _, whole = solve_as_written(dh, graph, first_fails)
    few, none = tried
    assert few is not None and none is None
    assert {e.label for s in graph.steps for e in s.candidate.sources} <= set(few)
    assert 4 * len(few) < len({e.label for e in graph.workspace().equations.equations})
    assert solve_as_written(dh, graph, attempt)[1].order == whole.order


def test_length_that_two_branches_need_is_made_exact() -> None:
    dh, graph, exact = written(three_parallel(1.571, skew=4e-6))
    assert dh.rows[5].a.name is None
    assert dh.rows[1].alpha.near is not None
    assert CLOSE < max(dh.deviation) < 0.5 * max(to_dh(three_parallel(1.571, skew=4e-6)).deviation)
    assert branches(graph) == branches(exact) == 8


def test_rows_nearer_by_less_than_a_micrometre_are_not_looked_for() -> None:
    """What they keep of the file breaks singularities apart at the scale of what they are still off."""
    near = to_dh(three_parallel(math.pi / 2 + 3e-7, skew=4e-8))
    assert CLOSE < max(near.deviation) < 1e-6

    def exact_alone(dh: DHChain, among: Collection[str] | None) -> SolutionGraph:
        assert max(dh.deviation) <= CLOSE
        return solve.solve_chain(dh, among=among)

    graph = solve.solve_chain(near)
    assert solve_as_written(near, graph, exact_alone) == (near, graph)


@pytest.mark.parametrize("wrist", [0.0, math.pi])
def test_stretched_arm_with_singular_wrist_is_reached(wrist: float, tmp_path: Path) -> None:
    dh, _, _ = written(three_parallel())
    module = emitted(dh, tmp_path)
    for q1, q2, q4 in np.random.default_rng(7).integers(-4, 4, (12, 3)) * np.pi / 4:
        T = module.forward([q1, q2, 0.0, q4, wrist, 0.5])
        rows = list(module.solve(T, limits=False))
        assert rows
        assert max(np.abs(module.forward(row) - T).max() for row in rows) < 1e-9


def test_what_the_tool_is_off_is_no_axis(tmp_path: Path) -> None:
    """The file's rounding of a fixed link behind the last joint stays there: the rows are exact."""
    joints = (
        ("pan", "continuous", "0 0 0.6", "0 0 0", "0 0 1"),
        ("tilt", "continuous", "0.05 0.03 0.1", "0 0 0", "0 1 0"),
        ("telescope", "prismatic", "0.1 0 0.04", "0 0 0", "1 0 0"),
        ("lens_fix", "fixed", "0.05 0 0", "-1.5708 0 -1.5708", "1 0 0"),
    )
    path = described(tmp_path, joints)
    dh = derive(Request(path)).reading.dh
    assert dh.deviation == (0.0, 0.0) and not dh.snaps and not kept_constants(dh)
    assert [row.d.name for row in dh.rows] == 3 * [None] and dh.rows[2].offset.value == 0.0


def test_twists_that_must_be_exact_leave_lengths_and_offsets_the_files(tmp_path: Path) -> None:
    """3.14 is an offset of the first joint, 0.1 mm a length: only 1.5708 has to become a right angle."""
    joints = (
        ("yaw", "revolute", "0.07 0 0.1", "1.5707963267949 0 1.5707963267949", "0 0 1"),
        ("pitch", "revolute", "0.0001 0 0.2", "3.14 -1.5707963267949 0", "0 0 1"),
        ("insert", "prismatic", "0 0 0", "-1.5708 0 0", "0 0 1"),
        ("roll", "revolute", "0 0 0.05", "0 0 0", "0 0 -1"),
    )
    derivation = derive(Request(described(tmp_path, joints)))
    dh = derivation.reading.dh
    assert derivation.task.name == "position-pitch:x"
    assert CLOSE < max(dh.deviation) < 5e-6 < 1e-3 < max(to_dh(derivation.reading.chain).deviation)
    assert [row.alpha.exact for row in dh.rows] == [0, HALF, HALF, 0]
    assert abs(dh.rows[1].d.value) == pytest.approx(1e-4, rel=0.02)
    solved = module_of(dh, derivation.graph)
    module = import_text(emit_module(replace(solved, task=derivation.task.name)), tmp_path)
    off = []
    for q in np.random.default_rng(3).uniform(-1.4, 1.4, (40, 4)):
        T = module.forward(q)
        rows = np.array(list(module.solve(T, limits=False)))
        poses = np.array([module.forward(row) for row in rows])
        assert np.abs(poses[:, :3, 3] - T[:3, 3]).max() < 1e-9
        assert np.abs(poses[:, 2, 0] - T[2, 0]).max() < 1e-9
        off.append(np.abs(np.remainder(rows - q + np.pi, 2 * np.pi) - np.pi).max(axis=1).min())
    assert max(off) < 1e-6
