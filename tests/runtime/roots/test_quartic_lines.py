"""Pairs of lines through the roots of a trigonometric quartic."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from ikgen.runtime.python.roots import trig_quartic_roots
from ikgen.runtime.python.roots.quartic_lines import ARRAYS, FLOATS, _resolvent, quartic_lines
from ikgen.runtime.python.roots.trig_quartic_roots import _near, trig_quartic, trig_quartic_batch

Array = NDArray[np.float64]


def cubic(a: float, pp: float, qq: float) -> Array:
    """Roots of `(a - m) (m^2 - 1) - pp (m - 1) - qq (m + 1)`, ascending."""
    return np.sort_complex(np.roots([-1.0, a, 1.0 - pp - qq, -a + pp - qq]))


def root(a: float, pp: float, qq: float) -> float:
    above, below = _resolvent(a, pp, qq, FLOATS)
    assert above + below == pytest.approx(2.0, abs=1e-15)
    return float(0.5 * (above - below))


def test_the_root_of_the_resolvent_is_the_one_farthest_from_others() -> None:
    rng = np.random.default_rng(1)
    seen = set()
    for _ in range(300):
        a, pp, qq = rng.uniform(-1.5, 1.5), *rng.uniform(0.0, 0.25, 2) ** 2
        roots = cubic(a, pp, qq)
        found = root(a, pp, qq)
        assert np.abs(roots - found).min() < 1e-7 and -1.0 <= found <= 1.0
        real = roots[np.abs(roots.imag) < 1e-9].real
        if len(real) == 3 and np.abs(real).max() <= 1.0:
            gaps = real[1] - real[0], real[2] - real[1]
            if abs(gaps[0] - gaps[1]) > 1e-3:
                seen.add(gaps[1] > gaps[0])
                assert found == pytest.approx(real[2] if gaps[1] > gaps[0] else real[0])
    assert seen == {True, False}


def test_arrays_give_what_floats_give() -> None:
    k = np.random.default_rng(2).normal(size=(5, 100))
    rho = np.hypot(k[0], k[1])
    many = quartic_lines(tuple(k), rho, ARRAYS)  # type: ignore[arg-type]
    for i in range(100):
        one = quartic_lines(tuple(k[:, i].tolist()), float(rho[i]), FLOATS)  # type: ignore[arg-type]
        for lines, line in zip(many[:2], one[:2], strict=True):
            np.testing.assert_allclose([x[i] for x in lines], line, atol=1e-6)
        assert many[2][i] == pytest.approx(one[2], abs=1e-6)


def of_roots(one: float, other: float, middle: float, imaginary: float) -> list[float]:
    """Coefficients of `sin((t - one) / 2) sin((t - other) / 2) (cos(t - middle) - cosh(imaginary))`."""
    t = 2.0 * np.pi / 8.0 * np.arange(8)
    f = np.sin(0.5 * (t - one)) * np.sin(0.5 * (t - other))
    f = f * (np.cos(t - middle) - np.cosh(imaginary))
    c = np.fft.fft(f) / 8.0
    return [2.0 * c[2].real, -2.0 * c[2].imag, 2.0 * c[1].real, -2.0 * c[1].imag, c[0].real]


@pytest.mark.parametrize("imaginary", [1e-6, 1e-4, 9e-4, 1.1e-3, 0.01, 0.03, 0.3])
def test_a_pair_that_is_nearly_real_counts_once(imaginary: float) -> None:
    """In arrays as alone, for imaginary parts up to the tolerance."""
    rng = np.random.default_rng(3)
    ways = [(x, x + 1.0 + y, x - 1.0 - z) for x, y, z in rng.uniform(0.0, 1.0, (20, 3))]
    K = np.array([of_roots(*way, imaginary) for way in ways])
    count, c, s = trig_quartic_batch(*K.T)
    wanted = 3 if imaginary <= 1e-3 else 2
    assert count.tolist() == [wanted] * 20
    for i, way in enumerate(ways):
        assert trig_quartic(*K[i].tolist())[0] == wanted
        for angle in way[:wanted]:
            gap = np.hypot(c[i, :wanted] - np.cos(angle), s[i, :wanted] - np.sin(angle))
            assert gap.min() < (1e-6 if angle != way[2] else 2e-3)


@pytest.mark.parametrize("apart", [1e-7, 1e-5, 1e-3, 0.03, 0.3])
def test_roots_that_are_close_are_all_found(apart: float) -> None:
    """Two on one of the lines, and two far from them."""
    rng = np.random.default_rng(4)
    for x in rng.uniform(-3.0, 3.0, 20):
        roots = np.array([x, x + apart, x + 1.5, x + 2.9])
        t = 2.0 * np.pi / 8.0 * np.arange(8)
        f = np.sin(0.5 * (t - roots[:, None])).prod(axis=0)
        h = np.fft.fft(f) / 8.0
        k = [2.0 * h[2].real, -2.0 * h[2].imag, 2.0 * h[1].real, -2.0 * h[1].imag, h[0].real]
        count, found = trig_quartic(*k)
        assert count == 4 or apart < 1e-6
        for root in roots:
            gap = [np.hypot(c - np.cos(root), s - np.sin(root)) for c, s in found]
            assert min(gap) < max(1e-9, 3e-15 / apart) + (apart if apart < 1e-6 else 0.0)


@pytest.mark.parametrize("inner", [3.4e-5, 3e-4, 1e-3])
@pytest.mark.parametrize("outer", [0.01, 0.015, 0.1])
def test_two_pairs_about_one_angle_are_both_found(inner: float, outer: float) -> None:
    """Each line's extremum is the one between the inner two, which tells nothing of the outer ones."""
    for middle in (np.pi, 0.3, -2.0):
        a, b = np.cos(inner), np.cos(outer)
        twice, once = 0.5 * np.exp(2j * middle), -(a + b) * np.exp(1j * middle)
        k = (twice.real, twice.imag, once.real, once.imag, 0.5 + a * b)
        _, found = trig_quartic(*k)
        for angle in (middle - inner, middle + inner, middle - outer, middle + outer):
            gap = min(np.hypot(c - np.cos(angle), s - np.sin(angle)) for c, s in found)
            assert gap < 0.02 * outer


