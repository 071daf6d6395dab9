"""Pages in a real browser: how fast they open, what sticks out, what it complains of, what axe-core finds.

Needs Playwright with Chromium on PATH; axe-core comes with the package axe-playwright-python.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import pytest

__all__ = ["Seen", "browser", "look_at"]

_SERIOUS = ("serious", "critical")
_STICKS_OUT = """() => {
  const right = document.documentElement.clientWidth + 1;
  const inside = (e) => {
    for (let p = e.parentElement; p && p !== document.body; p = p.parentElement)
      if (getComputedStyle(p).overflowX !== "visible") return true;
    return false;
  };
  return [...document.querySelectorAll("body *")]
    .filter((e) => e.getBoundingClientRect().right > right && !inside(e))
    .map((e) => e.outerHTML.slice(0, 120));
}"""
_RUN = "axe.run({resultTypes: ['violations'], runOnly: ['wcag2a', 'wcag2aa', 'best-practice']})"


@dataclass(frozen=True, slots=True)
class Seen:
    """`seconds` of processor time until the page was loaded, what `sticks_out` to the right, `messages`
    of the console, and what axe-core calls serious (`faults`)."""

    seconds: float
    sticks_out: tuple[str, ...]
    messages: tuple[str, ...]
    faults: tuple[str, ...]


@contextmanager
def browser() -> Iterator[Any]:
    """Chromium by Playwright; the test is skipped where one of them lacks."""
    api = pytest.importorskip("playwright.sync_api")
    chromium = shutil.which("chromium")
    if chromium is None:
        pytest.skip("no chromium here")
    with api.sync_playwright() as playwright:
        options = ["--no-sandbox", "--enable-unsafe-swiftshader"]
        opened = playwright.chromium.launch(executable_path=chromium, args=options)
        yield opened
        opened.close()


def look_at(opened: Any, address: str, width: int, scheme: str) -> Seen:
    """What there is to say of a page in a window of the width (px), light or dark."""
    context = opened.new_context(viewport={"width": width, "height": 844}, color_scheme=scheme)
    page = context.new_page()
    messages: list[str] = []
    page.on("pageerror", lambda error: messages.append(str(error)))
    page.on("console", lambda said: messages.append(said.text) if said.type == "error" else None)
    session = context.new_cdp_session(page)
    session.send("Performance.enable", {"timeDomain": "threadTicks"})
    page.goto(address)
    metrics = session.send("Performance.getMetrics")["metrics"]
    seconds = next(m["value"] for m in metrics if m["name"] == "TaskDuration")
    out = page.evaluate(_STICKS_OUT)
    page.evaluate(_axe())
    found = page.evaluate(_RUN)["violations"]
    context.close()
    faults = [
        f"{fault['impact']} {fault['id']}: {node['html'][:160]}"
        for fault in found
        if fault["impact"] in _SERIOUS
        for node in fault["nodes"]
    ]
    return Seen(seconds, tuple(out), tuple(messages), tuple(faults))


def _axe() -> str:
    spec = find_spec("axe_playwright_python")
    if spec is None or spec.origin is None:
        pytest.skip("no axe-core here: pip install axe-playwright-python")
    return Path(spec.origin).with_name("axe.min.js").read_text(encoding="utf-8")
