"""Random tables whose headers are soaked."""

from __future__ import annotations

from pathlib import Path

import pytest
from benchmarks.command_line import Emitted
from benchmarks.soak_counts import DECADES, Soak

from benchmarks import drawn_soaks, table_soak

FEW = ["--class", "3-6", "--count", "2"]


@pytest.mark.parametrize(("missed", "code"), [(0, 0), (1, 1)])
def test_a_missed_solution_is_told_and_its_file_kept(
    missed: int,
    code: int,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
) -> None:
    decades = [(0,) * 6] * DECADES
    decades[2] = (10, missed, 0, 0, 0, 0)
    monkeypatch.setattr(drawn_soaks, "emit", lambda arm, folder, languages: made(arm, folder))
    monkeypatch.setattr(drawn_soaks, "soak", lambda *_, **__: Soak(20, 0, tuple(decades), ()))
    assert table_soak.main([*FEW, "--keep", str(tmp_path)]) == code
    assert f"{missed} failures of 20 rows" in capsys.readouterr().out
    kept = sorted(path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*.toml"))
    assert kept == ["1-0/table.toml", "1-1/table.toml"][: 2 * code]


def made(arm: drawn_soaks.Source, folder: Path) -> Emitted:
    assert arm.file is not None and arm.file.is_file()
    return Emitted(arm, 0, 0.0, (), {"task": "pose"}, header=folder / "arm_ik.hpp")


def test_what_was_not_emitted_is_told(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    refused = Emitted(table_soak.Source("", "", None), 3, 0.0, (), {"error": "no closed form"})
    monkeypatch.setattr(drawn_soaks, "emit", lambda *_: refused)
    assert table_soak.main(FEW) == 2
    assert capsys.readouterr().out.count("exit code 3: no closed form") == 2
