"""The reports as they come out: HTML in a browser, LaTeX on paper."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
from functools import cache
from pathlib import Path
from typing import Any

import pytest
from tests.support.sampled import sampled

from ikgen.derivation.derive import derive
from ikgen.errors import UnsolvedChainError
from ikgen.records.request import Request
from ikgen.report import emit_report, emit_unsolved
from ikgen.report.document import Paragraph
from ikgen.report.latex import to_latex

pytestmark = pytest.mark.usefixtures("solved_once")

ROOT = Path(__file__).resolve().parents[2]
TABLES = ROOT / "tests" / "robots" / "tables"
SUITE = sorted(path.stem for path in TABLES.glob("*.toml"))
IN_BROWSER = ("Puma_paper", "Olson13", "Parkman13", "Chair6DOF", "Raven-II")
STICKS_OUT = 2.0
"""Points by which a line may stick out of the margin without being seen."""

MEASURE = """
<script>
window.addEventListener("load", () => {
  const shown = [...document.querySelectorAll("math")].filter((m) => m.checkVisibility());
  const seen = shown.map((m) => m.getBoundingClientRect());
  const svg = document.querySelector("figure svg");
  const box = svg ? svg.getBoundingClientRect() : { width: 0, height: 0 };
  const fraction = document.querySelector("main > .formulas mfrac");
  const right = document.documentElement.clientWidth + 1;
  const scrolled = ".wide *, .matrix *, .formulas *, figure *";
  const wide = [...document.querySelectorAll("body *")].filter(
    (e) => !e.matches(scrolled) && e.getBoundingClientRect().right > right);
  const targets = [...document.querySelectorAll("a[href]")].map((a) => a.getAttribute("href"));
  const result = {
    width: document.documentElement.scrollWidth, inner: document.documentElement.clientWidth,
    maths: seen.length, empty: seen.filter((r) => r.width < 2 || r.height < 2).length,
    svg: [box.width, box.height], wide: wide.map((e) => e.tagName),
    stacked: fraction === null ? null : fraction.firstElementChild.getBoundingClientRect().bottom
      <= fraction.lastElementChild.getBoundingClientRect().top + 4,
    resources: performance.getEntriesByType("resource").length, errors: window.failed,
    links: targets.length, dangling: targets.filter((t) => !document.getElementById(t.slice(1))),
    ids: [...document.querySelectorAll("[id]")].length,
    distinct: new Set([...document.querySelectorAll("[id]")].map((e) => e.id)).size,
  };
  parent.postMessage(JSON.stringify(result), "*");
});
</script>
"""
FRAME = """<!DOCTYPE html><script>
addEventListener("message", (e) => document.body.setAttribute("data-measured", e.data));
</script><body><iframe src="report.html" width="{width}" height="800" frameborder="0"></iframe></body>
"""
CATCH = "<script>window.failed = 0; window.onerror = () => { window.failed += 1; };</script>"


@cache
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


def measured(page: str, width: int, folder: Path) -> dict[str, Any]:
    """What a browser says of a page in a window of the width (px)."""
    browser = chromium()
    inside = page.replace("<head>", f"<head>{CATCH}").replace("</body>", f"{MEASURE}</body>")
    (folder / "report.html").write_text(inside, encoding="utf-8")
    frame = folder / "frame.html"
    frame.write_text(FRAME.format(width=width), encoding="utf-8")
    command = [
        browser, "--headless", "--no-sandbox", "--disable-gpu", "--window-size=1400,900",
        f"--user-data-dir={folder / 'profile'}", "--virtual-time-budget=3000", "--dump-dom",
        frame.as_uri(),
    ]  # fmt: skip
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    found = re.search(r'data-measured="([^"]*)"', done.stdout)
    assert found is not None, done.stderr[-2000:]
    result: dict[str, Any] = json.loads(found.group(1).replace("&quot;", '"'))
    return result


def check_page(page: str, width: int, folder: Path) -> dict[str, Any]:
    """What holds for every report: nothing sticks out, nothing is fetched, all links lead somewhere."""
    assert "<script" not in page and len(page.encode()) < 1.5e6
    seen = measured(page, width, folder)
    assert seen["errors"] == 0 and seen["resources"] == 0
    assert seen["empty"] == 0 and seen["stacked"] in (True, None)
    assert min(seen["svg"]) > 40
    assert seen["width"] <= seen["inner"] <= width and seen["wide"] == []
    assert seen["links"] > 3 and seen["dangling"] == [] and seen["ids"] == seen["distinct"]
    return seen


@pytest.mark.parametrize("width", [1200, 390])
@pytest.mark.parametrize("name", IN_BROWSER)
def test_page_in_a_browser(name: str, width: int, tmp_path: Path) -> None:
    assert check_page(report_of(name, ".html"), width, tmp_path)["maths"] > 50


@pytest.mark.long
@pytest.mark.parametrize("name", SUITE)
def test_page_of_the_whole_suite_on_a_phone(name: str, tmp_path: Path) -> None:
    """`python -m pytest -m long tests/report/test_rendered.py`"""
    check_page(report_of(name, ".html"), 390, tmp_path)


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


ODD = "a<b>c|d 'e' --f ?`g !`h ''i \\j {k} ~l ^m °±·× θαπσ ≤≥"
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
    for part in ("a<b>c|d", "?‘g", "!‘h", "’’i", "\\j", "{k}", "θαπσ"):
        assert text.count(part) == 2, (part, text)
    assert "--f" in text or "-‐f" in text, text


@pytest.mark.slow
@pytest.mark.parametrize("name", sampled(SUITE, IN_BROWSER))
def test_latex(name: str, tmp_path: Path) -> None:
    """`python -m pytest -m long tests/report/test_rendered.py` looks at the whole suite."""
    log = typeset(report_of(name, ".tex"), tmp_path)
    wide = [float(w) for w in re.findall(r"Overfull \\hbox \(([\d.]+)pt", log)]
    assert max(wide, default=0.0) < STICKS_OUT
    assert "Missing character" not in log and "undefined" not in log
