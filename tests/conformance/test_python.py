"""The text of the emitted Python module: whatever a file names things, it can be imported."""

from __future__ import annotations

import ast
import dataclasses
import functools
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from ikgen.cli.main import run
from ikgen.derivation.derive import derive
from ikgen.emit.nanobind import emit
from ikgen.emit.python.python_emitter import emit_module
from ikgen.emit.solver_module import SolverModule
from ikgen.records.request import Request
from ikgen.verify.runners.python_module import PythonModule

pytestmark = pytest.mark.usefixtures("solved_once")

FIXTURES = Path(__file__).resolve().parents[2] / "urdf_fixtures"
KUKA = FIXTURES / "kuka_kr6r900sixx.urdf"
ODD = (
    r"C:\users\new",
    'ba"""se"',
    r"d\N{x}.urdf",
    'tool "0" \\ \' \n é \U0001f9be <b> ??/ {{ x }} \x00\x1b\r\u2028\u202e',
    "ends in \\",
    "it's",
)


@functools.cache
def kuka() -> SolverModule:
    return derive(Request(KUKA)).module


def named(odd: str) -> SolverModule:
    """An arm with an odd name wherever a file gives one."""
    module = kuka()
    joints = (dataclasses.replace(module.dh.joints[0], name=odd), *module.dh.joints[1:])
    dh = dataclasses.replace(
        module.dh, robot=odd, base_link=odd, tip_link=odd[::-1], joints=joints, free=(odd,)
    )
    return dataclasses.replace(module, dh=dh, source_name=odd)


def imported(text: str, folder: Path) -> Any:
    """The module of a text, through a file."""
    path = folder / "odd_ik.py"
    path.write_text(text, encoding="utf-8")
    return PythonModule(path).module


@pytest.mark.parametrize("odd", [*ODD, "not utf-8: \udc80"])
def test_odd_names_in_the_docstring(odd: str) -> None:
    text = emit_module(named(odd))
    said = ast.get_docstring(ast.parse(text.encode("utf-8")), clean=False)
    assert said is not None
    assert said.startswith(f"Closed-form inverse kinematics of {odd}, {odd} to {odd[::-1]}.\n")
    assert f"from {odd};" in said


@pytest.mark.parametrize("odd", ODD)
def test_odd_names_in_constants(odd: str, tmp_path: Path) -> None:
    module = imported(emit_module(named(odd)), tmp_path)
    assert (odd, odd[::-1]) == (module.BASE_LINK, module.TIP_LINK)
    assert (module.JOINT_NAMES[0], module.FREE_JOINTS) == (odd, (odd,))


@pytest.mark.parametrize("odd", ODD)
def test_odd_names_in_the_compiled_package(odd: str) -> None:
    module = named(odd)
    package = f"{module.name}_ik_ext"
    tree = ast.parse(emit(module)[f"{package}/{package}/__init__.py"].encode("utf-8"))
    said = {
        node.target.id: ast.literal_eval(node.value)
        for node in tree.body
        if isinstance(node, ast.AnnAssign)
        and isinstance(node.target, ast.Name)
        and isinstance(node.value, ast.Constant | ast.Tuple)
    }
    assert (said["BASE_LINK"], said["TIP_LINK"]) == (odd, odd[::-1])
    assert (said["JOINT_NAMES"][0], said["FREE_JOINTS"]) == (odd, (odd,))


def test_constants_are_written_plainly() -> None:
    text = emit_module(named("é \U0001f9be <b> it's"))
    assert 'BASE_LINK: str = "é \U0001f9be <b> it\'s"\n' in text


