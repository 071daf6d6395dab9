"""`trig_quartic`: complete on planted roots, and the same in all three forms."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.routines import compiled_header, feed

from ikgen.runtime.python.roots.trig_quartic_roots import (
    trig_quartic,
    trig_quartic_batch,
    trig_quartic_lanes,
    trig_quartic_wide_branches,
    trig_quartic_wide_lanes,
)

Array = NDArray[np.float64]
KINDS = (
    "simple", "double", "two doubles", "shared", "pi", "zero", "two real", "nearly linear", "four near"
)  # fmt: skip
MAIN = r"""
#include <cstdio>
#include "roots/trig_quartic.hpp"
using namespace ikgen_runtime;
int main() {
  double k[5];
  while (std::scanf("%lf %lf %lf %lf %lf", k, k + 1, k + 2, k + 3, k + 4) == 5) {
    const TrigRoots r = trig_quartic(k[0], k[1], k[2], k[3], k[4]);
    std::printf("%d", r.count);
    for (int i = 0; i < r.count; ++i) std::printf(" %.17g %.17g", r.c[i], r.s[i]);
    std::printf("\n");
  }
}
"""


def planted(kind: str, n: int, seed: int = 1) -> tuple[Array, Array]:
    """Coefficients (n, 5) of `(cos(t - m1) - g1) (cos(t - m2) - g2)` and their real roots (n,
    r)."""
    rng = np.random.default_rng([seed, KINDS.index(kind)])
    m, h = rng.uniform(-np.pi, np.pi, (n, 2)), rng.uniform(0.01, 3.13, (n, 2))
    tiny = 10.0 ** rng.uniform(-8.0, -3.0, (n, 2))
    if kind == "double":
        h[:, 0] = 0.5 * tiny[:, 0]
    elif kind == "two doubles":
        h = 0.5 * tiny
    elif kind == "shared":
        m[:, 1] = m[:, 0] + h[:, 0] - h[:, 1] + tiny[:, 0]
    elif kind == "pi":
        m[:, 0] = np.pi - h[:, 0]
    elif kind == "zero":
        m[:, 0] = h[:, 0]
    elif kind == "four near":
        m[:, 1], h = m[:, 0] + rng.uniform(0.01, 0.1, n), rng.uniform(0.005, 0.05, (n, 2))
    g = np.cos(h)
    if kind == "two real":
        g[:, 0] = rng.uniform(1.01, 3.0, n) * rng.choice([-1.0, 1.0], n)
    elif kind == "nearly linear":
        g[:, 0] = 10.0 ** rng.uniform(2.0, 12.0, n)
    a1 = -g[:, 1] * np.cos(m[:, 0]) - g[:, 0] * np.cos(m[:, 1])
    b1 = -g[:, 1] * np.sin(m[:, 0]) - g[:, 0] * np.sin(m[:, 1])
    both = m.sum(axis=1)
    a0 = 0.5 * np.cos(m[:, 0] - m[:, 1]) + g[:, 0] * g[:, 1]
    k = np.stack([0.5 * np.cos(both), 0.5 * np.sin(both), a1, b1, a0], axis=1)
    roots = np.concatenate([m - h, m + h], axis=1)[:, (0, 2, 1, 3)]
    if kind in ("two real", "nearly linear"):
        roots = roots[:, 2:]
    return k * 10.0 ** rng.uniform(-6.0, 6.0, (n, 1)), roots


def spread(roots: Array) -> Array:
    """Distance of every root (n, r) from the second nearest other one, 2 for two roots: (n, r)."""
    apart = np.abs(2.0 * np.sin(0.5 * (roots[:, :, None] - roots[:, None])))
    return np.sort(apart, axis=2)[:, :, 2] if roots.shape[1] > 2 else np.full(roots.shape, 2.0)


def nearest(roots: Array, c: Array, s: Array) -> Array:
    """Distance from each planted root (n, r) to the nearest found one (n, 4), NaN-padded."""
    d = np.hypot(c[:, None] - np.cos(roots)[..., None], s[:, None] - np.sin(roots)[..., None])
    return np.where(np.isnan(d), 9.0, d).min(axis=2)


@pytest.mark.parametrize("kind", KINDS)
def test_complete(kind: str) -> None:
    k, roots = planted(kind, 10_000)
    count, c, s = trig_quartic_batch(*k.T)
    near = nearest(roots, c, s)
    clustered = spread(roots) < 0.05  # three roots in one place: ill-conditioned as such
    assert (near[~clustered] < 2e-6).all()
    assert (near < 2e-6).mean() > 0.995
    assert (count <= roots.shape[1]).all()
    value = k[:, :1] * (c - s) * (c + s) + 2.0 * k[:, 1:2] * s * c + k[:, 2:3] * c + k[:, 3:4] * s
    error = np.abs(value + k[:, 4:]) / np.abs(k).max(axis=1, keepdims=True)
    assert np.nanmax(error[~clustered.any(axis=1)]) < 1e-14
    assert np.nanmax(np.abs(np.hypot(c, s) - 1.0)) < 1e-14


def of_pairs(one: Array, other: Array) -> Array:
    """Coefficients (n, 5) of the quartics with these roots (n, 2), other (n, 2)."""
    (m, h), (p, g) = (
        (pair.mean(axis=1), np.cos(0.5 * (pair[:, 0] - pair[:, 1]))) for pair in (one, other)
    )
    a1, b1 = (-g * f(m) - h * f(p) for f in (np.cos, np.sin))
    a0 = 0.5 * np.cos(m - p) + g * h
    return np.stack([0.5 * np.cos(m + p), 0.5 * np.sin(m + p), a1, b1, a0], axis=1)


@pytest.mark.parametrize("even", [False, True])
def test_four_in_one_place_are_told_apart(even: bool, tmp_path: Path) -> None:
    """As far as the digits of the coefficients do."""
    rng = np.random.default_rng(5)
    wide = 10.0 ** rng.uniform(-3.5, -1.0, (4000, 1))
    offset = wide * rng.uniform(-1.0, 1.0, (4000, 4))
    if even:
        offset[:, 1], offset[:, 3] = -offset[:, 0], -offset[:, 2]
    roots = rng.choice([0.0, np.pi, 0.7], (4000, 1)) + offset
    k = of_pairs(roots[:, :2], roots[:, 2:])
    apart = np.abs(roots[:, :, None] - roots[:, None]) + 9.0 * np.eye(4)
    steep = np.prod(np.sin(0.5 * (apart - 9.0 * np.eye(4))) + np.eye(4), axis=2).min(axis=1)
    gap = apart.min(axis=(1, 2))
    told = (1e-14 / steep < gap) & (gap > 0.05 * wide[:, 0])
    k, roots, gap = k[told], roots[told], gap[told]
    assert len(k) > 1000
    _, c, s = trig_quartic_batch(*k.T)
    assert (nearest(roots, c, s) < 0.1 * gap[:, None]).all()
    for i, line in enumerate(feed(compiled_header(MAIN, tmp_path), k.ravel().tolist())):
        pairs = np.array(line[1:]).reshape(1, -1, 2)
        assert (nearest(roots[i : i + 1], pairs[:, :, 0], pairs[:, :, 1]) < 0.1 * gap[i]).all()


def test_four_in_the_same_place_leave_one_whatever_rounding_makes_of_them(tmp_path: Path) -> None:
    rng = np.random.default_rng(7)
    t = rng.uniform(-np.pi, np.pi, 300)
    # (1 - cos(t - t0))^2 = 1.5 - 2 cos(t - t0) + 0.5 cos 2(t - t0)
    parts = [0.5 * np.cos(2 * t), 0.5 * np.sin(2 * t), -2 * np.cos(t), -2 * np.sin(t), 1.5 + 0 * t]
    K = np.stack(parts, axis=1) + rng.uniform(-3e-14, 3e-14, (300, 5))
    program = compiled_header(MAIN, tmp_path)
    for k, at, line in zip(K, t, feed(program, K.ravel()), strict=True):
        count, pairs = trig_quartic(*k)
        assert count == len(pairs) > 0 and line[0] > 0
        for c, s in (*pairs, *np.reshape(line[1:], (-1, 2))):
            assert np.hypot(c - np.cos(at), s - np.sin(at)) < 5e-3


def test_two_double_roots_next_to_each_other_leave_some(tmp_path: Path) -> None:
    """The resolvent's root is nearly a triple one, at an end of its range."""
    rng = np.random.default_rng(8)
    t = 0.5 * np.pi * rng.integers(-2, 3, 4000) + 10.0 ** rng.uniform(-7.0, -4.0, 4000)
    h = 10.0 ** rng.uniform(-7.0, -4.0, 4000)
    K = of_pairs(*(np.stack([t - h, t + h], axis=1),) * 2)
    K += rng.uniform(-1e-16, 1e-16, K.shape)
    program = compiled_header(MAIN, tmp_path)
    for k, at, line in zip(K, t, feed(program, K.ravel()), strict=True):
        for found in (trig_quartic(*k)[1], np.reshape(line[1:], (-1, 2))):
            assert len(found)
            for c, s in found:
                assert np.hypot(c - np.cos(at), s - np.sin(at)) < 5e-3


