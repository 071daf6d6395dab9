"""Emitted code whose values are those of motors, for random matrices between these and the joints."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.geared_arms import SCARA, SIX, joint_values
from tests.support.sampled import PYTHON_OFTEN

from ikgen.derivation.derive import derive
from ikgen.emit import moveit
from ikgen.emit.cpp.cpp_emitter import emit_header
from ikgen.emit.derivation import Derivation
from ikgen.emit.python.python_emitter import emit_module
from ikgen.generation.emitted_arm import EmittedArm
from ikgen.generation.emitted_checks import oracle_for
from ikgen.generation.emitted_runners import cpp_runner, python_runner
from ikgen.kinematics.motor_matrix import motor_matrix
from ikgen.model.joint_relation import Relation
from ikgen.model.transmission import Transmission
from ikgen.records.request import Request
from ikgen.verify.runners.python_module import PythonModule
from ikgen.verify.verification import verify

pytestmark = pytest.mark.usefixtures("solved_once")

Array = NDArray[np.float64]
Sources = dict[str, tuple[dict[str, float], float]]

ROBOTS = {"scara": SCARA, "six": SIX}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("motors")


@cache
def derived(folder: Path, name: str) -> Derivation:
    path = folder / f"{name}.urdf"
    path.write_text(ROBOTS[name])
    return derive(Request(path))


def drawn(rng: np.random.Generator, names: tuple[str, ...]) -> Sources:
    """Relations of random joints to random motors, each to its own among them."""
    out: Sources = {}
    for joint in names:
        others = [name for name in names if name != joint and rng.random() < 0.4]
        if others or rng.random() < 0.5:
            terms = {joint: float(rng.choice([-2.0, 0.4, 1.0, 3.0]))}
            terms |= {name: float(rng.normal()) for name in others}
            out[joint] = (terms, float(rng.normal()))
    return out


def relations(sources: Sources) -> dict[str, Relation]:
    return {joint: Relation(tuple(terms.items()), c) for joint, (terms, c) in sources.items()}


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("name", ROBOTS)
def test_every_row_closes_and_the_motors_values_are_among_them(
    name: str, seed: int, folder: Path, tmp_path: Path
) -> None:
    plain = derived(folder, name)
    names = tuple(joint.name for joint in plain.reading.dh.joints)
    rng = np.random.default_rng(seed)
    sources = drawn(rng, names)
    dh = plain.module.dh
    dh = replace(dh, transmission=motor_matrix(dh, relations(sources)))
    (tmp_path / "geared_ik.py").write_text(emit_module(replace(plain.module, dh=dh)))
    (tmp_path / "plain_ik.py").write_text(emit_module(plain.module))
    geared = PythonModule(tmp_path / "geared_ik.py").module
    joints = PythonModule(tmp_path / "plain_ik.py").module
    oracle = oracle_for(plain.reading)
    motors = rng.normal(scale=2.0, size=(12, len(names)))
    poses = oracle.forward(joint_values(names, sources, motors))
    np.testing.assert_allclose(geared.forward(motors), poses, atol=1e-12)
    batch, count, status = geared.solve_batch(poses, limits=False)
    for k, (row, pose) in enumerate(zip(motors, poses, strict=True)):
        found = geared.solve(pose, limits=False)
        closed = oracle.forward(joint_values(names, sources, found.q))
        np.testing.assert_allclose(closed, np.broadcast_to(pose, closed.shape), atol=1e-9)
        assert len(found) == len(joints.solve(pose, limits=False)) == count[k]
        assert found.branch == joints.solve(pose, limits=False).branch
        np.testing.assert_allclose(batch[k, : count[k]], found.q, atol=1e-9)
        np.testing.assert_allclose(geared.solve(pose, seed=row, limits=False)[0], row, atol=1e-7)
        step = 1e-6 * np.eye(len(names))
        moved = geared.forward(row + step)[:, :3, 3] - geared.forward(row - step)[:, :3, 3]
        np.testing.assert_allclose(geared.jacobian(row)[:3], moved.T / 2e-6, atol=1e-7)
    assert set(status.tolist()) == {"OK"}


@pytest.mark.parametrize("seed", range(3))
def test_the_limits_are_of_the_joints(seed: int, folder: Path, tmp_path: Path) -> None:
    plain = derived(folder, "scara")
    names = tuple(joint.name for joint in plain.reading.dh.joints)
    rng = np.random.default_rng(seed)
    sources = drawn(rng, names)
    dh = replace(plain.module.dh, transmission=motor_matrix(plain.module.dh, relations(sources)))
    (tmp_path / "geared_ik.py").write_text(emit_module(replace(plain.module, dh=dh)))
    geared = PythonModule(tmp_path / "geared_ik.py").module
    offset = joint_values(names, sources, np.zeros(len(names)))
    matrix = joint_values(names, sources, np.eye(len(names))).T - offset[:, None]
    middle, half = 0.5 * (geared.LOWER + geared.UPPER), 0.5 * (geared.UPPER - geared.LOWER)
    inside = outside = 0
    for values in middle + 1.2 * half * rng.uniform(-1.0, 1.0, (100, len(names))):
        motors = np.linalg.solve(matrix, values - offset)
        pose = geared.forward(motors)
        found = geared.solve(pose, seed=motors)
        kept = joint_values(names, sources, found.q)
        assert ((kept >= geared.LOWER - 1e-9) & (kept <= geared.UPPER + 1e-9)).all()
        if ((values > geared.LOWER) & (values < geared.UPPER)).all():
            inside += 1
            np.testing.assert_allclose(found[0], motors, atol=1e-7)
        else:
            outside += 1
            assert not len(found) or np.abs(found.q - motors).max(axis=1).min() > 1e-9
    assert inside > 20 and outside > 20


def test_paths_and_searches_are_of_motors(folder: Path, tmp_path: Path) -> None:
    plain = derived(folder, "scara")
    sources: Sources = {
        "outer": ({"outer": 1.0, "inner": -1.0}, 0.2),
        "quill": ({"quill": 0.1}, 0.0),
    }
    dh = replace(plain.module.dh, transmission=motor_matrix(plain.module.dh, relations(sources)))
    (tmp_path / "geared_ik.py").write_text(emit_module(replace(plain.module, dh=dh)))
    geared = PythonModule(tmp_path / "geared_ik.py").module
    start, end = np.array([0.2, 0.9, 0.05, 3.0]), np.array([0.5, 0.7, 0.1, -4.0])
    way = start + np.linspace(0.0, 1.0, 9)[:, None] * (end - start)
    path = geared.follow(geared.forward(way), start=start)
    assert path.status == "OK"
    np.testing.assert_allclose(path.q, way, atol=1e-9)
    np.testing.assert_allclose(geared.search(geared.forward(end), seed=end)[0], end, atol=1e-9)


def test_moveit_has_the_values_of_the_joints(folder: Path) -> None:
    plain = derived(folder, "scara")
    dh = plain.module.dh
    dh = replace(dh, transmission=motor_matrix(dh, {"outer": Relation((("outer", 2.0),))}))
    module, chain = replace(plain.module, dh=dh), plain.reading.chain
    assert moveit.emit(module, chain) == moveit.emit(plain.module, chain)
    assert emit_header(module) != emit_header(plain.module)


@pytest.mark.parametrize("argument", ["seed", "start", "q"])
def test_values_of_a_wrong_shape_are_refused(argument: str, folder: Path, tmp_path: Path) -> None:
    plain = derived(folder, "scara")
    dh = plain.module.dh
    dh = replace(dh, transmission=motor_matrix(dh, {"outer": Relation((("outer", 2.0),))}))
    (tmp_path / "geared_ik.py").write_text(emit_module(replace(plain.module, dh=dh)))
    geared = PythonModule(tmp_path / "geared_ik.py").module
    calls = {
        "seed": lambda x: geared.solve(np.eye(4), seed=x),
        "start": lambda x: geared.follow(np.eye(4)[None], start=x),
        "q": geared.forward,
    }
    for bad in (np.zeros(5), np.zeros(3), 1.0, "motors"):
        with pytest.raises(ValueError, match=argument):
            calls[argument](bad)


@PYTHON_OFTEN
def test_the_verification_tells_another_matrix(language: str, folder: Path, tmp_path: Path) -> None:
    plain = derived(folder, "scara")
    dh = plain.module.dh
    asked = motor_matrix(dh, {"outer": Relation((("outer", 1.0), ("inner", -1.0)))})
    matrix = asked.matrix.copy()
    matrix[1, 0] += 1e-6
    wrong = Transmission(matrix, np.linalg.inv(matrix), asked.offset)
    cases = {"python": ((asked, True), (wrong, False)), "cpp": ((wrong, False),)}  # C++ takes long
    for transmission, right in cases[language]:
        module = replace(plain.module, dh=replace(dh, transmission=transmission))
        (tmp_path / f"{module.name}_ik.py").write_text(emit_module(module))
        (tmp_path / f"{module.name}_ik.hpp").write_text(emit_header(module))
        arm = replace(EmittedArm.of(module), dh=replace(dh, transmission=asked))
        runner = {"python": python_runner, "cpp": cpp_runner}[language](arm, tmp_path)
        report = verify(runner, oracle_for(plain.reading), samples=20)
        assert report.passed is right, report.worst_case
