"""What terminals show: drawings in dots, units, a bar that is only there on a terminal."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import get_args

import numpy as np
import pytest

from ikgen.cli.braille import drawn, skeleton_text
from ikgen.cli.console import Console
from ikgen.cli.main import run
from ikgen.derivation.progress import Stage
from ikgen.derivation.read import read
from ikgen.records.request import Request

ROOT = Path(__file__).resolve().parents[2]


def test_strokes_become_dots() -> None:
    assert drawn(np.array([[[0, 0], [7, 0]]]), 6, 2) == "⠉⠉⠉⠉"
    assert drawn(np.array([[[0, 0], [0, 7]]]), 6, 2) == "⡇\n⡇"
    assert drawn(np.array([[[0, 4], [1, 5]], [[-9, -9], [-3, -3]]]), 2, 2) == "⠑"
    assert drawn(np.empty((0, 2, 2)), 4, 4) == ""


@pytest.mark.parametrize("name", ["ur5e.urdf", "scara_standard.toml", "puma560_symbolic.toml"])
def test_skeletons_fit_into_a_terminal(name: str) -> None:
    tip = "tool0" if name.startswith("ur5e") else None
    text = skeleton_text(read(Request(ROOT / "urdf_fixtures" / name, tip=tip)).dh)
    lines = text.splitlines()
    assert 3 < len(lines) <= 13 and max(map(len, lines)) <= 34
    assert re.fullmatch(r"[\u2800-\u28ff \n]+", text)


def test_inspect_shows_the_arm_and_units(capsys: pytest.CaptureFixture[str]) -> None:
    table = ROOT / "urdf_fixtures/scara_standard.toml"
    assert run(["inspect", str(table), "--no-advice", "-q"]) == 0
    out = capsys.readouterr().out
    assert re.search(r"alpha \(rad\) +a \(m\) +theta \(rad\) +d \(m\)", out)
    assert re.search(r"l_1 = [\d.]+ m\b", out) and re.search(r"[\u2801-\u28ff]{3}", out)


def test_a_bar_with_the_time_left(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("CI", raising=False)
    monkeypatch.setattr(sys.stderr, "isatty", lambda: True, raising=False)
    with Console() as console:
        assert console._status is not None
        console.share("map", 1, 4)
        first = str(console._status.status)
        console.share("map", 4, 4)
        assert "mapping" in first and "25 %" in first and "s left" in first
        assert "100 %, 0 s left" in str(console._status.status)


def test_no_bar_without_a_terminal(capsys: pytest.CaptureFixture[str]) -> None:
    with Console() as console:
        console.share("map", 1, 4)
    assert capsys.readouterr() == ("", "")


def test_every_stage_is_told_in_words(capsys: pytest.CaptureFixture[str]) -> None:
    stages = get_args(Stage)
    with Console(verbose=True) as console:
        for stage in stages:
            console(stage, "this")
    said = capsys.readouterr().err.splitlines()
    assert len(set(said)) == len(stages)
    assert all(line.endswith("ing this") for line in said)
