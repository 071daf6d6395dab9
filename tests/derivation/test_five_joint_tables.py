"""Tables of five joints that rules leave open: a turn about the tool's axis is the sixth joint."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from benchmarks.drawn import revolute, smallest_singular
from benchmarks.solution_search import apart
from tests.derivation.test_slide_tables import table
from tests.support.solving import NO_COMPILER, import_text

from ikgen.derivation.derive import derive
from ikgen.derivation.read import read
from ikgen.elimination.loop_frames import forward, held_frames
from ikgen.emit.cpp.cpp_emitter import emit_header
from ikgen.emit.python.python_emitter import emit_module
from ikgen.emit.solver_module import SolverModule
from ikgen.records.request import Request
from ikgen.runtime.python.elimination.six_joints import with_tool_joint
from ikgen.tasks import AXES, find_task
from ikgen.verify.runners.cpp_header import CppHeader
from ikgen.verify.runners.cpp_toolchain import find_eigen
from ikgen.verify.runners.python_module import PythonModule
from ikgen.verify.task_space import task_space

KINDS = {"RRRRR": "6R", "RRPRR": "5R1P", "PRRPR": "4R2P"}
"""Kinds of joints -> what their elimination is called."""


def solved(kinds: str, folder: Path) -> SolverModule:
    return derive(Request(robot=table(kinds, folder))).module


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_the_joint_turns_about_the_tools_axis(axis: int, tmp_path: Path) -> None:
    frames = held_frames(read(Request(robot=table("RRRRR", tmp_path))).dh)
    q, angle = np.array([0.3, -1.2, 0.8, 2.0, -0.4]), 0.7
    T = forward(with_tool_joint(frames, axis), np.append(q, angle))
    tip = forward(frames, q)
    assert np.allclose(T[:, [axis, 3]], tip[:, [axis, 3]], atol=1e-15)
    turned = tip[:3, :3].T @ T[:3, :3]
    assert np.trace(turned) == pytest.approx(1.0 + 2.0 * np.cos(angle))
    second, third = (axis + 1) % 3, (axis + 2) % 3
    assert turned[third, second] == pytest.approx(np.sin(angle))


@pytest.mark.parametrize("kinds", KINDS)
def test_every_solution_is_found_and_right(kinds: str, tmp_path: Path) -> None:
    module = solved(kinds, tmp_path)
    assert module.reads.stem == "position-direction"
    assert module.order == (f"all joints ({KINDS[kinds]} elimination)",)
    arm = import_text(emit_module(module), tmp_path)
    q = np.random.default_rng(1).uniform(-2.0, 2.0, (40, 5))
    q = q[smallest_singular(arm, q) > 1e-2]
    # the task does not read a turn about the tool's axis
    poses = arm.forward(q) @ turns(AXES.index(module.reads.axis), len(q))
    space = task_space(find_task(module.task))
    rows, count, status = arm.solve_batch(poses, limits=False)
    assert len(q) > 10 and set(status.tolist()) == {"OK"}
    for at, pose, found, n in zip(q, poses, rows, count, strict=True):
        assert apart(at, found[:n], revolute(arm)).min() < 1e-7
        back = arm.forward(found[:n])
        assert np.abs(space.residual(back, np.broadcast_to(pose, back.shape))).max() < 1e-9
        answer = arm.solve(pose, limits=False)
        assert len(answer) == n and {"det J > 0", "det J < 0"} >= set(answer.branch)


def turns(axis: int, count: int) -> np.ndarray:
    """Random turns (count, 4, 4) about x (0), y or z."""
    angle = np.random.default_rng(2).uniform(-3.0, 3.0, count)
    T = np.tile(np.eye(4), (count, 1, 1))
    i, j = (axis + 1) % 3, (axis + 2) % 3
    T[:, i, i] = T[:, j, j] = np.cos(angle)
    T[:, j, i], T[:, i, j] = np.sin(angle), -np.sin(angle)
    return T


@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER)
@pytest.mark.long
@pytest.mark.parametrize("kinds", ["RRRRR", "RRPRR"])
def test_the_header_has_the_same_rows(kinds: str, tmp_path: Path) -> None:
    module = solved(kinds, tmp_path)
    for suffix, text in (("py", emit_module(module)), ("hpp", emit_header(module))):
        (tmp_path / f"{module.name}_ik.{suffix}").write_text(text)
    python = PythonModule(tmp_path / f"{module.name}_ik.py")
    header = CppHeader(tmp_path / f"{module.name}_ik.hpp", python.constants)
    arm = import_text(emit_module(module), tmp_path)
    q = np.random.default_rng(3).uniform(-2.0, 2.0, (60, 5))
    poses = arm.forward(q[smallest_singular(arm, q) > 1e-2])
    one, other = (runner.solve_many(poses, limits=False) for runner in (python, header))
    assert len(poses) > 20 and (one.count == other.count).all()
    for a, b, n in zip(one.q, other.q, one.count, strict=True):
        for row in a[:n]:
            assert apart(row, b[:n], revolute(arm)).min() < 1e-9


@pytest.mark.skipif(shutil.which("clang++") is None or bool(NO_COMPILER), reason="needs clang++")
def test_the_header_has_no_warning(tmp_path: Path) -> None:
    module = solved("RRRRR", tmp_path)
    (tmp_path / "arm_ik.hpp").write_text(emit_header(module))
    call = f"{module.name}_ik::solve(Eigen::Isometry3d::Identity()).count"
    (tmp_path / "main.cpp").write_text(f'#include "arm_ik.hpp"\nint main() {{ return {call}; }}\n')
    flags = ["-std=c++17", "-Wall", "-Wextra", "-Wshadow", "-Wconversion", "-Wunused", "-Werror"]
    command = ["clang++", *flags, "-isystem", str(find_eigen()), "-fsyntax-only", "main.cpp"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[:3000]