@pytest.fixture(scope="module")
def arm(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """The module of an arm with limits on all joints, imported."""
    return imported(emit_module(kuka()), tmp_path_factory.mktemp("arm"))


def test_a_seed_many_turns_away(arm: Any) -> None:
    pose = arm.forward([0.2, -0.9, 1.1, 0.3, 0.6, -0.4])
    for far in (1e6, 1e16, 1e300):
        for seed in (np.full(6, far), np.full(6, -far)):
            found = arm.solve(pose, seed=seed)
            q, (count,), _ = arm.solve_batch([pose], seed=seed)
            assert count == len(found) == len(arm.solve(pose)) > 1
            assert np.abs(arm.forward(found.q) - pose).max() < 1e-9
            assert np.abs(q[0, :count] - found.q).max() < 1e-9


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_a_seed_that_is_no_number(arm: Any, bad: float) -> None:
    pose, seed = np.asarray(arm.forward(np.full(6, 0.5))), np.zeros(6)
    seed[3] = bad
    with pytest.raises(ValueError, match=r"seed\[.*3\] is .*not finite"):
        arm.solve(pose, seed=seed)
    for seeds in (seed, np.stack([np.zeros(6), seed])):
        with pytest.raises(ValueError, match=r"seed\[.*3\] is .*not finite"):
            arm.solve_batch([pose, pose], seed=seeds)


def test_a_free_value_that_is_no_number(tmp_path: Path) -> None:
    held = derive(Request(FIXTURES / "franka_fr3.urdf", free={"fr3_joint7": None})).module
    arm = imported(emit_module(held), tmp_path)
    pose = np.asarray(arm.forward(np.full(7, -0.5)))
    for free in ([np.nan], {"fr3_joint7": np.inf}):
        with pytest.raises(ValueError, match=r"free .* not finite"):
            arm.solve(pose, free=free)
        with pytest.raises(ValueError, match=r"free .* not finite"):
            arm.solve_batch([pose], free=free)
    with pytest.raises(ValueError, match=r"free .* not finite"):
        arm.solve_batch([pose, pose], free=[[0.0], [np.nan]])


@pytest.mark.parametrize("seed", [0.5, [[0.0] * 6], [0.0] * 5])
def test_a_seed_of_another_shape(arm: Any, seed: Any) -> None:
    with pytest.raises(ValueError, match="shape"):
        arm.solve(arm.forward(np.full(6, 0.5)), seed=seed)


def test_odd_names_in_a_file(tmp_path: Path) -> None:
    text = KUKA.read_text(encoding="utf-8")
    text = text.replace('<robot name="kuka_kr6r900sixx"', r'<robot name="C:\users\new"')
    text = text.replace('"base_link"', '\'ba"""se\'')
    robot = tmp_path / r"d\N{x}.urdf"
    robot.write_text(text, encoding="utf-8")
    options = ["--base", 'ba"""se', "--tip", "tool0", "-o", str(tmp_path / "out"), "-q"]
    assert run(["from-urdf", str(robot), *options, "--samples", "10"]) == 0
    (module,) = (tmp_path / "out").glob("*_ik.py")
    assert r"of C:\users\new, ba" in str(PythonModule(module).module.__doc__)


FAR = (1e3, 2e6, 1e9, 1e16, -1e16, 1e300)


@pytest.mark.parametrize("far", FAR)
def test_rows_are_right_whatever_turn_the_seed_is_on(far: float, tmp_path: Path) -> None:
    arm = imported(emit_module(kuka()), tmp_path)
    pose = arm.forward([0.3, -0.5, 0.9, 0.2, 0.4, 0.1])
    seed = np.full(6, far)
    for limits in (True, False):
        plain = arm.solve(pose, limits=limits)
        found = arm.solve(pose, seed=seed, limits=limits)
        assert len(found) == len(plain) > 0
        assert np.abs(arm.forward(found.q) - pose).max() < 1e-9
        q, count, _ = arm.solve_batch(pose[None], seed=seed, limits=limits)
        assert count[0] == len(plain)
        assert np.abs(arm.forward(q[0, : count[0]]) - pose).max() < 1e-9


def test_turns_that_can_be_told_apart_are_kept(tmp_path: Path) -> None:
    arm = imported(emit_module(kuka()), tmp_path)
    pose = arm.forward([0.3, -0.5, 0.9, 0.2, 0.4, 0.1])
    found = arm.solve(pose, seed=np.full(6, 9e5), limits=False)
    assert np.abs(found.q - 9e5).max() <= np.pi + 1e-9


def test_complex_numbers_are_refused(tmp_path: Path) -> None:
    arm = imported(emit_module(kuka()), tmp_path)
    pose, q = arm.forward(np.zeros(6)), np.zeros(6)
    for call in (
        lambda: arm.solve(pose + 0.5j),
        lambda: arm.solve((pose + 0j).tolist()),
        lambda: arm.solve_batch((pose + 0j)[None]),
        lambda: arm.solve(pose, seed=q + 1j),
        lambda: arm.forward(q + 1j),
        lambda: arm.jacobian(q + 1j),
    ):
        with pytest.raises(ValueError, match="complex"):
            call()
