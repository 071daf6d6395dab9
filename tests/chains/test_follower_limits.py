"""Joints that follow others out of their own limits are named, and where they stay inside."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.support.small_robots import elbow_robot

from ikgen.derivation.read import read
from ikgen.records.request import Request


def said(folder: Path, *, multiplier: str, own: str, driver: str = 'lower="-1" upper="2"') -> str:
    """Of an arm whose elbow follows its waist."""
    text = elbow_robot("geared")
    for name, limits in (("waist", driver), ("elbow", own)):
        head, rest = text.split(f'<joint name="{name}" type="revolute">')
        joint, rest = rest.split("</joint>", 1)
        joint = joint.partition("<limit")[0] + f'<limit {limits} effort="1" velocity="1"/>'
        mimic = f'<mimic joint="waist" multiplier="{multiplier}" offset="0.1"/>' * (name == "elbow")
        text = f'{head}<joint name="{name}" type="revolute">{joint}{mimic}</joint>{rest}'
    path = folder / "geared.urdf"
    path.write_text(text)
    return "\n".join(read(Request(path)).source.warnings)


def test_a_follower_that_leaves_its_limits_is_named(tmp_path: Path) -> None:
    text = said(tmp_path, multiplier="-0.5", own='lower="-0.4" upper="1"')
    assert (
        "joint 'elbow' follows 'waist' from -0.9 to 0.6: its own limits, -0.4 and 1, are not"
        in text
    )
    assert text.endswith("and hold while 'waist' is from -1 to 1")


def test_nothing_is_said_to_be_less_than_nothing(tmp_path: Path) -> None:
    text = said(tmp_path, multiplier="-1", own='lower="0.1" upper="0.9"')
    assert text.endswith("and hold while 'waist' is from -0.8 to 0")


def test_where_no_value_is_inside_both_none_is_given(tmp_path: Path) -> None:
    text = said(tmp_path, multiplier="-0.5", own='lower="2" upper="3"')
    assert text.endswith("its own limits, 2 and 3, are not looked at")


@pytest.mark.parametrize(
    "limits",
    [
        {"own": 'lower="-0.9" upper="0.6"'},
        {"own": 'lower="-0.88" upper="0.59"'},  # but for rounding
        {"own": 'lower="0" upper="0"'},  # stands for none
    ],
)
def test_inside_or_without_limits_nothing_is_said(tmp_path: Path, limits: dict[str, str]) -> None:
    assert "follows" not in said(tmp_path, multiplier="-0.5", **limits)
