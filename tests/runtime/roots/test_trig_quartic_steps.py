"""Steps of `trig_quartic`: what is undone, which extremum counts, and rows of any size."""

from __future__ import annotations

import math

import numpy as np
import pytest

from ikgen.runtime.python.roots import trig_quartic_roots
from ikgen.runtime.python.roots.trig_quartic_roots import _near, _tangent, trig_quartic_batch

EIGHTH = 0.25 * math.pi
"""Where the cosine changes as much as the sine, the other way."""


def pair(t: float) -> tuple[float, float]:
    return math.cos(t), math.sin(t)


@pytest.mark.parametrize("quarter", range(4))
@pytest.mark.parametrize(
    ("reach", "moves"), [(0.02, True), (0.0145, True), (0.0135, False), (0.005, False)]
)
def test_a_step_to_a_root_beyond_the_reach_is_undone(
    quarter: int, reach: float, moves: bool
) -> None:
    root = EIGHTH + 0.5 * math.pi * quarter
    start = pair(root + 0.01)
    a, b = pair(root - 1.0)
    k = (0.0, 0.0, a, b, -math.cos(1.0))  # cos(t - root + 1) = cos(1)
    found = _near(k, *start, reach)
    assert found == (pytest.approx(pair(root), abs=1e-12) if moves else start)


@pytest.mark.parametrize("quarter", range(4))
@pytest.mark.parametrize("away", [0.03, -0.03])
def test_an_extremum_beyond_the_reach_is_none(quarter: int, away: float) -> None:
    top = EIGHTH + 0.5 * math.pi * quarter
    a, b = pair(top)
    k = (0.0, 0.0, a, b, -math.cos(0.03))  # roots 0.03 to each side of the extremum
    start = pair(top + away)
    assert _tangent(k, *start, 0.05, 1e-3) is None
    found = _tangent(k, *start, 0.09, 1e-3)
    assert found is not None
    for root, (c, s) in zip((top + 0.03, top - 0.03), sorted_about(found, top), strict=True):
        assert (c, s) == pytest.approx(pair(root), abs=1e-12)


def sorted_about(found: list[tuple[float, float]], top: float) -> list[tuple[float, float]]:
    """The farthest ahead of `top` first."""
    return sorted(found, key=lambda p: -math.sin(math.atan2(p[1], p[0]) - top))


@pytest.mark.parametrize("power", [-900, -500, 0, 500, 900])
def test_rows_of_any_size_are_solved_together(power: int, monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(0)
    K = rng.uniform(-1.0, 1.0, (40, 5))
    K[:, 4] *= 0.1
    count, c, s = trig_quartic_batch(*K.T)
    keep = np.flatnonzero(trig_quartic_roots._regular_roots(K)[2])
    assert len(keep) > 20 and count[keep].min() >= 2
    monkeypatch.setattr(trig_quartic_roots, "trig_quartic", None)
    scaled = trig_quartic_batch(*(2.0**power * K[keep]).T, zero=0.0)
    for one, other in zip((count, c, s), scaled, strict=True):
        np.testing.assert_array_equal(one[keep], other)
