"""The notebooks run, cell after cell, draw, and what they say about numbers holds."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import jupytext
import matplotlib.pyplot as plt
import pytest

pytestmark = pytest.mark.usefixtures("solved_once")

ROOT = Path(__file__).resolve().parents[2]
NOTEBOOKS = sorted((ROOT / "docs/notebooks").glob("*.py"))


def test_there_are_notebooks() -> None:
    assert len(NOTEBOOKS) >= 3


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook_runs(
    path: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(path.parent)  # as Jupyter and VS Code do
    monkeypatch.setenv("IKGEN_CACHE_DIR", str(tmp_path))
    plt.switch_backend("agg")
    plt.close("all")
    cells = jupytext.read(path).cells
    assert cells[0].cell_type == "markdown" and cells[0].source.startswith("# ")
    names: dict[str, Any] = {"__name__": "__main__"}
    for number, cell in enumerate(cells):
        if cell.cell_type == "code":
            exec(compile(cell.source, f"{path.name}, cell {number}", "exec"), names)
    assert len(capsys.readouterr().out.splitlines()) > 3
    figures = [plt.figure(number) for number in plt.get_fignums()]
    plt.close("all")
    assert figures
    for figure in figures:
        assert all(place.lines for place in figure.axes)
        figure.savefig(tmp_path / "figure.png")