def test_roots_of_other_resolvents_beyond_the_ends_are_left_alone() -> None:
    rng = np.random.default_rng(6)
    for _ in range(2000):
        a, pp, qq = rng.uniform(-6.0, 6.0), *rng.uniform(0.0, 2.5, 2) ** 2
        found = root(a, pp, qq)
        value = (a - found) * (found * found - 1.0) - pp * (found - 1.0) - qq * (found + 1.0)
        assert -1.0 <= found <= 1.0 and abs(value) < 1e-13 * (1.0 + abs(a) + pp + qq)


def test_roots_far_apart_are_found_together_whatever_the_size_of_the_equation(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    rng = np.random.default_rng(8)
    wanted = np.sort(rng.uniform(-0.3, 0.3, (30, 4)) + np.array([-2.4, -0.8, 0.8, 2.4]), axis=1)
    t = 2.0 * np.pi / 8.0 * np.arange(8)
    h = np.fft.fft(np.sin(0.5 * (t - wanted[:, :, None])).prod(axis=1), axis=1) / 8.0
    K = np.stack([2.0 * h[:, 2].real, -2.0 * h[:, 2].imag, 2.0 * h[:, 1].real, -2.0 * h[:, 1].imag,
                  h[:, 0].real])  # fmt: skip
    monkeypatch.setattr(trig_quartic_roots, "trig_quartic", None)
    for size in (1e-12, 1.0, 1e12, 1.7e308):
        count, c, s = trig_quartic_batch(*(K / np.abs(K).max(axis=0) * size))
        assert count.tolist() == [4] * 30
        np.testing.assert_allclose(np.sort(np.arctan2(s, c), axis=1), wanted, atol=1e-9)


@pytest.mark.parametrize("half", [3e-7, 1e-5, 1e-4, 1e-3, 9e-3, 0.019])
def test_pairs_of_roots_are_found_together(half: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """In one place of the circle and another, as alone; with one pair, or with two."""
    rng = np.random.default_rng(10)
    one = rng.uniform(-np.pi, np.pi, 60)
    other = one + rng.uniform(1.0, 5.0, 60)
    wide = np.where(np.arange(60) < 30, half, rng.uniform(0.1, 0.4, 60))
    wanted = np.sort(
        np.angle(np.exp(1j * np.stack([one - half, one + half, other - wide, other + wide]))), 0
    )
    inner, outer = np.cos(half), np.cos(wide)
    mixed = -outer * np.exp(1j * one) - inner * np.exp(1j * other)
    twice = 0.5 * np.exp(1j * (one + other))
    K = np.stack(
        [twice.real, twice.imag, mixed.real, mixed.imag, 0.5 * np.cos(one - other) + inner * outer]
    )
    alone = np.array(
        [sorted(np.arctan2(s, c) for c, s in trig_quartic(*k)[1]) for k in K.T.tolist()]
    )
    monkeypatch.setattr(trig_quartic_roots, "trig_quartic", None)
    count, c, s = trig_quartic_batch(*K)
    assert count.tolist() == [4] * 60
    found = np.sort(np.arctan2(s, c), axis=1)
    for rows in (wanted.T, alone):  # to round-off of a root beside another
        np.testing.assert_allclose(found, rows, atol=1e-15 / half + 1e-14)


def test_the_root_of_the_resolvent_takes_few_steps() -> None:
    rng, steps = np.random.default_rng(9), [0]

    def every(done: bool) -> bool:
        steps[-1] += 1
        return done

    counted = replace(FLOATS, every=every)
    for small in (1.0, 1e-8, 1e-30, 0.0):
        for _ in range(100):
            pp, qq = rng.permutation([small, 1.0]) * rng.uniform(0.0, 1.0, 2) ** 2
            steps.append(0)
            _resolvent(rng.uniform(-3.0, 3.0), float(pp), float(qq), counted)
    assert max(steps) < 13 and np.mean(steps[1:]) < 6.0


@pytest.mark.parametrize("small", [1e-6, 1e-12, 1e-24])
def test_a_root_beside_an_end_has_all_its_digits(small: float) -> None:
    """Which way the lines go depends on the square root of its distance."""
    for a, qq in ((0.3, 0.2), (1.5, 0.7), (-0.4, 0.6)):
        slope = 2.0 * (a + 1.0) + qq
        wanted = 2.0 * small / slope * (1.0 + small * (2.0 * (a + 3.0) / slope - 1.0) / slope)
        assert _resolvent(a, small, qq, FLOATS)[0] == pytest.approx(wanted, rel=1e-9, abs=0.0)
        assert _resolvent(-a, qq, small, FLOATS)[1] == pytest.approx(wanted, rel=1e-9, abs=0.0)


def test_a_root_is_not_taken_where_steps_lead_away_from_the_line() -> None:
    """Of cos t: from beside pi / 2, by less than the reach or more."""
    k = 0.0, 0.0, 1.0, 0.0, 0.0
    for sign in (1.0, -1.0):
        for off in (0.05, -0.05):
            angle = sign * np.pi / 2 + off
            c, s = np.cos(angle), np.sin(angle)
            assert _near(k, c, s, 0.06) == pytest.approx((0.0, sign), abs=1e-9)
            assert _near(k, c, s, 0.04) == (c, s)
    for angle in (np.pi / 4, 3.0 * np.pi / 4):  # where cosine and sine move by as much
        k = 0.0, 0.0, -np.sin(angle), np.cos(angle), 0.0
        c, s = np.cos(angle + 0.05), np.sin(angle + 0.05)
        assert _near(k, c, s, 0.06) == (c, s)
        assert _near(k, c, s, 0.08) == pytest.approx((np.cos(angle), np.sin(angle)))
