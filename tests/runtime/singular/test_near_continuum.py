"""Solutions on what is a continuum of the solved geometry and none of the file's."""

from __future__ import annotations

from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.cpp_modules import solver_module as published_module
from tests.support.rounded_arms import FOLDED, meeting_shoulder
from tests.support.solving import emitted, import_text

from ikgen.emit.python.python_emitter import emit_module
from ikgen.kinematics.modified_dh import to_dh
from ikgen.runtime.python.arm.chain_kinematics import forward
from ikgen.runtime.python.arrays.angles import WHOLE_TURN
from ikgen.runtime.python.singular import (
    curve_parts,
    curve_samples,
    curve_walks,
    fold_pair,
    near_continuum,
)
from ikgen.runtime.python.singular.curve_parts import look
from ikgen.runtime.python.singular.curve_walks import _back, walked
from ikgen.runtime.python.singular.fold_pair import Reduced
from ikgen.runtime.python.singular.near_continuum import (
    followed,
    on_curves,
    rows_around,
    trace,
)

Array = NDArray[np.float64]
POLICY = SimpleNamespace(arrived=0.5e-9, try_step=np.pi / 8, fold_reach=10.0)
LINE: Any = SimpleNamespace(moving=(0,), policy=POLICY, period=(WHOLE_TURN,), placing=(WHOLE_TURN,))


