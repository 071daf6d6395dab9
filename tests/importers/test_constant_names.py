"""Parameters of tables that are words of some language: none of them is one in emitted code."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest
from tests.support.solving import NO_COMPILER

from ikgen.cli.main import run
from ikgen.importers.dh.constant_names import symbol_of

WORDS = (
    "const_cast", "M_PI", "M_1_PI", "int", "EOF", "NULL", "NAN", "errno", "linux", "stdin", "kDof",
    "solve", "T", "Eigen", "std", "double", "np", "math", "I", "q", "seed_1", "a_2", "l1", "h_",
    "int8_t", "co_await", "E_2", "and_eq", "a_2_", "p_A",
)  # fmt: skip


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
