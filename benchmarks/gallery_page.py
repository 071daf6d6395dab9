"""The page of the gallery, from what was recorded of its robots."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from html import escape
from pathlib import Path
from typing import Any

from benchmarks.results import Measured

__all__ = ["PAGE", "PICTURES", "page", "with_reports"]

DOCS = Path(__file__).resolve().parents[1] / "docs"
PAGE = DOCS / "gallery.md"
PICTURES = DOCS / "pictures" / "gallery"

_HEAD = """---
hide: [navigation, toc]
---

# Gallery

<!-- page not run: python -m benchmarks.gallery has run each command before it wrote it here -->

{count} robots as ikgen reads them: the class of the geometry, how many solutions a pose has, which joint
is held where there are more joints than the task fixes, the time to derive the solver, and that of the
emitted Python module in batches, for all solutions of a pose. The drawings are made from the joint tree
alone. Names lead to the descriptions, which are others' files; the command below each writes its report.

"""
_TAIL = """
Measured by `{command} --record` at `{commit}` on {date}; times are those of a processor core.
"""


def page(measured: Measured) -> str:
    """The text of `docs/gallery.md`."""
    robots = measured.found["robots"]
    cards = "\n".join(_card(robot) for robot in robots)
    tail = _TAIL.format(command=measured.command, commit=measured.commit, date=measured.date)
    return f'{_HEAD.format(count=len(robots))}<div class="gallery" markdown>\n\n{cards}\n</div>\n{tail}'


def _card(robot: Mapping[str, Any]) -> str:
    name, title = robot["name"], escape(robot["name"].replace("_", " "))
    held = f"; {', '.join(robot['held'])} held" if robot["held"] else ""
    task = "" if robot["task"] == "pose" else f"; task {robot['task']}"
    command = (
        f"ikgen report {shlex.quote(robot['file'])} --base {robot['base']} --tip {robot['tip']}"
    )
    facts = (
        f"{robot['joints']} joints{held}{task}",
        f"at most {robot['most']} solutions a pose, {robot['mean']:.1f} on average",
        f"{robot['seconds']:.1f} s to derive, {_time(robot['microseconds'])} a pose",
    )
    lines = [
        "<div markdown>\n",
        f"![{title} as a skeleton](pictures/gallery/{name}.svg)\n",
        f"## [{title}]({robot['source']})\n",
        f"{escape(robot['family'])}\n",
        *(f"- {escape(fact)}" for fact in facts),
        f'\n<a hidden href="reports/{name}.html">Report</a>\n',
        f"```sh\n{command}\n```\n",
        "</div>\n",
    ]
    return "\n".join(lines)


def _time(microseconds: float) -> str:
    return f"{microseconds:g} µs" if microseconds < 1000 else f"{microseconds / 1000:g} ms"


def with_reports(site: Path, texts: Mapping[str, str]) -> None:
    """Write the reports (name -> text) into a built site, and show the links to them."""
    built = site / "gallery" / "index.html"
    text = built.read_text(encoding="utf-8")
    (built.parent / "reports").mkdir(exist_ok=True)
    for name, report in texts.items():
        (built.parent / "reports" / f"{name}.html").write_text(report, encoding="utf-8")
        text = text.replace(
            f'<a hidden href="reports/{name}.html"', f'<a href="reports/{name}.html"'
        )
    built.write_text(text, encoding="utf-8")
