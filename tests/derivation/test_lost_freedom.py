"""Joints that are not independent are named, with what their axes have in common."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.support.dh_files import dh_file

from ikgen.derivation.inspection import inspect_robot
from ikgen.derivation.lost_freedom import lost_freedom
from ikgen.derivation.read import read
from ikgen.records.request import Request

Row = tuple[str, str, float, float, float]
R, P = "revolute", "prismatic"
PARALLEL: list[Row] = [
    (R, "0", 0, 0, 0.3), (R, "pi/2", 0.1, 0, 0), (R, "0", 0.4, 0, 0), (R, "0", 0.3, 0, 0.1),
    (R, "0", 0.2, 0, 0), (R, "pi/2", 0.1, 0, 0.1),
]  # fmt: skip
ONE_POINT: list[Row] = [
    (R, "0", 0, 0, 0.3), (R, "pi/2", 0.3, 0, 0), (R, "pi/2", 0, 0, 0), (R, "pi/2", 0, 0, 0),
    (R, "-pi/2", 0, 0, 0), (R, "pi/2", 0.2, 0, 0.1),
]  # fmt: skip
WRIST: list[Row] = [(R, "pi/2", 0.1, 0, 0.3), (R, "pi/2", 0.2, 0, 0), (R, "pi/2", 0.1, 0, 0.1)]
IN_A_PLANE: list[Row] = [(P, "0", 0, 0, 0), (P, "pi/2", 0, 0, 0), (P, "0.7", 0.1, 0, 0), *WRIST]
MIXED: list[Row] = [
    (P, "0", 0, 0, 0), (P, "pi/2", 0, 0, 0), (R, "pi/2", 0.1, 0, 0), (R, "0", 0.3, 0, 0),
    (R, "pi/2", 0.2, 0, 0.1), (R, "pi/2", 0.1, 0, 0.1),
]  # fmt: skip
"""Two slides turn with nothing and the axes behind them are across of one of them alone."""


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        (PARALLEL, "'theta_2', 'theta_3', 'theta_4' and 'theta_5' move the tip in 3 ways only, as they "
         "turn about parallel axes"),
        (ONE_POINT, "'theta_2', 'theta_3', 'theta_4' and 'theta_5' move the tip in 3 ways only, as they "
         "turn about axes through one point"),
        (IN_A_PLANE, "'d_1', 'd_2' and 'd_3' move the tip in 2 ways only, as they slide in one plane"),
        ([*PARALLEL[:4], *WRIST[:2]], ""),
        (MIXED, ""),
    ],
)  # fmt: skip
def test_what_the_axes_have_in_common_is_said(rows: list[Row], words: str, tmp_path: Path) -> None:
    request = Request(dh_file(tmp_path / "arm.toml", rows))
    said = lost_freedom(read(request), ())
    assert said.startswith(f"joints {words}: a pose has infinitely many") if words else not said
    shown = [x for x in inspect_robot(request, advice=False).warnings if "infinitely many" in x]
    assert shown == [said] * bool(words)


def test_nothing_is_said_where_one_of_them_is_held(tmp_path: Path) -> None:
    request = Request(dh_file(tmp_path / "arm.toml", PARALLEL), free={"theta_3": None})
    reading = read(request)
    assert lost_freedom(reading, ("theta_1",)) and not lost_freedom(reading, ("theta_3",))


def test_a_warning_of_the_file_says_it_already(tmp_path: Path) -> None:
    rows = [(R, "0", 0, 0, 0.3), (R, "0", 0, 0, 0.1), *WRIST, (R, "pi/2", 0.1, 0, 0)]
    reading = read(Request(dh_file(tmp_path / "arm.toml", rows)))
    assert any("turn about one line" in x for x in reading.source.warnings)
    assert lost_freedom(reading, ()) == ""
