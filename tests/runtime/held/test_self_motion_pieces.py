"""Runs of rows inside the limits, as intervals of the held value."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from ikgen.runtime.python.held import self_motion
from ikgen.runtime.python.held.branch_ends import BranchEnd, _met, branch_end
from ikgen.runtime.python.held.branch_tracks import Tracks
from ikgen.runtime.python.held.held_joint import Rows
from ikgen.runtime.python.held.self_motion import pieces_of
from ikgen.runtime.python.rows.row_links import origins

Array = NDArray[np.float64]
HELD = np.array([2.0, 2.1, 2.3, 2.4, 2.8])


def tracks_of(*lanes: str, held: Array = HELD) -> Tracks:
    """Of each lane its samples: inside ("x"), real and outside ("o"), or none ("."); all stay in theirs."""
    inside, real = (
        np.array([[c in which for c in lane] for lane in lanes]).T for which in ("x", "xo")
    )
    q = np.repeat(np.arange(len(lanes), dtype=float)[None, :, None], len(held), axis=0)
    q[:, :, 0] += 0.01 * held[:, None]
    rows = Rows(held, q, real, np.where(real, 1.0, -1.0)[:, :, None])
    lane = np.arange(len(lanes))
    links = np.where(real[:-1] & real[1:], lane, -1)
    return Tracks(rows, links, np.where(inside, -1.0, 1.0), inside, 1e-5 * (held[-1] - held[0]))


def joint_of(guarded: bool = True, most: int = 8, **more: Any) -> Any:
    arm = SimpleNamespace(most=most, rounded=False, period=(0.0,))
    return SimpleNamespace(
        **{"arm": arm, "guarded": guarded, "margins_tell": guarded, "poses": 1, **more}
    )


def pieces(
    monkeypatch: pytest.MonkeyPatch, joint: Any, tracks: Tracks
) -> tuple[Any, list[BranchEnd]]:
    asked: list[BranchEnd] = []
    monkeypatch.setattr(self_motion, "find_ends", lambda joint, T, ends, limits: asked.extend(ends))
    return pieces_of(joint, np.eye(4), tracks, True), asked


def test_a_branch_inside_all_over_has_the_whole_range(monkeypatch: pytest.MonkeyPatch) -> None:
    (piece,), asked = pieces(monkeypatch, joint_of(), tracks_of("xxxxx"))
    assert (piece.low, piece.high, piece.branch) == (2.0, 2.8, 0) and not asked
    assert piece.samples == tuple((k, 0) for k in range(5))
    interval = piece.interval()
    assert (interval.low, interval.high, interval.branch) == (2.0, 2.8, 0)


def test_runs_end_at_the_limits_and_where_rows_come_and_go(monkeypatch: pytest.MonkeyPatch) -> None:
    lanes = ".xoxx", "xxx..", "oooox", "oxxxo"
    found, asked = pieces(monkeypatch, joint_of(), tracks_of(*lanes))
    ends = [
        tuple(
            (x if isinstance(x, float) else (x.inner, x.outer, x.at_fold)) for x in (p.low, p.high)
        )
        for p in found
    ]
    assert [piece.branch for piece in found] == [0, 0, 1, 2, 3]
    assert ends == [
        ((2.1, 2.0, True), (2.1, 2.3, False)),
        ((2.4, 2.3, False), 2.8),
        (2.0, (2.3, 2.4, True)),
        ((2.8, 2.4, False), 2.8),
        ((2.1, 2.0, False), (2.4, 2.8, False)),
    ]
    assert sorted(x.lane for x in asked) == [0, 0, 0, 1, 2, 3, 3] and all(x.stays for x in asked)
    assert found[1].width() == pytest.approx(0.5)  # at most
    assert found[1].interval().low == 2.4  # what is known


def test_many_slivers_are_left_where_they_were_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """A hundred-thousandth of the range is one, and a thousandth is none."""
    held = 1000.0 + np.array([0.0, 0.9, 0.900005, 0.90001, 0.95, 0.951, 0.952, 1.0])
    for slivers, looked in ((2, True), (3, False)):
        lanes = ["..x....."] * slivers + [".....x.."]
        found, asked = pieces(monkeypatch, joint_of(most=1), tracks_of(*lanes, held=held))
        assert len(found) == slivers + 1
        assert {end.lane for end in asked} == ({0, 1, 2} if looked else {slivers})


def test_where_margins_do_not_tell_motions_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    found, _ = pieces(monkeypatch, joint_of(guarded=False), tracks_of("xx.xx", "xxxox"))
    assert [(piece.branch, piece.samples[0]) for piece in found] == [
        (0, (0, 0)), (1, (0, 1)), (1, (4, 1)), (2, (3, 0)),
    ]  # fmt: skip


def test_of_rows_that_end_together_the_nearest_is_met() -> None:
    tracks = tracks_of("xxx..", "xxx..", "xxxxx", "x....")
    before, arm = origins(tracks.links), joint_of().arm
    assert _met(arm, tracks, before, (2, 0), 3) == 1
    assert _met(arm, tracks, before, (2, 1), 3) == 0
    assert _met(arm, tracks_of("xxx..", "xxxxx"), before[:, :2], (2, 0), 3) == -1
    for guarded in (True, False):
        end = branch_end(joint_of(guarded=guarded), tracks, before, (2, 1), (3, -1))
        assert end.at_fold and (end.inner, end.outer, end.lane) == (2.3, 2.4, 1)
        if guarded:
            assert end.there is None
        else:  # the row that it meets, where it was seen
            assert end.then == 2.3 and end.there is not None
            np.testing.assert_array_equal(end.there, tracks.rows.q[2, 0])


def test_beyond_a_limit_the_branch_goes_on() -> None:
    tracks = tracks_of("xxxoo", "xxxxx")
    end = branch_end(joint_of(guarded=False), tracks, origins(tracks.links), (2, 0), (3, 0))
    assert not end.at_fold and end.then == 2.4 and end.there is not None
    np.testing.assert_array_equal(end.there, tracks.rows.q[3, 0])


def test_of_too_many_the_widest_are_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    held = np.linspace(0.0, 1.0, 101)
    lane = "x." * 25 + "xxx." + "x." * 23 + "x"
    every, _ = pieces(monkeypatch, joint_of(most=8), tracks_of(lane, held=held))
    kept, _ = pieces(monkeypatch, joint_of(most=1), tracks_of(lane, held=held))
    assert (len(every), len(kept)) == (50, 16)
    samples = [piece.samples for piece in every]
    assert [piece.samples for piece in kept] == sorted(piece.samples for piece in kept)
    assert ((50, 0), (51, 0), (52, 0)) in [piece.samples for piece in kept] and {*samples} > {
        piece.samples for piece in kept
    }
