"""The gallery's page and drawings are those that were recorded."""

from __future__ import annotations

from pathlib import Path

from benchmarks.gallery import ROBOTS
from benchmarks.gallery_page import PAGE, PICTURES, page, with_reports
from benchmarks.results import read_result


def test_the_page_is_what_was_recorded() -> None:
    text = page(read_result("gallery"))
    assert PAGE.read_text(encoding="utf-8") == text, "run python -m benchmarks.gallery --page"


def test_fifty_robots_each_with_its_drawing() -> None:
    found = read_result("gallery").found["robots"]
    assert [robot["name"] for robot in found] == list(ROBOTS) and len(set(ROBOTS)) == 50
    assert {path.stem for path in PICTURES.glob("*.svg")} == set(ROBOTS)
    for robot in found:
        assert 0 < robot["mean"] <= robot["most"] and robot["microseconds"] > 0


def test_reports_are_linked_where_they_are_written(tmp_path: Path) -> None:
    built = tmp_path / "gallery/index.html"
    built.parent.mkdir()
    built.write_text('<a hidden href="reports/a.html">A</a><a hidden href="reports/b.html">B</a>')
    with_reports(tmp_path, {"a": "<p>"})
    assert built.read_text() == (
        '<a href="reports/a.html">A</a><a hidden href="reports/b.html">B</a>'
    )
    assert (built.parent / "reports/a.html").read_text() == "<p>"
