"""Mimic joints whose driver has another period than whole turns."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
from tests.support.coupled_arms import crank_robot
from tests.support.small_robots import write_robot
from tests.support.solving import NO_COMPILER, import_text

from ikgen.derivation.derive import derive
from ikgen.derivation.read import read
from ikgen.emit.python.python_emitter import emit_module
from ikgen.errors import UnsolvedChainError
from ikgen.generation.generate import generate
from ikgen.kinematics.whole_turns import (
    check_couplings,
    middle_of,
    most_parts,
    period_of,
    range_of,
)
from ikgen.model.dh import DHChain
from ikgen.records.request import Outputs, Request


def round_elbow(robot: Path) -> None:
    """Turns the elbow's axis as a rounded angle does: it is not quite parallel to the shoulder's."""
    head, tail = robot.read_text().split('<joint name="elbow"')
    tail = tail.replace('rpy="0 0 0"', 'rpy="1e-4 0 2e-4"', 1)
    robot.write_text(f'{head}<joint name="elbow"{tail}')


LIMITS = (-5.0, 7.0)  # of the crank: nearly two turns, a waist at half its value takes one
ENDS = {"base": "base_link", "tip": "tool0", "task": "position"}


def request(robot: Path) -> Request:
    return Request(robot, **ENDS)


def test_a_crank_of_two_turns_has_every_row_once(tmp_path: Path) -> None:
    made = derive(request(crank_robot(tmp_path, 0.5, LIMITS)))
    arm = import_text(emit_module(made.module), tmp_path)
    plain = derive(request(write_robot(tmp_path / "plain.urdf")))
    free = import_text(emit_module(plain.module), tmp_path)
    rng = np.random.default_rng(3)
    q = np.column_stack([rng.uniform(*LIMITS, 60), rng.uniform(-2.5, 2.5, (60, 2))])
    poses = np.array([arm.forward(row) for row in q])
    batch, counts, _ = arm.solve_batch(poses)
    several = 0
    for pose, start, rows, count in zip(poses, q, batch, counts, strict=True):
        found = arm.solve(pose)
        for row in found:
            assert np.allclose(arm.forward(row)[:3, 3], pose[:3, 3], atol=1e-9)
            assert LIMITS[0] <= row[0] <= LIMITS[1]
        assert np.min(np.abs(found.q - start).max(axis=1)) < 1e-6
        near = arm.solve(pose, seed=start + 0.01).q[0]
        assert np.abs(near - start).max() < 1e-6
        expected = set()
        for waist, *rest in free.solve(pose, limits=False).q:
            for crank in 2.0 * (waist + 2.0 * np.pi * np.arange(-2, 3)):
                if LIMITS[0] <= crank <= LIMITS[1] and np.abs(rest).max() <= 2.5:
                    expected.add(tuple(np.round([crank, *rest], 6) + 0.0))
        assert {tuple(np.round(row, 6) + 0.0) for row in found.q} == expected
        assert {tuple(np.round(row, 6) + 0.0) for row in rows[:count]} == expected
        several += len(expected) > 1
    assert several > 10


@pytest.mark.parametrize(
    ("ratio", "limits", "rounded"),
    [(2.0, (-3.0, 5.0), False), (0.5, (-7.0, 13.0), True), (-3.0, (1.0, 4.0), True)],
)
def test_limits_beyond_one_period_have_each_row_once(
    tmp_path: Path, ratio: float, limits: tuple[float, float], rounded: bool
) -> None:
    """The one on the turn that is nearest to the seed, or inside the limits; also without limits."""
    robot = crank_robot(tmp_path, ratio, limits)
    if rounded:
        round_elbow(robot)
    made = derive(request(robot))
    assert made.module.rounded is rounded
    arm, turn = import_text(emit_module(made.module), tmp_path), 2.0 * np.pi
    rng, period = np.random.default_rng(8), [turn / abs(ratio), turn, turn]
    starts = np.column_stack([rng.uniform(*limits, 30), rng.uniform(-2.5, 2.5, (30, 2))])
    for q in starts:
        pose = arm.forward(q)
        inside, anywhere, near = (
            arm.solve(pose, **options).q for options in ({}, {"limits": False}, {"seed": q})
        )
        for rows in (inside, anywhere, near):
            assert np.abs(np.remainder(rows - q + 0.5, period) - 0.5).max(axis=1).min() < 1e-6
            gaps = (rows[:, None] - rows[None]) / period
            assert (np.abs(gaps - np.round(gaps)).max(axis=2) < 1e-6).sum() == len(rows)
        assert ((inside >= arm.LOWER) & (inside <= arm.UPPER)).all()
        assert np.abs(anywhere[:, 0]).max() <= 0.5 * period[0] + 1e-12
        assert np.abs(near[0] - q).max() < 1e-6


@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER)
@pytest.mark.long
@pytest.mark.parametrize(
    ("ratio", "limits", "rounded"),
    [(-0.5, LIMITS, False), (0.5, (-7.0, 13.0), True), (2.0, (2.0, 5.0), False)],
)
def test_a_crank_with_a_period_of_its_own_is_verified_in_both_languages(
    tmp_path: Path, ratio: float, limits: tuple[float, float], rounded: bool
) -> None:
    robot = crank_robot(tmp_path, ratio, limits)
    if rounded:
        round_elbow(robot)
    outputs = Outputs(("python", "cpp"), tmp_path / "out", samples=300)
    made = generate(request(robot), outputs)
    assert sorted(made.reports) == ["cpp", "python"]
    assert all(report.passed for report in made.reports.values())


def test_a_slide_that_turns_a_joint_has_a_period_too(tmp_path: Path) -> None:
    for limits in ((0.0, 1.0), (0.1, 0.5)):
        dh = read(request(crank_robot(tmp_path, 7.0, limits, kind="prismatic"))).dh
        check_couplings(dh)
        assert period_of(dh, 0) == 2.0 * math.pi / 7.0 and middle_of(dh, 0) == 0.0


@pytest.mark.parametrize(
    ("ratios", "period"),
    [
        ((2.0, 3.0), 1.0),
        ((2.0, 4.0), 0.5),
        ((0.5, -0.5), 2.0),
        ((1.0, 0.5), 0.0),
        ((0.5, 0.2), 0.0),
    ],
)
def test_periods_of_several_followers(
    tmp_path: Path, ratios: tuple[float, float], period: float
) -> None:
    """In turns; where what follows comes round together after several turns only, there is none."""
    text = crank_robot(tmp_path, ratios[0], (-1.0, 1.0), followers=("waist", "elbow")).read_text()
    head, tail = text.rsplit(f'multiplier="{ratios[0]!r}"', 1)
    robot = tmp_path / "two.urdf"
    robot.write_text(f'{head}multiplier="{ratios[1]!r}"{tail}')
    dh = read(request(robot)).dh
    assert period_of(dh, 0) == pytest.approx(2.0 * math.pi * period)


def test_ratios_of_no_whole_numbers_are_refused(tmp_path: Path) -> None:
    robot = write_robot(tmp_path / "elbow.urdf")
    text = robot.read_text().replace(
        '<joint name="elbow" type="revolute">',
        '<joint name="elbow" type="revolute"><mimic joint="waist" multiplier="0.700000001"/>',
    )
    robot.write_text(text)
    with pytest.raises(
        UnsolvedChainError,
        match=r"turn in the ratio 0\.700000001 : 1, and closed forms need a ratio",
    ) as caught:
        derive(request(robot))
    assert caught.value.hint.startswith("give --lock waist=VALUE")
    assert "--couple elbow=waist*k with fewer digits" in caught.value.hint
    robot.write_text(text.replace('"elbow" type="revolute"', '"elbow" type="prismatic"'))
    slides = read(request(robot)).dh
    with pytest.raises(UnsolvedChainError, match="one turns and the other slides"):
        check_couplings(slides)


def test_joints_by_themselves_have_a_whole_turn(tmp_path: Path) -> None:
    dh = read(request(write_robot(tmp_path / "elbow.urdf"))).dh
    assert all(period_of(dh, j) == 2.0 * math.pi for j in range(dh.dof))
    check_couplings(dh)


def geared(folder: Path, ratio: str, low: float = -2.5, high: float = 2.5) -> DHChain:
    """The elbow arm whose elbow follows the shoulder, which has these limits."""
    robot = write_robot(folder / "elbow.urdf")
    text = robot.read_text().replace(
        '<joint name="elbow" type="revolute">',
        f'<joint name="elbow" type="revolute"><mimic joint="shoulder" multiplier="{ratio}"/>',
    )
    head, rest = text.split('<joint name="shoulder"')
    rest = re.sub('lower="[^"]*" upper="[^"]*"', f'lower="{low}" upper="{high}"', rest, count=1)
    robot.write_text(f'{head}<joint name="shoulder"{rest}')
    return read(request(robot)).dh


@pytest.mark.parametrize(
    ("ratio", "share", "parts"),
    [("2", 1.0, 2), ("0.5", 0.5, 2), ("0.8", 0.2, 5), ("-1.5", 0.5, 3), ("1.1393", 1e-4, 11393)],
)
def test_the_variable_is_the_share_of_a_turn_of_which_all_rows_turn_multiples(
    tmp_path: Path, ratio: str, share: float, parts: int
) -> None:
    dh = geared(tmp_path, ratio)
    check_couplings(dh)
    assert dh.lead_row(1).scale == pytest.approx(share, rel=1e-12) and most_parts(dh) == parts
    rows = [row for row in dh.rows if row.driver == 1]
    for row in rows:
        turns, shift = dh.follows(row)
        assert turns.is_integer()
        lead = dh.lead_row(1)
        for q in (-1.3, 0.4):
            v = lead.scale * q + lead.offset.value
            assert turns * v + shift == pytest.approx(row.scale * q + row.offset.value, abs=1e-12)


def test_values_are_looked_for_on_the_circle_or_inside_the_limits(tmp_path: Path) -> None:
    circle = (-math.pi, math.pi)
    assert range_of(geared(tmp_path, "2"), 1) == circle
    low, high = np.array(range_of(geared(tmp_path, "0.8", 0.0, 1.0), 1)) / 0.2
    assert (low, high) == pytest.approx((-0.01, 1.01))
    low, high = np.array(range_of(geared(tmp_path, "0.8", -6.0, 6.0), 1)) / 0.2
    assert (low, high) == pytest.approx((-6.01, 6.01))
    alone = read(request(crank_robot(tmp_path, 0.5, LIMITS))).dh
    assert range_of(alone, 0) == circle


@pytest.mark.parametrize("limit", [2.0 * math.pi, 6.2832, 6.28, 20.0])
def test_turns_that_limits_hold_all_of_come_round_together(tmp_path: Path, limit: float) -> None:
    """At both ends of limits that span what comes round the arm is the same."""
    dh = geared(tmp_path, "-1.5", -limit, limit)
    check_couplings(dh)
    turn = 2.0 * math.pi
    assert period_of(dh, 1) == 2.0 * turn and range_of(dh, 1) == (-math.pi, math.pi)
    made = generate(request(tmp_path / "elbow.urdf"), Outputs(out=tmp_path, samples=100))
    assert all(report.passed for report in made.reports.values())
    arm = import_text((tmp_path / "elbow_ik.py").read_text(), tmp_path)
    for value in (-limit, limit, 0.4 - turn, 0.4, 2.1):
        q = np.array([0.3, value])
        rows = arm.solve(arm.forward(q), seed=q).q
        assert np.abs(rows[0] - q).max() < 1e-7
        apart = np.abs(rows[:, None, 1] - rows[None, :, 1]) / (2.0 * turn)
        once = np.abs(apart - np.round(apart)) < 1e-6
        alike = np.abs(np.sin(0.5 * (rows[:, None, 0] - rows[None, :, 0]))) < 1e-6
        assert (once & alike).sum() == len(rows)


def test_what_turns_together_is_named(tmp_path: Path) -> None:
    """Of rows that come round together after more than the limits span, or in no ratio only together."""
    with pytest.raises(UnsolvedChainError) as caught:
        check_couplings(geared(tmp_path, "0.83", -400.0, 400.0))
    assert "'shoulder' and 'elbow' come round together" in caught.value.message
    assert "every 628.319 of 'shoulder', and the limits span 800" in caught.value.message
    text = (tmp_path / "elbow.urdf").read_text().replace("0.83", "0.1234567")
    joint = '<joint name="waist" type="revolute">'
    mimic = f'{joint}<mimic joint="shoulder" multiplier="0.7654321"/>'
    (tmp_path / "elbow.urdf").write_text(
        text.replace(joint, mimic).replace("-400.0", "-2").replace("400.0", "2")
    )
    with pytest.raises(UnsolvedChainError) as caught:
        check_couplings(read(request(tmp_path / "elbow.urdf")).dh)
    assert "'elbow' and 'waist' and 'shoulder' turn in the ratio" in caught.value.message
