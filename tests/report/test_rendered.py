"""The reports as they come out: HTML in a browser, LaTeX on paper."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from ikgen.errors import UnsolvedChainError
from ikgen.generation.derive import derive
from ikgen.generation.request import Request
from ikgen.report import emit_report, emit_unsolved
from ikgen.report.document import Paragraph
from ikgen.report.latex import to_latex

ROOT = Path(__file__).resolve().parents[2]
TABLES = ROOT / "tests" / "robots" / "tables"
SUITE = sorted(path.stem for path in TABLES.glob("*.toml"))
IN_BROWSER = ("Puma_paper", "Olson13", "Parkman13", "Chair6DOF", "Raven-II")
STICKS_OUT = 2.0
"""Points by which a line may stick out of the margin without being seen."""

MEASURE = """
<script>
window.addEventListener("load", () => {
  const seen = [...document.querySelectorAll("math")].map((m) => m.getBoundingClientRect());
  const svg = document.querySelector("figure svg");
  const box = svg ? svg.getBoundingClientRect() : { width: 0, height: 0 };
  const fraction = document.querySelector("mfrac");
  const wide = [...document.querySelectorAll("body *")].filter(
    (e) => e.getBoundingClientRect().right > document.documentElement.clientWidth + 1);
  const result = {
    width: document.documentElement.scrollWidth, inner: document.documentElement.clientWidth,
    maths: seen.length, empty: seen.filter((r) => r.width < 2 || r.height < 2).length,
    svg: [box.width, box.height], wide: wide.length,
    stacked: fraction === null ? null : fraction.firstElementChild.getBoundingClientRect().bottom
      <= fraction.lastElementChild.getBoundingClientRect().top + 4,
    resources: performance.getEntriesByType("resource").length, errors: window.failed,
  };
  document.body.setAttribute("data-measured", JSON.stringify(result));
});
</script>
"""
CATCH = "<script>window.failed = 0; window.onerror = () => { window.failed += 1; };</script>"


def report_of(name: str, kind: str) -> str:
    """The text of one file of a robot's report, solved or not."""
    try:
        texts = emit_report(derive(Request(TABLES / f"{name}.toml")))
    except UnsolvedChainError as error:
        texts = emit_unsolved(error.unsolved, error.hint)
    return next(text for file, text in texts.items() if file.endswith(kind))


def chromium() -> str:
    found = next(
        filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None
    )
    if found is None:
        pytest.skip("no chromium here")
    return found


@pytest.mark.parametrize("name", IN_BROWSER)
def test_page_in_a_browser(name: str, tmp_path: Path) -> None:
    browser = chromium()
    page = report_of(name, ".html")
    assert "<script" not in page
    measured = page.replace("<head>", f"<head>{CATCH}").replace("</body>", f"{MEASURE}</body>")
    file = tmp_path / "report.html"
    file.write_text(measured, encoding="utf-8")
    command = [
        browser, "--headless", "--no-sandbox", "--disable-gpu", "--window-size=1200,900",
        f"--user-data-dir={tmp_path / 'profile'}", "--virtual-time-budget=2000", "--dump-dom",
        file.as_uri(),
    ]  # fmt: skip
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    found = re.search(r'data-measured="([^"]*)"', done.stdout)
    assert found is not None, done.stderr[-2000:]
    seen = json.loads(found.group(1).replace("&quot;", '"'))
    assert seen["errors"] == 0 and seen["resources"] == 0
    assert seen["maths"] > 50 and seen["empty"] == 0
    assert seen["stacked"] in (True, None)
    assert min(seen["svg"]) > 40
    assert seen["width"] <= seen["inner"] <= 1200 and seen["wide"] == 0


def typeset(text: str, folder: Path) -> str:
    """The log of pdflatex; the test is skipped where there is none."""
    pdflatex = shutil.which("pdflatex")
    if pdflatex is None:
        pytest.skip("no pdflatex here")
    (folder / "report.tex").write_text(text, encoding="utf-8")
    command = [pdflatex, "-interaction=nonstopmode", "-halt-on-error", "report.tex"]
    done = subprocess.run(command, cwd=folder, capture_output=True, check=False)
    log = done.stdout.decode("latin-1")
    assert done.returncode == 0, log[-2000:]
    return log


ODD = "a<b>c|d 'e' --f ?`g !`h ''i \\j {k} ~l ^m °±·×"
LETTERS = "".join(ch for ch in map(chr, range(0xA1, 0x250)) if ch.isprintable())


def test_names_on_paper(tmp_path: Path) -> None:
    """Names come out as they are in the file, or as question marks: never as something else."""
    if shutil.which("pdftotext") is None:
        pytest.skip("no pdftotext here")
    page = to_latex(f"{ODD} {LETTERS}", "subtitle", [Paragraph((f"{ODD} end",), False)])
    log = typeset(page, tmp_path)
    assert "Missing character" not in log and "pk>" not in log
    done = subprocess.run(["pdftotext", "report.pdf", "-"], cwd=tmp_path, capture_output=True)
    text = done.stdout.decode("utf-8")
    for part in ("a<b>c|d", "?‘g", "!‘h", "’’i", "\\j", "{k}"):
        assert text.count(part) == 2, (part, text)
    assert "--f" in text or "-‐f" in text, text


@pytest.mark.slow
@pytest.mark.parametrize("name", SUITE)
def test_latex_of_the_whole_suite(name: str, tmp_path: Path) -> None:
    """`python -m pytest -m slow tests/report/test_rendered.py`"""
    log = typeset(report_of(name, ".tex"), tmp_path)
    wide = [float(w) for w in re.findall(r"Overfull \\hbox \(([\d.]+)pt", log)]
    assert max(wide, default=0.0) < STICKS_OUT
    assert "Missing character" not in log and "undefined" not in log
