"""Takes pictures of reports, a map and the documentation in a browser, light and dark:
`python docs/pictures/screenshots.py FOLDER [SITE]`, with Chromium on PATH; SITE is what mkdocs built."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from ikgen.generation.derive import derive
from ikgen.generation.request import Request
from ikgen.report import emit_report

__all__ = ["REPORTS", "take"]

ROOT = Path(__file__).resolve().parents[2]
REPORTS = {
    "puma560": Request(ROOT / "urdf_fixtures/puma560_paper.toml"),
    "ur5e": Request(ROOT / "urdf_fixtures/ur5e.urdf", tip="tool0"),
    "fr3": Request(ROOT / "urdf_fixtures/franka_fr3.urdf"),
    "eliminated": Request(ROOT / "tests/robots/tables/Issue4.toml"),
}
"""Name -> the arm whose report is taken."""


def take(page: Path, picture: Path, size: str = "1250,1500", *, dark: bool = False) -> None:
    """One picture of a page, in a window of the size (px)."""
    browser = shutil.which("chromium") or shutil.which("google-chrome")
    if browser is None:
        raise SystemExit("no chromium on PATH: apt-get install chromium")
    with tempfile.TemporaryDirectory() as profile:
        command = [
            browser, "--headless", "--no-sandbox", "--hide-scrollbars", f"--window-size={size}",
            f"--user-data-dir={profile}", f"--screenshot={picture.resolve()}",
            *(["--blink-settings=preferredColorScheme=0"] if dark else []), page.resolve().as_uri(),
        ]  # fmt: skip
        subprocess.run(command, check=True, capture_output=True, timeout=120)


def main(arguments: list[str]) -> None:
    """All of them."""
    folder = Path(arguments[0])
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as work:
        for name, request in REPORTS.items():
            texts = emit_report(derive(request))
            page = Path(work, f"{name}.html")
            page.write_text(next(t for n, t in texts.items() if n.endswith(".html")), "utf-8")
            take(page, folder / f"report_{name}.png")
            take(page, folder / f"report_{name}_dark.png", dark=True)
    if len(arguments) > 1:
        take(Path(arguments[1]) / "index.html", folder / "home.png", "1250,1100")
        take(Path(arguments[1]) / "index.html", folder / "home_dark.png", "1250,1100", dark=True)


if __name__ == "__main__":
    main(sys.argv[1:] or ["screenshots"])
