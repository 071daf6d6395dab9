"""The documentation as a site: fits a phone, is quiet, and has nothing that axe-core calls serious."""

from __future__ import annotations

import functools
import http.server
import os
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from tests.support.browser import browser, look_at

ROOT = Path(__file__).resolve().parents[2]
DOCS = ROOT / "docs"
PAGES = sorted(str(path.relative_to(DOCS).with_suffix("")) for path in DOCS.rglob("*.md"))
FEW = ("index", "gallery", "how-to/moveit", "reference/library", "explanation/comparison")


class Quiet(http.server.SimpleHTTPRequestHandler):
    def log_message(self, *_: Any) -> None:
        """Nothing."""


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[str, Any]]:
    """Where the site is served, and a browser; IKGEN_SITE names the folder of one that was just built."""
    pytest.importorskip("mkdocs")
    with browser() as opened:
        made = os.environ.get("IKGEN_SITE")
        folder = made or str(tmp_path_factory.mktemp("site"))
        if not made:
            command = [sys.executable, "-m", "mkdocs", "build", "--quiet", "--site-dir", folder]
            subprocess.run(command, cwd=ROOT, check=True, capture_output=True)
        handler = functools.partial(Quiet, directory=folder)
        with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
            threading.Thread(target=server.serve_forever, daemon=True).start()
            yield f"http://127.0.0.1:{server.server_port}", opened
            server.shutdown()


@pytest.mark.parametrize(
    "page", [pytest.param(p, marks=() if p in FEW else pytest.mark.long) for p in PAGES]
)
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_page(page: str, scheme: str, site: tuple[str, Any]) -> None:
    """`python -m pytest -m long tests/docs/test_site.py` looks at all of them."""
    address, opened = site
    place = page.removesuffix("index")
    seen = look_at(opened, f"{address}/{place.rstrip('/')}" + "/" * bool(place), 390, scheme)
    assert (seen.sticks_out, seen.messages, seen.faults) == ((), (), ())