def test_degenerate() -> None:
    assert trig_quartic(0.0, 0.0, 0.0, 0.0, 0.0) == (-1, [])
    assert trig_quartic(1e-15, 0.0, 1e-16, 0.0, 0.0)[0] == -1
    assert trig_quartic(0.0, 0.0, 0.0, 0.0, 1.0) == (0, [])
    assert sorted(c for c, _ in trig_quartic(0.0, 0.0, 2.0, 0.0, 1.0)[1]) == pytest.approx(
        [-0.5, -0.5]
    )
    assert trig_quartic(0.0, 0.0, 1.0, 0.0, 1.0)[1] == [pytest.approx((-1.0, 0.0))]
    assert trig_quartic(1.0, 0.0, 0.0, 0.0, 0.0)[0] == 4
    assert trig_quartic(1.0, 0.0, 0.0, 0.0, 1.0 + 1e-15)[0] == 2
    assert trig_quartic(1.0, 0.0, 0.0, 0.0, 1.5)[0] == 0


def test_pair_just_off_the_circle_counts_once_within_tolerance() -> None:
    a0 = -np.cos(1.0) * 0.0 + 1.0 + 1e-9
    assert trig_quartic(0.0, 0.0, 1.0, 0.0, a0, tol=1e-4)[0] == 1
    assert trig_quartic(0.0, 0.0, 1.0, 0.0, a0, tol=1e-6)[0] == 0


