"""A sample of the runs that are killed; the whole is `python -m benchmarks.kills`."""

from __future__ import annotations

import os

import pytest

from benchmarks import kills


@pytest.mark.skipif(os.name == "nt", reason="needs signals")
def test_nothing_is_lost_or_half(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sys.argv", ["kills", "--kills", "4", "--seed", "1"])
    assert kills.main() == 0, capsys.readouterr().out
