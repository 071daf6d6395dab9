"""Rows with constants as the file has them."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from tests.support.chains import chain_forward
from tests.support.rounded_arms import EXACT, spherical_wrist, three_parallel

from ikgen.kinematics.classify import classify
from ikgen.kinematics.forward import dh_forward, file_forward
from ikgen.kinematics.kept import keep_constants, keep_lengths, kept_constants, stray_lengths
from ikgen.kinematics.modified_dh import to_dh
from ikgen.model.chain import Chain

HALF = Fraction(1, 2)


@pytest.mark.parametrize("chain", [three_parallel(), spherical_wrist(), three_parallel(1.571)])
def test_rows_become_the_files_chain(chain: Chain) -> None:
    dh = to_dh(chain)
    assert max(dh.deviation) > 1e-6
    kept = keep_constants(dh)
    q = np.random.default_rng(3).uniform(-3, 3, (20, 6))
    expected = chain_forward(chain, q)
    np.testing.assert_allclose(dh_forward(kept, q), expected, atol=5e-15, rtol=0)
    np.testing.assert_allclose(file_forward(kept, q), expected, atol=5e-15, rtol=0)
    assert kept.snaps == ()
    assert max(kept.deviation) < 1e-14


def test_structure_and_names_stay() -> None:
    dh = to_dh(three_parallel())
    kept = keep_constants(dh)
    assert classify(kept) == classify(dh)
    assert [row.alpha.exact for row in kept.rows[2:4]] == [0, 0]
    twists = [kept.rows[i].alpha for i in (1, 4, 5)]
    assert all(twist.near == HALF and twist.exact is None for twist in twists)
    assert {twist.value for twist in twists} == {1.5708}
    assert len({twist.name for twist in twists}) == 1
    assert [s.what for s in kept_constants(kept)] == [twists[0].name]
    assert kept_constants(kept)[0].after == pytest.approx(EXACT, abs=1e-15)


def test_exact_rows_stay_as_they_are() -> None:
    dh = to_dh(three_parallel(EXACT))
    kept = keep_constants(dh, stray_lengths(dh))
    assert kept.rows == dh.rows
    np.testing.assert_array_equal(kept.X_base, dh.X_base)
    np.testing.assert_array_equal(kept.X_tip, dh.X_tip)
    assert kept_constants(kept) == ()


def test_stray_length_is_kept_or_nearest() -> None:
    dh = to_dh(three_parallel(skew=3e-6))
    place = (5, "a")
    assert place in stray_lengths(dh)
    kept = keep_constants(dh, frozenset([place]))
    assert kept.rows[5].a.stray
    assert abs(kept.rows[5].a.value) == pytest.approx(3e-6, rel=1e-3)
    assert kept.rows[5].a.nominal == 0.0
    assert max(kept.deviation) < 1e-13
    assert classify(kept) == classify(dh)
    nearest = keep_constants(dh)
    assert nearest.rows[5].a.name is None
    assert 1e-7 < max(nearest.deviation) < 0.5 * max(dh.deviation)
    assert all(s.after == 0.0 for s in nearest.snaps)


def test_spherical_triple_is_never_stray() -> None:
    dh = to_dh(spherical_wrist(offset=2e-6))
    assert not {(4, "a"), (5, "a"), (4, "d")} & stray_lengths(dh)
    assert max(keep_constants(dh, stray_lengths(dh)).deviation) > 1e-7


@pytest.mark.parametrize("turned_ends", [True, False])
def test_lengths_and_offsets_come_nearer_with_twists_as_they_are(turned_ends: bool) -> None:
    dh = to_dh(three_parallel(EXACT, skew=3e-6))
    kept = keep_lengths(dh, frozenset([(5, "a")]), turned_ends)
    assert [row.alpha for row in kept.rows] == [row.alpha for row in dh.rows]
    assert kept.rows[5].a.stray
    assert max(kept.deviation) < 1e-13 < 1e-6 < max(dh.deviation)
