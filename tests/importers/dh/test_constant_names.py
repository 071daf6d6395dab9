"""Parameters of tables that are words of some language: none of them is one in emitted code."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest
from tests.support.solving import NO_COMPILER

from ikgen.cli.main import run
from ikgen.importers.dh.constant_names import symbol_of
from ikgen.importers.dh.dh_table import read_dh_table

WORDS = (
    "const_cast", "M_PI", "M_1_PI", "int", "EOF", "NULL", "NAN", "errno", "linux", "stdin", "kDof",
    "solve", "T", "Eigen", "std", "double", "np", "math", "I", "q", "seed_1", "a_2", "l1", "h_",
    "int8_t", "co_await", "E_2", "and_eq", "a_2_", "p_A", "cos_1", "sin_alpha_1",
)  # fmt: skip


ARM = """
name = "arm"
convention = "modified"
[parameters]
{numbers}
[[joints]]
type = "revolute"
alpha = 0
a = 0
d = "{base}"
[[joints]]
type = "revolute"
alpha = "beta"
a = "{upper}"
d = 0
[[joints]]
type = "prismatic"
alpha = "pi/2"
a = "-l_2"
theta = 0
"""


def test_two_names_are_two_symbols() -> None:
    assert len({symbol_of(name) for name in WORDS}) == len(WORDS)
    assert symbol_of("a_2") == "a_2" and symbol_of("l1") == "l_1"


@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER)
def test_all_of_them_can_be_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    sums = [" + ".join(WORDS[k::6]) for k in range(6)]
    parameters = "".join(f'"{word}" = 0.{k + 3}\n' for k, word in enumerate(WORDS))
    joints = "".join(
        f'[[joints]]\ntype = "revolute"\nalpha = {alpha}\na = "{a}"\nd = "{d}"\ntheta = 0\n'
        for alpha, a, d in zip((0, 0, '"pi/2"'), sums[:3], sums[3:], strict=True)
    )
    text = f'name = "words"\nconvention = "modified"\n[parameters]\n{parameters}{joints}'
    Path("table.toml").write_text(text)
    options = ["--task", "position", "--samples", "20", "-q", "--emit", "python,cpp"]
    assert run(["from-dh", "table.toml", *options]) == 0
    ast.parse(Path("words_ik.py").read_text())


@pytest.mark.parametrize(
    ("base", "upper", "symbols"),
    [
        ("h_1", "cos_beta", ("h_1", "beta_", "cos_beta__", "l_2")),
        ("cos_beta", "sin_beta_", ("cos_beta_", "beta__", "sin_beta___", "l_2")),
        ("h_1", "cos_1", ("h_1", "beta_", "cos_1_", "l_2")),
    ],
)
def test_no_length_has_the_name_of_a_cosine(
    tmp_path: Path, base: str, upper: str, symbols: tuple[str, ...]
) -> None:
    """The cosine of an angle `beta_` is the constant `cos_beta_`, as the length `cos_beta` would be."""
    path, given = tmp_path / "blank.toml", tmp_path / "given.toml"
    path.write_text(ARM.format(numbers="", base=base, upper=upper))
    assert read_dh_table(path)[1].symbols == symbols
    numbers = {"beta": 0.7, "l_2": 0.3, base: 0.4, upper: 0.2}
    lines = "\n".join(f"{name} = {value}" for name, value in numbers.items())
    given.write_text(ARM.format(numbers=lines, base=base, upper=upper))
    for table in (path, given):
        options = ["--emit", "python,report", "--samples", "50", "-q", "--force"]
        assert run(["from-dh", str(table), *options, "-o", str(tmp_path)]) == 0
