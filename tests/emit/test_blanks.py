"""Tables without numbers: modules whose constants are to be filled in."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from ikgen.cli.main import run
from ikgen.derivation.derive import derive
from ikgen.emit.blanks import blanks
from ikgen.emit.cpp.cpp_emitter import emit_header
from ikgen.emit.derivation import Derivation
from ikgen.emit.python.python_emitter import emit_module
from ikgen.errors import IkgenError, UsageError
from ikgen.generation.emitted_checks import with_samples
from ikgen.program.interpret import evaluate
from ikgen.records.request import Request
from ikgen.verify.runners.cpp_toolchain import find_compiler
from ikgen.verify.runners.python_module import PythonModule

pytestmark = pytest.mark.usefixtures("solved_once")

ROOT = Path(__file__).resolve().parents[2]
PUMA = ROOT / "urdf_fixtures" / "puma560_symbolic.toml"
PAPER = ROOT / "urdf_fixtures" / "puma560_paper.toml"
NUMBERS = {"a_2": 5.0, "a_3": 1.0, "d_3": 2.0, "d_4": 4.0}

TWISTED = """
name = "twisted"
convention = "modified"
[[joints]]
type = "revolute"
alpha = 0
a = 0
d = "h_1"
[[joints]]
type = "revolute"
alpha = "beta"
a = "l_1"
d = 0
[[joints]]
type = "prismatic"
alpha = "pi/2"
a = "-l_2"
theta = 0
[base]
xyz = [0.1, 0.2, 0.3]
rpy = [0, 0, "pi/2"]
"""


@pytest.fixture
def twisted(tmp_path: Path) -> Derivation:
    """An angle without number, a negative length, and a base."""
    path = tmp_path / "twisted.toml"
    path.write_text(TWISTED)
    return derive(Request(path))


def filled(text: str, numbers: dict[str, float]) -> str:
    """The text with numbers for its constants, as a user would edit it."""
    for name, value in numbers.items():
        text, count = re.subn(rf"(?m)^{name}: float = nan", f"{name}: float = {value!r}", text)
        assert count == 1
    return text


def test_filled_in_module_equals_the_one_with_numbers(tmp_path: Path) -> None:
    blank = emit_module(derive(Request(PUMA)).module)
    (tmp_path / "blank_ik.py").write_text(filled(blank, NUMBERS))
    (tmp_path / "given_ik.py").write_text(emit_module(derive(Request(PAPER)).module))
    ours, given = (PythonModule(tmp_path / f"{n}_ik.py").module for n in ("blank", "given"))
    q = np.random.default_rng(5).uniform(-3, 3, (50, 6))
    poses = given.forward(q)
    np.testing.assert_allclose(ours.forward(q), poses, atol=1e-13)
    a, b = ours.solve_batch(poses), given.solve_batch(poses)
    assert np.array_equal(a[1], b[1]) and a[1].min() == 8
    np.testing.assert_allclose(a[0], b[0], atol=1e-9)


def test_blank_module_says_what_to_fill_in(tmp_path: Path) -> None:
    file = tmp_path / "arm_ik.py"
    file.write_text(filled(emit_module(derive(Request(PUMA)).module), {"a_3": 1.0}))
    with pytest.raises(ValueError, match="fill in a_2, d_3, d_4 at the top of"):
        exec(compile(file.read_text(), str(file), "exec"), {"__file__": str(file)})


def test_generated_and_verified_with_samples(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run(["from-dh", str(PUMA), "-o", str(tmp_path), "--samples", "100"]) == 0
    said = capsys.readouterr().out
    assert "fill in:" in said and "a_2, d_3, a_3, d_4; verified with sample numbers" in said
    assert "100 poses" in said
    assert run(["verify", str(tmp_path)]) == 2
    assert "not checked: no numbers for a_2, d_3, a_3, d_4" in capsys.readouterr().err


def test_frames_are_those_of_the_samples(twisted: Derivation) -> None:
    dh = twisted.reading.dh
    assert dh.symbols == ("h_1", "beta_", "l_1", "l_2")
    names = {one.name: one.value for one in twisted.module.program.parameters}
    names |= {b.name: b.sample for b in blanks(twisted.module)}
    names |= {"cos_beta_": np.cos(names["beta_"]), "sin_beta_": np.sin(names["beta_"])}
    for written, given in zip(twisted.module.program.frames, dh.file_frames, strict=True):
        values = [[evaluate(x, names) for x in row] for row in written]
        np.testing.assert_allclose(values, given[:3], atol=1e-14)


def test_angle_without_number(twisted: Derivation, tmp_path: Path) -> None:
    text = emit_module(twisted.module)
    assert "cos_beta_ = cos(beta_)" in text
    (tmp_path / "t_ik.py").write_text(
        filled(text, {"beta_": 0.7, "h_1": 0.3, "l_1": 0.5, "l_2": 0.4})
    )
    module = PythonModule(tmp_path / "t_ik.py").module
    q = np.array([0.4, -0.8, 0.9])
    found = module.solve(module.forward(q))
    assert min(np.abs(found.q - q).max(axis=1)) < 1e-9


def test_header_refuses_to_compile_until_filled_in(twisted: Derivation) -> None:
    header = emit_header(twisted.module)
    assert 'static_assert(l_1 == l_1, "fill in l_1 at the top of twisted_ik.hpp");' in header
    assert "inline const double cos_beta_ = std::cos(beta_);" in header
    assert "quiet_NaN" not in emit_header(with_samples(twisted).module)


def test_header_is_verified_with_samples(twisted: Derivation, tmp_path: Path) -> None:
    try:
        find_compiler()
    except IkgenError:
        pytest.skip("no C++ compiler here")
    robot = twisted.reading.source.path
    arguments = ["from-dh", str(robot), "--emit", "cpp", "-o", str(tmp_path / "out"), "-q"]
    assert run([*arguments, "--samples", "50"]) == 0


def test_elimination_needs_numbers(tmp_path: Path) -> None:
    text = (ROOT / "tests" / "robots" / "tables" / "Issue4.toml").read_text()
    path = tmp_path / "issue4.toml"
    path.write_text(re.sub(r"(?ms)^\[parameters\].*?(?=^\[)", "", text))
    module = derive(Request(path)).module
    with pytest.raises(UsageError, match="only an elimination solves this arm"):
        emit_module(module)


def test_constants_of_expressions_are_told_with_them(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    table = tmp_path / "arm.toml"
    text = PUMA.read_text().replace('a = "a_2"', 'a = "2*h - l1/4 + 0.1"', 1)
    table.write_text(text.replace('"d_3"', '"-height"', 1))
    options = ["-o", str(tmp_path), "--samples", "20", "--emit", "python,cpp", "--no-verify"]
    assert run(["from-dh", str(table), *options]) == 0
    told = "a_2 = 2*h - 0.25*l1 + 0.1, height_ = height, a_3, d_4"
    assert told in capsys.readouterr().out
    for module, comment in (("puma560_ik.py", "  # "), ("puma560_ik.hpp", ";  // ")):
        lines = (tmp_path / module).read_text().splitlines()
        found = [line.partition(comment)[2].partition(": ")[2] for line in lines if "a_2" in line]
        assert "2*h - 0.25*l1 + 0.1" in found, module
