"""A sample of the matrix of surroundings; the whole is `python -m benchmarks.determinism`."""

from __future__ import annotations

import pytest
from benchmarks.command_line import REPOSITORY

from benchmarks import determinism

ELBOW = REPOSITORY / "examples/setuptools_robot/urdf/elbow.urdf"


@pytest.mark.long
def test_the_same_bytes(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    chosen = ["Haswell", "SkylakeX", "seed 4242", "tr_TR", "processes"]
    monkeypatch.setattr("sys.argv", ["determinism", "--arms", str(ELBOW), "--only", *chosen])
    assert determinism.main() == 0, capsys.readouterr().out
    rows = [row for row in determinism.rows() if any(name in row.words for name in chosen)]
    assert len(chosen) - 2 <= len(rows) == len(capsys.readouterr().out.splitlines()) - 1
