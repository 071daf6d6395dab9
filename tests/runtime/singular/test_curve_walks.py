"""Walks along curves from several starts: each curve is followed once, and no other is taken for it."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.cpp_modules import solver_module as published_module
from tests.support.small_robots import write_robot
from tests.support.solving import import_text

from ikgen.derivation.derive import derive
from ikgen.emit.python.python_emitter import emit_module
from ikgen.records.request import Request
from ikgen.runtime.python.arm.chain_kinematics import forward
from ikgen.runtime.python.arrays.angles import WHOLE_TURN
from ikgen.runtime.python.rows.solution_rows import pairs_within
from ikgen.runtime.python.singular import curve_walks
from ikgen.runtime.python.singular.curve_walks import _united, walked
from ikgen.runtime.python.singular.fold_pair import Reduced
from ikgen.runtime.python.singular.near_continuum import LEAST, followed

Array = NDArray[np.float64]
STEP = np.pi / 8
AT = np.array([0.2, -0.9, 1.1, 0.3, 0.0, -0.4])
TURN = np.eye(6)[3] - np.eye(6)[5]
"""Joint 6 goes back as joint 4 goes on: all around, at AT."""
TURNS = (WHOLE_TURN, WHOLE_TURN)
POLICY = SimpleNamespace(arrived=0.5e-9, try_step=STEP, fold_reach=10.0)
PLANE: Any = SimpleNamespace(moving=(0, 1), policy=POLICY, period=TURNS, placing=TURNS)


@pytest.fixture(scope="module")
def arm(tmp_path_factory: pytest.TempPathFactory) -> Any:
    text = emit_module(published_module("kuka_kr6r900sixx"))
    return import_text(text, tmp_path_factory.mktemp("arm"))._ARM


@pytest.mark.parametrize(
    "ways", [[0.0], [0.0, 0.2], [0.0, 2.0], [0.0, 3.0, -1.5], [0.0, 2 * np.pi]]
)
def test_a_curve_is_passed_once_wherever_its_starts_lie(arm: Any, ways: list[float]) -> None:
    q = AT + np.outer(ways, TURN)
    T = np.repeat(forward(arm.chain, AT)[None], len(q), axis=0)
    parts, ends, same, worst, steps = followed(arm, q, T)
    assert not same.any() and not parts.owner.any() and not len(ends.owner)
    assert worst.max() < 1e-12 and len(parts.owner) - len(q) <= steps[0] <= len(parts.owner)
    low, high = np.sort([parts.a.q[:, 3], parts.b.q[:, 3]], axis=0)
    length = high - low
    assert length.max() < 1.1 * STEP and length.sum() < 2 * np.pi + (1 + len(q)) * STEP
    for turned in np.linspace(0.0, 2 * np.pi, 101):  # each place is in some part
        assert (np.mod(turned - low, 2 * np.pi) <= length + 1e-9).any()
    assert np.abs(np.diff(parts.a.left)).max() < 1e-12


def test_curves_of_several_poses_and_branches_stay_apart(arm: Any) -> None:
    other = AT + 0.7 * np.eye(6)[1]
    q = np.array([AT, other, AT + 2.0 * TURN, other - TURN])
    curves = followed(arm, q, forward(arm.chain, q)[[0, 1, 0, 1]])
    assert curves.same.tolist() == [0, 1, 0, 1]
    counts = np.bincount(curves.parts.owner, minlength=4)
    assert counts[2:].tolist() == [0, 0] and (counts[:2] >= 16).all()


def lines(apart: float) -> Any:
    """Curves beside each other: the first joint turns, the second is a multiple of `apart`."""

    def sampled(arm: Any, at: Reduced, T: Array) -> tuple[Reduced, Array, Array]:
        q = at.q.copy()
        q[:, 1] = apart * np.round(q[:, 1] / apart)
        still = np.sign(at.still[:, :1]) * np.array([[1.0, 0.0]])
        every = np.ones(len(T), dtype=bool)
        return at._replace(q=q, still=still), every, every

    return sampled


def samples(*places: tuple[float, float]) -> Reduced:
    q, none = np.array(places), np.zeros(len(places))
    return Reduced(q, np.tile([1.0, 0.0], (len(q), 1)), np.ones((len(q), 1)), none, none)


@pytest.mark.parametrize("apart", [1e-4, 0.02, 0.05])
def test_a_curve_beside_another_is_passed_too(
    apart: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(curve_walks, "sampled", lines(apart))
    first = samples((0.1, 0.0), (1.4, apart), (2.9, 0.0), (4.0, -apart))
    parts, _, same, *_ = walked(PLANE, first, np.zeros((4, 4, 4)), np.zeros(4, dtype=np.intp))
    assert same.tolist() == [0, 1, 0, 3]
    length = np.abs(parts.b.q[:, 0] - parts.a.q[:, 0])
    for owner in (0, 1, 3):
        assert np.ptp(parts.a.q[parts.owner == owner, 1]) < 1e-12
        assert length[parts.owner == owner].sum() > 2 * np.pi - 1e-9


def test_a_walk_that_began_beside_its_curve_goes_round_once(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(curve_walks, "sampled", lines(0.5))
    parts, *_ = walked(PLANE, samples((0.0, 0.2)), np.zeros((1, 4, 4)), np.zeros(1, dtype=np.intp))
    assert 16 <= len(parts.owner) < 45


def test_no_curve_is_where_nothing_is_near_one(tmp_path: Path) -> None:
    """Positions beyond reach, on the axis about which all turns but for 1e-8: samples go on there, led by
    the little that is left, and none is of a curve."""
    request = Request(write_robot(tmp_path / "elbow.urdf"), task="position")
    arm = import_text(emit_module(derive(request).module), tmp_path)._ARM
    q = np.array([[-1.0, -2e-8, -np.pi / 2], [2.1, 2e-8, -np.pi / 2]])
    T = forward(arm.chain, q)
    T[:, 2, 3] += 0.02
    curves = followed(arm, q, T)
    assert np.bincount(curves.parts.owner).min() >= LEAST > curves.steps.max()
    assert followed(arm, q, forward(arm.chain, q)).steps.min() >= 8


def test_pairs_are_those_of_one_group() -> None:
    group = np.array([4, 1, 4, 2, 1, 4])
    found = set(zip(*(x.tolist() for x in pairs_within(group)), strict=True))
    assert found == {(0, 2), (0, 5), (2, 5), (1, 4)}
    assert not len(pairs_within(np.array([], dtype=np.intp))[0])


def test_what_meets_in_turn_is_one() -> None:
    one, other = np.array([3, 2, 5]), np.array([4, 3, 0])
    assert _united(np.arange(6), one, other).tolist() == [0, 1, 2, 2, 2, 0]
