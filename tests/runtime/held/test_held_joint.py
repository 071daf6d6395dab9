"""Rows at many values of what is held."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from tests.support.held_arms import held_limits, imported

from ikgen.runtime.python.arrays.angles import WHOLE_TURN
from ikgen.runtime.python.held import held_joint
from ikgen.runtime.python.held.held_joint import HeldJoint, held_range


@pytest.mark.parametrize(
    ("name", "guards"), [("shoulder_elbow_wrist", True), ("rounded_arm_angle", False)]
)
def test_many_values_give_what_a_few_at_a_time_give(
    name: str, guards: bool, tmp_path: Path
) -> None:
    """More than the closed form takes at once."""
    arm = imported(name, tmp_path)
    T = arm.forward(np.array([0.3, 0.5, -0.4, 1.1, 0.2, 0.8, -0.3]))
    held = np.linspace(*held_limits(arm), 2500)
    whole = arm._rows_at(arm._HELD, T, held)
    parts = [arm._rows_at(arm._HELD, T, held[k : k + 500]) for k in range(0, len(held), 500)]
    real = np.concatenate([part.real for part in parts])
    folds = np.concatenate([part.folds for part in parts])
    assert np.isfinite(folds).any() == guards
    np.testing.assert_array_equal(whole.real, real)
    np.testing.assert_array_equal(whole.folds, folds)
    rows = np.concatenate([part.q for part in parts])
    np.testing.assert_allclose(whole.q[real], rows[real], atol=1e-11)
    assert real.any(axis=1).mean() > 0.3


@pytest.mark.parametrize("guarded", [True, False])
@pytest.mark.parametrize("rounded", [True, False])
def test_margins_tell_where_all_is_guarded_and_nothing_rounded(
    guarded: bool, rounded: bool
) -> None:
    arm: Any = SimpleNamespace(rounded=rounded)
    joint = HeldJoint(arm, no_branches, guarded)
    assert joint.margins_tell is (guarded and not rounded)


def no_branches(*_: Any) -> Any:
    raise AssertionError


def test_no_more_rows_are_taken_than_solve_gives(monkeypatch: pytest.MonkeyPatch) -> None:
    real = np.array(
        [[True] * 4, [False, True, True, True], [False] * 4, [True, False, True, False]]
    )
    q = np.zeros((4, 4, 1))
    monkeypatch.setattr(held_joint, "careful_rows", lambda *_: (q, real, real[:, 0]))
    for most in (1, 2, 3, 4):
        arm: Any = SimpleNamespace(together=None, most=most)
        _, taken = held_joint._all_rows(arm, np.zeros((4, 4, 4)), np.zeros((4, 1)))
        for found, there in zip(taken, real, strict=True):
            assert np.flatnonzero(found).tolist() == np.flatnonzero(there)[:most].tolist()


def test_a_slide_counts_as_far_as_the_lengths_reach() -> None:
    chain = SimpleNamespace(frames=np.tile(np.eye(4), (3, 1, 1)))
    chain.frames[1:, 0, 3] = 0.5, 0.25
    T = np.eye(4)
    T[2, 3] = -2.0
    ends = (-np.inf, -0.4, -1.0), (np.inf, 0.3, 1.0)
    arm: Any = SimpleNamespace(
        free=(0,), lower=ends[0], upper=ends[1], chain=chain, period=(0.0, 0.0, WHOLE_TURN)
    )
    assert held_range(arm, T, True) == pytest.approx((-3.15, 3.15))
    arm.free = (1,)
    assert held_range(arm, T, True) == held_range(arm, T, False) == (-0.4, 0.3)
    arm.free = (2,)
    assert held_range(arm, T, True) == (-1.0, 1.0)
    assert held_range(arm, T, False) == (-np.pi, np.pi)
    arm.free = ()
    assert held_range(arm, T, True) == (-np.pi, np.pi)
