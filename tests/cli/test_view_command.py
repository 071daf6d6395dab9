"""What `ikgen view` says before it shows anything."""

from __future__ import annotations

import sys

import pytest
from tests.support.solving import FIXTURES

from ikgen.cli.main import run


def test_missing_viser_is_told_before_the_arm_is_derived(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "viser", None)
    assert run(["view", str(FIXTURES / "scara_standard.toml"), "--no-browser"]) == 2
    said = capsys.readouterr().err
    assert "needs the package viser" in said and "deriving" not in said
