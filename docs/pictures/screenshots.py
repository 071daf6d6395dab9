"""Takes the pictures of reports, a map, the viewer and the documentation's home page beside this file:

    python docs/pictures/screenshots.py [FOLDER]

in a browser, light and dark. Needs the extras `view` and `docs`, and Playwright, Pillow and Chromium.
"""

from __future__ import annotations

import functools
import http.server
import shutil
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import Any

from ikgen.derivation.derive import derive
from ikgen.processes.executors import Workers
from ikgen.reach.map_files import MapOrder, write_map
from ikgen.records.request import Request
from ikgen.report import emit_report
from ikgen.report.worked_example import solver_of
from ikgen.view.arm_scene import ArmScene, open_server

__all__ = ["REPORTS", "main"]

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
FIXTURES = ROOT / "urdf_fixtures"
UR5E = Request(FIXTURES / "ur5e.urdf", tip="tool0")
REPORTS = {
    "puma560": Request(FIXTURES / "puma560_paper.toml"),
    "ur5e": UR5E,
    "franka_fr3": Request(FIXTURES / "franka_fr3.urdf"),
    "fanuc_crx10ia": Request(FIXTURES / "fanuc_crx10ia.urdf"),
}
"""Name -> the arm whose report is taken."""

_COLOURS = 96
_PATIENCE = 200_000
"""Milliseconds that a scene may take to be drawn without a graphics processor."""
_LIGHT_AND_DARK = (("light", ""), ("dark", "_dark"))


class Camera:
    """Takes pages as small PNG files into a folder."""

    def __init__(self, browser: Any, folder: Path) -> None:
        self.browser, self.folder = browser, folder

    def take(
        self, address: str, name: str, height: int, scheme: str = "light", *, wait: str = ""
    ) -> None:
        """One picture of the top of a page; `wait` is a text that it must show first."""
        page = self.browser.new_page(
            viewport={"width": 1250, "height": height}, color_scheme=scheme
        )
        page.goto(address)
        if wait:
            page.get_by_text(wait).first.wait_for(timeout=60_000)
            page.add_style_tag(content=".mantine-Notification-root { display: none }")
            page.wait_for_timeout(4000)
        self.save(_at_rest(page), name)
        page.close()

    def save(self, image: bytes, name: str) -> None:
        """The image with few colours."""
        from PIL import Image

        with Image.open(BytesIO(image)) as picture:
            few = picture.convert("RGB").quantize(_COLOURS, dither=Image.Dither.NONE)
            few.save(self.folder / f"{name}.png", optimize=True)

    def both(self, address: str, name: str, height: int) -> None:
        """Light and dark."""
        for scheme, ending in _LIGHT_AND_DARK:
            self.take(address, f"{name}{ending}", height, scheme)


def _at_rest(page: Any) -> bytes:
    """The picture that does not change any more: scenes fade in."""
    before, image = b"", page.screenshot(timeout=_PATIENCE)
    for _ in range(12):
        if image == before:
            break
        page.wait_for_timeout(1500)
        before, image = image, page.screenshot(timeout=_PATIENCE)
    return bytes(image)


class _Quiet(http.server.SimpleHTTPRequestHandler):
    """Says nothing of requests."""

    def log_message(self, *_: Any) -> None:
        """Nothing."""


@contextmanager
def served(folder: Path) -> Iterator[str]:
    """The address of a folder's pages."""
    handler = functools.partial(_Quiet, directory=str(folder))
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}"
        server.shutdown()


def reports(camera: Camera, work: Path) -> None:
    """The tops of the reports."""
    for name, request in REPORTS.items():
        texts = emit_report(derive(request))
        page = work / f"{name}.html"
        page.write_text(next(t for n, t in texts.items() if n.endswith(".html")), "utf-8")
        camera.both(page.as_uri(), f"report_{name}", 1400)


def reach(camera: Camera, work: Path) -> None:
    """The page of a map."""
    order = MapOrder(40, 24, 1, Workers(), False, "ikgen reach ur5e.urdf --tip tool0")
    _, files = write_map(UR5E, order, work)
    page = next(path for path in files if path.suffix == ".html")
    camera.both(page.as_uri(), "reach_ur5e", 1000)


def view(camera: Camera, work: Path) -> None:
    """The viewer: solutions, and a robot with meshes, a path and a map."""
    for name, (request, prepare) in VIEWED.items():
        derivation = derive(request)
        solver = solver_of(derivation)
        assert solver is not None
        server = open_server(0)
        scene = ArmScene(server, derivation, solver)
        prepare(scene)
        address = f"http://127.0.0.1:{server.get_port()}"
        camera.take(address, name, 750, wait="solutions inside the limits")
        server.stop()


def _with_path_and_map(scene: ArmScene) -> None:
    """A path that leaves the reach, followed, and what is reached behind the arm."""
    scene.choose(5)
    scene.path_panel.mark(scene.pose)
    for way in ((0.0, -0.3, -0.3), (0.3, 0.35, 0.45)):
        mark = scene.pose
        mark[:3, 3] += way
        scene.path_panel.mark(mark)
    scene.path_panel.follow()
    scene.reach_panel.show(from_y=0.2)


def site(camera: Camera, work: Path) -> None:
    """The home page and the gallery."""
    command = ["mkdocs", "build", "--quiet", "--site-dir", str(work / "site")]
    subprocess.run(command, cwd=ROOT, check=True)
    with served(work / "site") as address:
        camera.both(f"{address}/index.html", "home", 1000)
        camera.take(f"{address}/gallery/index.html", "gallery", 1000)


VIEWED: dict[str, tuple[Request, Callable[[ArmScene], None]]] = {
    "view_ur5e": (UR5E, lambda scene: None),
    "view_panda": (Request(Path("example-robot-data:panda")), _with_path_and_map),
}
"""Name -> the arm that is viewed, and what is done in its scene first."""
TAKEN = {"reports": reports, "reach": reach, "view": view, "site": site}


def main(arguments: list[str]) -> None:
    """All of them, or those named after the folder."""
    from playwright.sync_api import sync_playwright

    chromium = shutil.which("chromium") or shutil.which("google-chrome")
    if chromium is None:
        raise SystemExit("no chromium on PATH: apt-get install chromium")
    folder = Path(arguments[0]) if arguments else HERE
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as work, sync_playwright() as playwright:
        options = ["--no-sandbox", "--enable-unsafe-swiftshader"]
        browser = playwright.chromium.launch(executable_path=chromium, args=options)
        for name in arguments[1:] or TAKEN:
            TAKEN[name](Camera(browser, folder), Path(work))
        browser.close()


if __name__ == "__main__":
    main(sys.argv[1:])
