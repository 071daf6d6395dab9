"""The PDF of a report comes with its LaTeX text, or it is said why not."""

from __future__ import annotations

import os
import shutil
from pathlib import Path

import pytest

from ikgen.cli.main import run
from ikgen.report.pdf import typeset

ROBOT = Path(__file__).resolve().parents[2] / "examples/setuptools_robot/urdf/elbow.urdf"
PAGE = "\\documentclass{article}\\begin{document}\\today, $\\theta_1$\\end{document}\n"
FAILING = "#!/bin/sh\necho '! Emergency stop.' > elbow_report.log\nexit 1\n"

pytestmark = pytest.mark.skipif(
    os.name == "nt", reason="the stand-in for pdflatex is a shell script"
)


def report(out: Path, *more: str) -> int:
    asked = ["report", str(ROBOT), "--task", "position", "--no-verify", "-o", str(out)]
    return run([*asked, *more])


@pytest.fixture
def failing_latex(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A pdflatex that always fails, first on PATH."""
    (tmp_path / "bin").mkdir()
    (tmp_path / "bin/pdflatex").write_text(FAILING)
    (tmp_path / "bin/pdflatex").chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path / "bin"), prepend=os.pathsep)


@pytest.mark.usefixtures("failing_latex")
def test_no_stale_pdf_beside_a_new_report(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    out.mkdir()
    (out / "elbow_report.tex").write_text("an earlier one")
    (out / "elbow_report.pdf").write_bytes(b"%PDF of the earlier one")
    assert report(out) == 2
    assert (out / "elbow_report.pdf").is_file()
    assert report(out, "--force") == 0
    said = capsys.readouterr()
    assert "warning: no PDF of elbow_report.tex: pdflatex fails: Emergency stop." in said.err
    assert "warning: removed " in said.err
    assert sorted(p.name for p in out.iterdir()) == [
        "elbow_graph.svg", "elbow_report.html", "elbow_report.json", "elbow_report.tex"
    ]  # fmt: skip
    assert ".pdf" not in said.out


@pytest.mark.usefixtures("failing_latex")
def test_a_pdf_of_the_same_text_stays(tmp_path: Path) -> None:
    assert report(tmp_path / "out") == 0
    (tmp_path / "out/elbow_report.pdf").write_bytes(b"%PDF")
    assert report(tmp_path / "out") == 0
    assert (tmp_path / "out/elbow_report.pdf").is_file()


@pytest.mark.skipif(shutil.which("pdflatex") is None, reason="needs pdflatex")
def test_the_same_text_gives_the_same_pdf() -> None:
    first, second = (typeset("page.tex", PAGE) for _ in range(2))
    assert first.pdf is not None and first.pdf.startswith(b"%PDF") and first == second
    assert typeset("page.tex", PAGE.replace("\\theta", "\\nonsense")).failure == (
        "pdflatex fails: Undefined control sequence."
    )
