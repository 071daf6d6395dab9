"""Every report opens at once, fits a phone, is quiet, and has nothing that axe-core calls serious."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from tests.support.browser import browser, look_at
from tests.support.sampled import sampled

from ikgen.derivation.derive import derive
from ikgen.errors import UnsolvedChainError
from ikgen.projects.new_config import robot_arms
from ikgen.records.request import Request
from ikgen.report import emit_report, emit_unsolved

pytestmark = pytest.mark.usefixtures("solved_once")

ROOT = Path(__file__).resolve().parents[2]
TABLES = sorted((ROOT / "tests/robots/tables").glob("*.toml"))
URDFS = sorted((ROOT / "urdf_fixtures").glob("*.urdf"))
ROBOTS = {path.stem: path for path in (*TABLES, *URDFS)}
"""The tables of the suite, and the URDF files with every arm that they have."""
SCHEMES = ("dark", "light")
FEW = ("Puma_paper light", "franka_fr3 dark")
LARGEST, SLOWEST = 1.5e6, 1.0


@pytest.fixture(scope="module")
def opened() -> Iterator[Any]:
    with browser() as found:
        yield found


def pages(robot: Path) -> Iterator[str]:
    """The text of the report of each of its arms."""
    table = robot.suffix == ".toml"
    ends = [(None, None)] if table else [(arm.base, arm.tip) for arm in robot_arms(Request(robot))]
    for base, tip in ends:
        try:
            texts = emit_report(derive(Request(robot, base=base, tip=tip)))
        except UnsolvedChainError as error:
            texts = emit_unsolved(error.unsolved, error.hint)
        yield next(text for file, text in texts.items() if file.endswith(".html"))


def test_there_are_enough_of_them() -> None:
    assert len(TABLES) >= 34
    assert sum(len(robot_arms(Request(path))) for path in URDFS) >= 10


@pytest.mark.parametrize("case", sampled([f"{n} {s}" for n in ROBOTS for s in SCHEMES], FEW))
def test_report(case: str, opened: Any, tmp_path: Path) -> None:
    """`python -m pytest -m "long or not long" tests/report/test_in_browser.py` looks at all of them."""
    name, scheme = case.split()
    for text in pages(ROBOTS[name]):
        assert len(text.encode()) < LARGEST
        page = tmp_path / "report.html"
        page.write_text(text, encoding="utf-8")
        seen = look_at(opened, page.as_uri(), 390, scheme)
        assert seen.seconds < SLOWEST
        assert (seen.sticks_out, seen.messages, seen.faults) == ((), (), ())
