"""The emitted C++ header against the interpreter of its Program: same rows in the same order."""

from __future__ import annotations

import dataclasses
import functools
import importlib.util
import math
import sys
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.cpp_modules import EXACT, ROBOTS, solver_module
from tests.support.sampled import sampled
from tests.support.solving import NO_COMPILER

from ikgen.emit.cpp.cpp_emitter import emit, emit_header
from ikgen.emit.python.python_emitter import emit_module
from ikgen.emit.solver_module import SolverModule
from ikgen.generation.emitted_runners import arm_constants
from ikgen.kinematics.forward import file_forward, file_jacobian
from ikgen.program.interpret import run
from ikgen.verify.runners.cpp_header import CppHeader
from ikgen.verify.runners.runner import ArmConstants

Array = NDArray[np.float64]

pytestmark = [
    pytest.mark.usefixtures("solved_once"),
    pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER),
]

SAMPLES = 60
RARE = ("Olson13", "Puma", "Raven-II", "Stanford", "UR5")
"""Compiled with the long tests alone: the others have what they have."""


@dataclass(frozen=True)
class Arm:
    """One compiled header and what it was made from."""

    module: SolverModule
    header: CppHeader
    q: Array
    """Configurations (N, dof), some of them singular."""
    poses: Array


def often(names: list[str]) -> list[Any]:
    """Robots as parameters of a test."""
    return sampled(names, [name for name in names if name not in RARE])


@functools.cache
def module_of(name: str) -> SolverModule:
    return solver_module(name)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("cpp")


@functools.cache
def compiled(name: str, folder: Path) -> Arm:
    module = module_of(name)
    for file, text in emit(module).items():
        (folder / file).write_text(text)
    dh = module.dh
    constants = ArmConstants(
        joint_names=tuple(j.name for j in dh.joints),
        lower=np.array([j.limits.lower for j in dh.joints]),
        upper=np.array([j.limits.upper for j in dh.joints]),
        base_link=dh.base_link,
        tip_link=dh.tip_link,
        task=module.task,
        free_joints=tuple(dh.joints[j].name for j in module.free_indices),
        max_solutions=module.max_solutions,
    )
    header = CppHeader(folder / f"{module.name}_ik.hpp", constants)
    q = configurations(module)
    return Arm(module, header, q, file_forward(dh, q))