@pytest.fixture(scope="module")
def folded(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    """With the wrist above the shoulder its joint 1 is free, but for what the file rounds."""
    return emitted(to_dh(meeting_shoulder()), tmp_path_factory.mktemp("arm"))


def apart(a: Array, b: Array) -> Array:
    return np.asarray(np.abs(np.remainder(a - b + np.pi, 2 * np.pi) - np.pi).max(axis=-1))


def test_rows_on_broken_continua_are_found(folded: ModuleType) -> None:
    q = np.array(FOLDED)
    poses = folded.forward(q)
    rows, count, _ = folded.solve_batch(poses)
    for i, pose in enumerate(poses):
        for found in (folded.solve(pose).q, rows[i, : count[i]]):
            assert np.abs(folded.forward(found) - pose).max() < 2e-9
            assert apart(found, q[i]).min() < 1e-4


def marked_rows(arm: ModuleType, q: Array) -> tuple[Array, Array]:
    """The closed form's rows for the poses of q, where it marks them as of a continuum; and those poses."""
    poses = arm.forward(q)
    rows, valid, singular, *_ = arm._ARM.branches_batch(
        poses, np.zeros_like(q), np.empty((len(q), 0))
    )
    pose, lane = np.nonzero(valid & singular)
    return rows[pose, lane], poses[pose]


def test_of_a_continuum_of_the_arm_itself_one_row_is_taken(tmp_path: Path) -> None:
    exact = import_text(emit_module(published_module("kuka_kr6r900sixx")), tmp_path)
    rows, poses = marked_rows(exact, np.array([[0.2, -0.9, 1.1, 0.3, 0.0, -0.4]]))
    assert len(rows)
    traced = trace(exact._ARM, rows, poses)
    assert traced.curve.all() and not traced.broken.any() and not len(traced.owner)
    curve, owner, found, sigma = rows_around(exact._ARM, rows, poses, np.zeros(len(rows), bool))
    assert curve.all() and owner.tolist() == list(range(len(rows)))
    assert np.abs(exact.forward(found) - poses).max() < 1e-9 and sigma.max() < 1e-9


def test_rows_are_told_that_lie_on_a_curve(tmp_path: Path) -> None:
    arm = import_text(emit_module(published_module("kuka_kr6r900sixx")), tmp_path)._ARM
    at = np.array([0.2, -0.9, 1.1, 0.3, 0.0, -0.4])
    poses = forward(arm.chain, at)[None]
    parts = followed(arm, at[None], poses).parts
    turn = np.eye(6)[3] - np.eye(6)[5]  # joint 6 goes back as joint 4 goes on
    q = at + np.array([0.0 * turn, 1.7 * turn, -2.0 * turn + 2.0 * np.pi * np.eye(6)[3]])
    beside = q + 1e-5 * np.eye(6)[4]
    other = at + turn + 0.5 * np.eye(6)[0]
    owner = np.array([0, 0, 0, 1, 0, 0, 0, 0])
    rows = np.vstack([q, at, beside, other])
    told = on_curves(arm, parts, owner, rows, np.repeat(poses, 2, axis=0))
    assert told.tolist() == [True] * 3 + [False] * 5


def test_nothing_is_followed_towards_poses_out_of_reach(
    folded: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    rows, poses = marked_rows(folded, np.array(FOLDED))
    poses[:, 2, 3] += 3.0
    steps = []

    def counted(arm: Any, at: Reduced, T: Array) -> tuple[Reduced, Array]:
        steps.append(len(T))
        return fold_pair.correct(arm, at, T)

    monkeypatch.setattr(curve_samples, "correct", counted)
    traced = trace(folded._ARM, rows, poses)
    assert len(rows) and not len(traced.owner) and len(steps) < 100


def test_equal_starts_are_followed_once(
    folded: ModuleType, monkeypatch: pytest.MonkeyPatch
) -> None:
    rows, poses = marked_rows(folded, np.array(FOLDED))
    once = trace(folded._ARM, rows, poses)
    sizes, traced = [], near_continuum._traced

    def counted(arm: Any, q: Array, T: Array) -> near_continuum.Traced:
        sizes.append(len(q))
        return traced(arm, q, T)

    monkeypatch.setattr(near_continuum, "_traced", counted)
    again = trace(folded._ARM, np.tile(rows, (3, 1)), np.tile(poses, (3, 1, 1)))
    assert sizes == [len(rows)]
    assert again.curve.tolist() == once.curve.tolist() * 3
    assert again.broken.tolist() == once.broken.tolist() * 3
    count = len(rows)
    assert again.owner.tolist() == [k * count + i for k in range(3) for i in once.owner.tolist()]
    assert again.q == pytest.approx(np.tile(once.q, (3, 1)), abs=1e-12)


def test_a_broken_one_has_its_solutions_wherever_the_trace_starts(folded: ModuleType) -> None:
    q = np.array(FOLDED)
    rows, poses = marked_rows(folded, q)
    traced = trace(folded._ARM, rows, poses)
    assert traced.curve.all() and traced.broken.all() and len(traced.owner) >= 2 * len(q)
    assert (np.diff(traced.owner) >= 0).all()
    curve, owner, found, _ = rows_around(folded._ARM, rows, poses, np.zeros(len(rows), bool))
    assert curve.all() and np.abs(folded.forward(found) - poses[owner]).max() < 2e-9
    alone = [
        rows_around(folded._ARM, rows[[k]], poses[[k]], np.zeros(1, bool)) for k in range(len(rows))
    ]
    for k, (_, _, own, _) in enumerate(alone):
        others = found[owner == k]
        assert len(own) == len(others)
        assert all(apart(others, row).min() < 1e-7 for row in own)  # nearly a fold
    for at, pose in zip(q, folded.forward(q), strict=True):
        own = found[np.abs(poses[owner] - pose).max(axis=(1, 2)) < 1e-12]
        assert apart(own, at).min() < 1e-4


def test_regular_rows_and_what_is_no_row_lie_on_none(folded: ModuleType) -> None:
    q = np.array([[0.3, 0.7, -0.9, 0.4, 1.1, -0.2], [0.3, 0.7, np.nan, 0.4, 1.1, -0.2]])
    T = np.repeat(folded.forward(q[:1]), 2, axis=0)
    traced = trace(folded._ARM, q, T)
    assert not traced.curve.any() and not traced.broken.any() and not len(traced.q)


@pytest.mark.parametrize(("reach", "wanted"), [(0.3, [0.45]), (0.1, [])])
def test_solutions_in_the_last_part_of_a_curve_are_found(
    reach: float, wanted: list[float], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Behind it 0.59 and 0.98 are left, to either side, which may be too much for the curve to go on."""

    def steep(arm: Any, at: Reduced, T: Array) -> Reduced:
        return at._replace(
            left=2.0 * at.still[:, 0] * (at.q[:, 0] - 0.45), slope=np.full(len(T), 2.0)
        )

    def sampled(arm: Any, at: Reduced, T: Array) -> tuple[Reduced, Array, Array]:
        every = np.ones(len(T), dtype=bool)
        return steep(arm, at, T), every, every

    for module in (curve_walks, curve_parts):
        monkeypatch.setattr(module, "sampled", sampled)
    arm: Any = SimpleNamespace(**vars(LINE) | {"policy": SimpleNamespace(**vars(POLICY))})
    arm.policy.fold_reach = reach
    T, first = np.zeros((1, 4, 4)), at(0.35, 1.0)
    parts, ends, _, worst, _ = walked(arm, steep(arm, first, T), T, np.zeros(1, dtype=np.intp))
    assert not len(parts.owner) and worst == pytest.approx([0.2])
    owner, found = look(arm, ends, T, np.zeros(1, np.intp))
    assert not owner.any()
    np.testing.assert_allclose(found[:, 0], wanted, atol=1e-12)


def at(x: float, sense: float) -> Reduced:
    none = np.zeros(1)
    return Reduced(np.array([[x]]), np.array([[sense]]), np.ones((1, 1)), none, none)


def test_a_curve_is_back_where_it_was_in_the_same_sense() -> None:
    assert _back(LINE, at(0.1, 1.0), at(0.1 + 2.0 * np.pi, 1.0)).all()
    assert _back(LINE, at(0.1, 1.0), at(-0.1, 1.0)).all()
    assert not _back(LINE, at(0.1, 1.0), at(0.1, -1.0)).any()
    assert not _back(LINE, at(0.1, 1.0), at(0.5, 1.0)).any()


def test_a_curve_is_back_along_its_own_direction_alone() -> None:
    pair: Any = SimpleNamespace(moving=(0, 1), policy=POLICY, period=(WHOLE_TURN, WHOLE_TURN))
    none = np.zeros(1)

    def sample(x: float, y: float, way: tuple[float, float] = (0.6, 0.8)) -> Reduced:
        return Reduced(np.array([[x, y]]), np.array([way]), np.ones((1, 1)), none, none)

    assert _back(pair, sample(0.0, 0.0), sample(0.12, 0.16)).all()
    assert _back(pair, sample(0.0, 0.0), sample(-0.12 + 0.03, -0.16 - 2.0 * np.pi)).all()
    assert not _back(pair, sample(0.0, 0.0), sample(0.16, -0.12)).any()
    assert not _back(pair, sample(0.0, 0.0), sample(0.12, 0.16, (-0.8, 0.6))).any()
    along = (1.0, 0.0)
    assert _back(pair, sample(0.0, 0.0, along), sample(0.2, 0.05, along)).all()
    assert not _back(pair, sample(0.0, 0.0, along), sample(0.2, 0.07, along)).any()


def test_rows_of_other_held_values_are_followed_apart(monkeypatch: pytest.MonkeyPatch) -> None:
    seen: list[list[int]] = []
    monkeypatch.setattr(near_continuum, "samples_beside", lambda arm, q, T: None)
    monkeypatch.setattr(
        near_continuum, "walked", lambda arm, first, T, pose: seen.append(pose.tolist())
    )
    T = np.stack([np.eye(4)] * 3 + [2.0 * np.eye(4)])
    q = np.array([[0.1, 0.5], [0.2, 0.5], [0.3, 0.7], [0.1, 0.5]])
    for free, groups in (((), [0, 0, 0, 1]), ((1,), [0, 0, 1, 2])):
        followed(SimpleNamespace(free=free), q, T)  # type: ignore[arg-type]
        assert seen.pop() == groups
