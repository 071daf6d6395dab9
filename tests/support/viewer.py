"""A viewer's scene with a server of its own, and hands on its page."""

from __future__ import annotations

import socket
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from tests.support.solving import FIXTURES

from ikgen.derivation.derive import derive
from ikgen.emit.derivation import Derivation
from ikgen.records.request import Request
from ikgen.report.worked_example import solver_of
from ikgen.verify.runners.python_module import PythonModule
from ikgen.view.arm_scene import ArmScene, open_server

__all__ = ["drag_target", "on_page", "served", "viewed"]


@cache
def viewed(name: str) -> tuple[Derivation, PythonModule]:
    """An arm of the fixtures, and its solver."""
    derivation = derive(Request(FIXTURES / f"{name}.urdf"))
    runner = solver_of(derivation)
    assert runner is not None
    return derivation, runner


@contextmanager
def served(derivation: Derivation, runner: PythonModule, **more: Any) -> Iterator[ArmScene]:
    """The scene of an arm."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    server = open_server(port)
    try:
        yield ArmScene(server, derivation, runner, **more)
    finally:
        server.stop()


@contextmanager
def on_page(scene: ArmScene, browser: Any) -> Iterator[tuple[Any, list[str]]]:
    """The scene's page, and the errors that it reports."""
    page = browser.new_page(viewport={"width": 1100, "height": 750})
    wrong: list[str] = []
    page.on("pageerror", lambda error: wrong.append(str(error)))
    page.goto(f"http://127.0.0.1:{scene.server.get_port()}")
    page.get_by_text("solutions inside the limits").wait_for(timeout=60_000)
    yield page, wrong
    page.close()


def drag_target(page: Any, scene: ArmScene, axis: int, way: float) -> None:
    """Take the arrow of the target along one of its axes (0 to 2) by `way`, in lengths of the arrow, with
    the mouse; once more where the page was not drawn yet, and the mouse took the camera."""
    before = scene.pose
    arrow = 0.25 * scene.size * before[:3, axis]
    for wait in (400, 1500, 4000):
        start = _pixel(page, scene, before[:3, 3] + 0.6 * arrow)
        end = _pixel(page, scene, before[:3, 3] + (0.6 + way) * arrow)
        page.mouse.move(*start)
        page.wait_for_timeout(wait)
        page.mouse.down()
        page.mouse.move(*end, steps=6)
        page.wait_for_timeout(wait)
        page.mouse.up()
        page.wait_for_timeout(wait)
        if not np.array_equal(scene.pose, before):
            return


def _pixel(page: Any, scene: ArmScene, point: NDArray[np.float64]) -> tuple[float, float]:
    """Where a point (3,) is seen: a pinhole camera that stands upright."""
    (client,) = scene.server.get_clients().values()
    camera, size = client.camera, page.viewport_size
    eye = np.asarray(camera.position)
    forward = np.asarray(camera.look_at) - eye
    forward = forward / np.linalg.norm(forward)
    right = np.cross(forward, [0.0, 0.0, 1.0])
    right = right / np.linalg.norm(right)
    seen = point - eye
    scale = size["height"] / 2 / np.tan(camera.fov / 2) / (seen @ forward)
    up = np.cross(right, forward)
    return size["width"] / 2 + scale * seen @ right, size["height"] / 2 - scale * seen @ up