def configurations(module: SolverModule) -> Array:
    """Random ones inside the limits, then some with joints at multiples of a right angle."""
    random = np.random.default_rng(1)
    joints = module.dh.joints
    low = np.array([max(j.limits.lower, -3.0 if j.kind == "revolute" else 0.1) for j in joints])
    high = np.array([min(j.limits.upper, 3.0 if j.kind == "revolute" else 0.9) for j in joints])
    q = random.uniform(low, high, (SAMPLES, len(joints)))
    for row in q[SAMPLES // 2 :]:
        for j in random.permutation(len(joints))[:2]:
            if joints[j].kind == "revolute":
                row[j] = np.clip(random.integers(-1, 2) * math.pi / 2, low[j], high[j])
    return np.asarray(q)


def interpreted(module: SolverModule, pose: Array) -> tuple[Array, NDArray[np.bool_], bool]:
    """Joint values of the interpreter's rows, repeated ones left out, and their flags."""
    inputs = {f"t{i}{j}": float(pose[i, j]) for i in range(3) for j in range(4)}
    inputs |= {f"seed_q{j + 1}": 0.0 for j in range(module.dh.dof)}
    out: list[Array] = []
    flags = []
    for answer in run(module.program, inputs):
        q = np.array(answer.q)
        if not any(gap(module, q, other).max() < 1e-6 for other in out):
            out.append(q)
            flags.append(answer.singular)
    return np.array(out).reshape(-1, module.dh.dof), np.array(flags, dtype=bool), bool(out)


def gap(module: SolverModule, a: Array, b: Array) -> Array:
    """Absolute differences of joint values, whole turns aside."""
    turns = np.array([module.dh.lead_row(j).revolute for j in range(module.dh.dof)])
    wrapped = np.abs((a - b + math.pi) % (2 * math.pi) - math.pi)
    return np.where(turns, wrapped, np.abs(a - b))


@pytest.mark.parametrize("name", sampled(EXACT, ["ur5e"]))
def test_rows_are_the_interpreters(name: str, folder: Path) -> None:
    arm = compiled(name, folder)
    found = arm.header.solve_many(arm.poses, limits=False)
    compared = 0
    for i, pose in enumerate(arm.poses):
        rows, flags, any_row = interpreted(arm.module, pose)
        mine = found.q[i, : found.count[i]]
        if not any_row or flags.any() or found.singular[i].any():
            continue  # such rows take Newton steps, and other free values are tried
        assert len(mine) == len(rows), (i, mine, rows)
        tolerance = 1e-7 if arm.module.rounded else 1e-9
        assert gap(arm.module, mine, rows).max() < tolerance, (i, mine, rows)
        compared += 1
    assert compared > SAMPLES // 3


def python_module(arm: Arm, folder: Path) -> ModuleType:
    """The emitted Python module of the same arm, imported."""
    name = f"{arm.module.name}_ik"
    path = folder / f"{name}.py"
    path.write_text(emit_module(arm.module))
    spec = importlib.util.spec_from_file_location(name, path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


@pytest.mark.parametrize("seeded", [False, True])
@pytest.mark.parametrize("name", often(ROBOTS))
def test_rows_are_the_python_modules(name: str, seeded: bool, folder: Path) -> None:
    arm = compiled(name, folder)
    python = python_module(arm, folder)
    found = arm.header.solve_many(arm.poses, seeds=arm.q if seeded else None, limits=False)
    for i, pose in enumerate(arm.poses):
        other = python.solve(pose, seed=arm.q[i] if seeded else None, limits=False)
        mine = found.q[i, : found.count[i]]
        assert found.status[i] == other.status.value
        if other.singular.any() and arm.module.rounded:
            continue  # how far a row slides along a continuum hangs on the last digits
        assert len(mine) == len(other.q), (i, mine, other.q)
        apart = np.array([[gap(arm.module, a, b).max() for b in other.q] for a in mine])
        limit = 1e-6 if other.singular.any() else 1e-9
        assert max(apart.min(axis=0).max(), apart.min(axis=1).max()) < limit, (i, mine, other.q)
        if not (other.singular.any() or seeded or arm.module.rounded):
            assert np.diag(apart).max() < limit, (i, mine, other.q)


def at_limits(module: SolverModule) -> Array:
    """Configurations (N, dof) with one or more joints at a limit, or 1e-13 to 1e-9 beside it."""
    random = np.random.default_rng(2)
    joints = module.dh.joints
    low = np.array([max(j.limits.lower, -3.0) for j in joints])
    high = np.array([min(j.limits.upper, 3.0) for j in joints])
    q = random.uniform(low, high, (80, len(joints)))
    for i, row in enumerate(q):
        for j in random.permutation(len(joints))[: 1 + i % 3]:
            beside = random.choice([0.0, 1e-13, 8e-10]) * random.choice([-1.0, 1.0])
            row[j] = random.choice([low[j], high[j]]) + beside
    return np.asarray(q)


LIMITED = ("kuka_kr6r900sixx", "scara_standard", "doosan_m1013")


@pytest.mark.parametrize("seeded", [False, True])
@pytest.mark.parametrize("name", LIMITED)
def test_rows_at_limits_are_the_python_modules(name: str, seeded: bool, folder: Path) -> None:
    arm = compiled(name, folder)
    python = python_module(arm, folder)
    q = at_limits(arm.module)
    poses = file_forward(arm.module.dh, q)
    found = arm.header.solve_many(poses, seeds=q if seeded else None)
    batch, count, _ = python.solve_batch(poses, seed=q if seeded else None)
    compared = touching = 0
    for i, pose in enumerate(poses):
        if np.linalg.svd(python.jacobian(q[i]), compute_uv=False)[-1] < 0.05:
            continue
        other = python.solve(pose, seed=q[i] if seeded else None)
        mine = found.q[i, : found.count[i]]
        assert found.count[i] == count[i] == len(other)
        assert (other.q >= python.LOWER).all() and (other.q <= python.UPPER).all()
        for rows in (mine, batch[i, : count[i]]):
            # half a turn from the seed, the last digit decides to which side
            apart = gap(arm.module, rows, other.q) if seeded else np.abs(rows - other.q)
            assert apart.max(initial=0.0) < 1e-12, (i, rows, other.q)
        compared += 1
        touching += int((other.q == python.LOWER).sum() + (other.q == python.UPPER).sum())
    assert compared > 20 and touching > 10


@pytest.mark.parametrize("name", often(ROBOTS))
def test_a_batch_has_the_rows_of_single_poses(name: str, folder: Path) -> None:
    arm = compiled(name, folder)
    poses = np.concatenate([arm.poses, arm.poses[:1] * np.nan])
    for limits in (False, True):
        single = arm.header.solve_many(poses, limits=limits)
        batch = arm.header.solve_batch(poses, limits=limits)
        assert batch is not None and batch.status == single.status
        assert (batch.count == single.count).all() and (batch.singular == single.singular).all()
        assert np.array_equal(batch.q, single.q, equal_nan=True)


@pytest.mark.parametrize("name", often(ROBOTS))
def test_a_seed_turns_and_orders_the_rows_that_are_there_without(name: str, folder: Path) -> None:
    arm = compiled(name, folder)
    plain = arm.header.solve_many(arm.poses, limits=False)
    random = np.random.default_rng(5)
    seeds = random.uniform(-30.0, 30.0, arm.q.shape)
    seeds[:, list(arm.module.free_indices)] = [arm.module.free_defaults] * len(seeds)
    found = arm.header.solve_many(arm.poses, seeds=seeds, limits=False)
    held = arm.module.free_indices
    period = [0.0 if j in held else arm.module.period(j) for j in range(arm.module.dh.dof)]
    for i, seed in enumerate(seeds):
        if plain.singular[i].any() or found.singular[i].any():
            continue  # their free values are the seed's
        rows, mine = plain.q[i, : plain.count[i]], found.q[i, : found.count[i]]
        assert len(mine) == len(rows)
        rows = rows + period * np.rint((seed - rows) / (2 * math.pi))
        order = np.argsort(np.linalg.norm(rows - seed, axis=1), kind="stable")
        assert np.abs(mine - rows[order]).max(initial=0.0) < 1e-9


def test_odd_seeds(folder: Path) -> None:
    arm = compiled("kuka_kr6r900sixx", folder)
    python = python_module(arm, folder)
    poses, plain = arm.poses[:10], arm.header.solve_many(arm.poses[:10])
    for far in (1e6, -1e16):
        seed = np.full((10, 6), far)
        found = arm.header.solve_many(poses, seeds=seed)
        assert (found.count == plain.count).all() and found.count.max() > 1
        for i, pose in enumerate(poses):
            other = python.solve(pose, seed=seed[i])
            if not other.singular.any():
                assert np.abs(found.q[i, : found.count[i]] - other.q).max() < 1e-9
    nothing = arm.header.solve_many(poses, seeds=seed * np.nan)
    assert np.array_equal(nothing.q, plain.q, equal_nan=True)


def test_odd_names_are_escaped(folder: Path) -> None:
    module = module_of(ROBOTS[0])
    odd = 'tool "0" \\ \n é ??/'
    dh = dataclasses.replace(module.dh, tip_link=odd, robot=odd)
    text = emit_header(dataclasses.replace(module, dh=dh, source_name=odd, name="odd"))
    (folder / "odd_ik.hpp").write_text(text)
    header = CppHeader(folder / "odd_ik.hpp", arm_constants(module))
    assert header.constants.tip_link == odd
    assert r'"tool \0420\042 \134 \012 \303\251 \077\077/"' in text


@pytest.mark.parametrize("name", often(ROBOTS))
def test_rows_reach_the_pose_and_include_the_one_it_was_made_from(name: str, folder: Path) -> None:
    arm = compiled(name, folder)
    for limits in (False, True):
        found = arm.header.solve_many(arm.poses, limits=limits, seeds=arm.q)
        for i, pose in enumerate(arm.poses):
            assert found.status[i] == "OK", (i, arm.q[i])
            rows = found.q[i, : found.count[i]]
            error = np.abs(file_forward(arm.module.dh, rows) - pose).max()
            assert error < 2e-9, (i, error)
            rounded = max(arm.module.dh.deviation) > 1e-12
            if not (rounded and found.singular[i, 0]):
                near = 1e-4 if rounded else 2e-6  # where two rows meet: sqrt of the slack
                assert gap(arm.module, rows[0], arm.q[i]).max() < near, (i, rows[0], arm.q[i])
            distance = np.linalg.norm(rows - arm.q[i], axis=1)
            assert (np.diff(distance) > -1e-9).all()
            if limits:
                assert (rows >= arm.header.constants.lower).all()
                assert (rows <= arm.header.constants.upper).all()


@pytest.mark.parametrize("name", often(ROBOTS))
def test_kinematics_are_the_files(name: str, folder: Path) -> None:
    arm = compiled(name, folder)
    assert np.abs(arm.header.forward(arm.q) - arm.poses).max() < 1e-12
    assert np.abs(arm.header.jacobian(arm.q) - file_jacobian(arm.module.dh, arm.q)).max() < 1e-12


@pytest.mark.parametrize("name", ["kuka_kr6r900sixx", "ur5e"])
def test_what_is_no_pose_is_invalid(name: str, folder: Path) -> None:
    arm = compiled(name, folder)
    pose = arm.poses[0]
    bad = np.stack([pose] * 5)
    bad[0, 0, 3] = np.nan
    bad[1, :3, :3] *= 1.5
    bad[2, :3, 0] *= -1.0
    bad[3, :3, 3] = np.inf
    bad[4, 3, 0] = 1e-3
    assert set(arm.header.solve_many(bad).status) == {"INVALID"}
    far = pose.copy()
    far[:3, 3] = 50.0
    q, status, _ = arm.header.solve(far)
    assert status == "UNREACHABLE" and len(q) == 0


def test_header_is_reproducible_and_has_no_paths() -> None:
    module = module_of(ROBOTS[0])
    text = emit_header(module)
    assert text == emit_header(module)
    assert str(Path(__file__).parents[2]) not in text
    assert max(map(len, text.splitlines())) <= 160
