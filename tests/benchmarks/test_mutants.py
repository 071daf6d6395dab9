"""A sample of mutants of real robot files; the whole is `python -m benchmarks.mutants`."""

from __future__ import annotations

import random
from pathlib import Path

import pytest
from benchmarks.mutations import mutant

from benchmarks import mutants


def test_a_seed_gives_the_same_mutants() -> None:
    text = mutants.robot_files()[0].read_text("utf-8")
    first, again, other = (mutant(text, random.Random(seed)) for seed in ("a", "a", "b"))
    assert first == again != other


def test_all_are_read_or_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["mutants", "--read", "50", "--run", "1", "--seed", "3", "--keep", str(tmp_path)]
    monkeypatch.setattr("sys.argv", arguments)
    assert mutants.main() == 0, capsys.readouterr().out


def test_mutants_from_a_number_on_are_those_of_that_number() -> None:
    first = list(mutants.mutants(5, 7))
    assert list(mutants.mutants(3, 7, 2)) == first[2:]
    assert len({name for name, _ in first}) == 5