def test_batch_rows_that_are_no_numbers() -> None:
    k = np.array([[np.nan, 0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0, 0.0], [0.0] * 5])
    count, c, _ = trig_quartic_batch(*k.T)
    assert count.tolist() == [-1, 2, -1]
    assert np.isnan(c[0]).all() and np.isnan(c[2]).all()


def test_scalar_and_batch_agree() -> None:
    for kind in KINDS:
        k, roots = planted(kind, 1000, seed=2)
        _compare(k, roots, [trig_quartic(*row) for row in k.tolist()])


def test_cpp_agrees(tmp_path: Path) -> None:
    program = compiled_header(MAIN, tmp_path)
    for kind in KINDS:
        k, roots = planted(kind, 2000, seed=3)
        lines = feed(program, k.ravel().tolist())
        pairs = [(int(v[0]), list(zip(v[1::2], v[2::2], strict=True))) for v in lines]
        _compare(k, roots, pairs)


def _compare(k: Array, roots: Array, other: list[tuple[int, list[tuple[float, float]]]]) -> None:
    """The same to round-off over the slope at the root: 1e-12 but where roots come together."""
    count, c, s = trig_quartic_batch(*k.T)
    unit = k / np.abs(k).max(axis=1, keepdims=True)
    apart = np.abs(2.0 * np.sin(0.5 * (roots[:, :, None] - roots[:, None])))
    apart = (apart + 9.0 * np.eye(roots.shape[1])).min(axis=(1, 2))
    for i in np.nonzero(apart > 1e-2)[0]:
        n, pairs = other[i]
        assert n == count[i]
        a2, b2, a1, b1, _ = unit[i]
        for x, y in pairs:
            slope = abs(2.0 * (b2 * (x - y) * (x + y) - 2.0 * a2 * x * y) + b1 * x - a1 * y)
            nearby = np.nanmin(np.maximum(np.abs(c[i] - x), np.abs(s[i] - y)))
            assert nearby < 1e-12 or nearby * slope < 3e-15


def test_lanes_are_the_batch_along_an_axis() -> None:
    """As the arrays of levels of branches call it: four roots a lane, those that are none marked."""
    k = np.concatenate([planted(kind, 3)[0] for kind in ("simple", "two real", "shared")])
    count, c, s = trig_quartic_batch(*k.T)
    shape = (1, 1, len(k))
    cosines, sines, real = trig_quartic_lanes(tuple(x.reshape(shape) for x in k.T), 1)
    assert cosines.shape == sines.shape == real.shape == (1, 4, len(k))
    assert set(count) >= {2, 4}
    for i, n in enumerate(count):
        assert real[0, :, i].tolist() == [j < n for j in range(4)]
        np.testing.assert_array_equal(cosines[0, :n, i], c[i, :n])
        np.testing.assert_array_equal(sines[0, :n, i], s[i, :n])
    assert np.isfinite(cosines).all() and np.isfinite(sines).all()


def test_complex_pairs_count_as_far_as_is_said() -> None:
    """`cos t = 1 + tol^2 / 2` has roots `tol` beside the circle."""
    for off, wide, wanted in ((0.02, 0.03, 1), (0.02, 0.01, 0), (1e-4, 1e-2, 1)):
        k = (0.0, 0.0, 1.0, 0.0, -1.0 - 0.5 * off**2)
        assert len(trig_quartic_wide_branches(*k, wide)) == wanted
        lanes = tuple(np.full((1, 3), x) for x in k)
        cosines, _, real = trig_quartic_wide_lanes((*lanes, wide), 1)
        assert real.sum() == 3 * wanted and np.allclose(cosines[real], 1.0)
