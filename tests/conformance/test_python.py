"""The text of the emitted Python module: whatever a file names things, it can be imported."""

from __future__ import annotations

import ast
import dataclasses
import functools
from pathlib import Path
from typing import Any

import pytest

from ikgen.cli.main import run
from ikgen.emit.module import SolverModule
from ikgen.emit.nanobind import emit
from ikgen.emit.python import emit_module
from ikgen.pipeline import Request, derive
from ikgen.verify.runners.python_module import PythonModule

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
    return dataclasses.replace(module, dh=dh, source_name=odd, free=(0,))


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
