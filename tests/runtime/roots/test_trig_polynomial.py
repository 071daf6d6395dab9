"""`trig_polynomial`: every root in an interval, and the same in numbers, in arrays and in C++."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.routines import compiled_header, feed

from ikgen.forms.trig_polynomial_form import CIRCLE, most_roots
from ikgen.runtime.python.roots.trig_polynomial_numbers import trig_polynomial_numbers
from ikgen.runtime.python.roots.trig_polynomial_roots import (
    trig_polynomial_branches,
    trig_polynomial_lanes,
    trig_polynomial_roots,
)

Array = NDArray[np.float64]
TOL = 1e-3
MAIN = r"""
#include <cstdio>
#include "roots/trig_polynomial.hpp"
using namespace ikgen_runtime;
int main() {
  double x[%(n)d], roots[%(most)d][2];
  while (true) {
    for (double& one : x)
      if (std::scanf("%%lf", &one) != 1) return 0;
    const int count = trig_polynomial_branches(x, roots);
    std::printf("%%d", count);
    for (int i = 0; i < count; ++i) std::printf(" %%.17g %%.17g", roots[i][0], roots[i][1]);
    std::printf("\n");
  }
}
"""
KINDS = {
    "random": ((1, 2, 3), CIRCLE),
    "even": ((2, 4, 6), CIRCLE),
    "gear": ((4, 5, 9), (-0.6, 1.1)),
    "fine": ((10000, 11393, 21393), (-3e-4, 6e-4)),
}


def drawn(kind: str, count: int) -> tuple[Array, Array, Array, Array, Array]:
    """Harmonics (m,), coefficients a, b (n, m) and a0 (n,), and a root of each (n,) in the interval."""
    harmonics, span = KINDS[kind]
    rng = np.random.default_rng(len(kind))
    n = np.array(harmonics, dtype=float)
    a, b = rng.normal(size=(2, count, len(n)))
    t = rng.uniform(*span, count)
    a0 = -(a * np.cos(np.outer(t, n)) + b * np.sin(np.outer(t, n))).sum(axis=1)
    return n, a, b, a0, t


def value(n: Array, a: Array, b: Array, a0: Array, t: Array) -> Array:
    """The polynomials (n,) at t (n, k)."""
    phase = t[..., None] * n
    return (
        np.asarray((a[:, None] * np.cos(phase) + b[:, None] * np.sin(phase)).sum(-1)) + a0[:, None]
    )


def on_circle(n: Array, a: Array, b: Array, a0: float) -> int:
    """How many roots the polynomial in exp(i t) has on the unit circle, by its companion's eigenvalues."""
    degree = int(n.max())
    p = np.zeros(2 * degree + 1, dtype=complex)
    p[degree] = a0
    for k, x, y in zip(n.astype(int), a, b, strict=True):
        p[degree + k] += 0.5 * (x - 1j * y)
        p[degree - k] += 0.5 * (x + 1j * y)
    return int((np.abs(np.abs(np.roots(p[::-1])) - 1.0) < 1e-7).sum())


@pytest.mark.parametrize("kind", KINDS)
def test_roots_are_roots_and_none_is_missed(kind: str) -> None:
    n, a, b, a0, t = drawn(kind, 1000)
    span = KINDS[kind][1]
    most = most_roots(KINDS[kind][0], span[1] - span[0])
    roots = trig_polynomial_roots(n, a, b, a0, span, TOL, most + 4)
    there = ~np.isnan(roots)
    assert there.sum(axis=1).max() <= most
    left = value(n, a, b, a0, np.where(there, roots, 0.0))
    touching = 0.5 * (TOL / n.max()) ** 2 * (np.hypot(a, b) * n**2).sum(axis=1)[:, None]
    assert (np.abs(left)[there] < (touching + 1e-12 + 0.0 * left)[there]).all()
    assert (np.nanmin(np.abs(roots - t[:, None]), axis=1) * n.max() < 1e-6).all()
    assert (np.diff(roots, axis=1)[there[:, 1:]] > 0.0).all()
    grid = np.linspace(*span, 2001)
    signs = np.sign(value(n, a, b, a0, np.broadcast_to(grid, (len(a), len(grid)))))
    assert (there.sum(axis=1) >= (signs[:, 1:] * signs[:, :-1] < 0).sum(axis=1)).all()
    if span == CIRCLE:
        wanted = [on_circle(n, a[i], b[i], a0[i]) for i in range(200)]
        assert (there.sum(axis=1)[:200] == wanted).mean() > 0.99


@pytest.mark.parametrize("kind", KINDS)
def test_numbers_arrays_and_cpp_agree(kind: str, tmp_path: Path) -> None:
    n, a, b, a0, _ = drawn(kind, 300)
    span = KINDS[kind][1]
    most = most_roots(KINDS[kind][0], span[1] - span[0])
    roots = trig_polynomial_roots(n, a, b, a0, span, TOL, most)
    rest = [*n, *span, TOL, float(most)]
    given = np.column_stack([np.stack([a, b], axis=2).reshape(len(a), -1), a0])
    program = compiled_header(MAIN % {"n": given.shape[1] + len(rest), "most": most}, tmp_path)
    told = feed(program, np.column_stack([given, np.tile(rest, (len(a), 1))]).ravel().tolist())
    c, s, found = trig_polynomial_lanes((*given.T, *rest), 0)
    for i, line in enumerate(told):
        own = roots[i][~np.isnan(roots[i])]
        terms = list(zip(a[i], b[i], n, strict=True))
        np.testing.assert_allclose(
            trig_polynomial_numbers(terms, a0[i], span, TOL, most), own, atol=1e-9
        )
        pairs = np.column_stack([np.cos(own), np.sin(own)])
        np.testing.assert_allclose(trig_polynomial_branches(*given[i], *rest), pairs, atol=1e-9)
        np.testing.assert_allclose(np.array(line[1:]).reshape(-1, 2), pairs, atol=1e-9)
        lane = found.reshape(most, -1)[:, i]
        mine = np.column_stack([x.reshape(most, -1)[:, i][lane] for x in (c, s)])
        np.testing.assert_allclose(mine, pairs, atol=1e-9)


def with_roots(roots: Array) -> tuple[Array, Array, Array]:
    """a, b (1, m) and a0 of the product of sin((t - r) / 2) over an even number of roots r."""
    p = np.poly(np.exp(1j * roots)) * np.exp(-0.5j * roots.sum())
    p = p / (1j) ** len(roots)
    m = len(roots) // 2
    a = [2.0 * p[m - k].real for k in range(1, m + 1)]
    b = [-2.0 * p[m - k].imag for k in range(1, m + 1)]
    return np.array([a]), np.array([b]), np.array([p[m].real])


@pytest.mark.parametrize("apart", [0.0, 1e-9, 1e-6, 1e-4, 1e-2])
def test_roots_that_meet(apart: float) -> None:
    """Two that meet give one or two rows, never none; three give one at least."""
    rng = np.random.default_rng(4)
    for _ in range(60):
        for meeting in (2, 3):
            t = rng.uniform(-3.0, 3.0)
            others = rng.uniform(-3.0, 3.0, 6 - meeting)
            planted = np.concatenate([t + apart * np.arange(meeting), others])
            a, b, a0 = with_roots(planted)
            roots = trig_polynomial_roots(np.arange(1.0, 4.0), a, b, a0, CIRCLE, TOL, 6)[0]
            numbers = trig_polynomial_numbers(
                list(zip(a[0], b[0], (1.0, 2.0, 3.0), strict=True)), a0[0], CIRCLE, TOL, 6
            )
            for found in (roots[~np.isnan(roots)], np.array(numbers)):
                gap = np.abs(np.exp(1j * found) - np.exp(1j * planted)[:, None]).min(axis=1)
                assert gap.max() < (2e-3 if apart < 1e-3 else 1e-5), (planted, found)


def test_what_is_no_polynomial_has_no_roots() -> None:
    n = np.array([1.0, 3.0])
    for bad in (0.0, np.nan, np.inf):
        a = np.full((2, 2), bad)
        a[1] = 1.0
        b, a0 = np.zeros((2, 2)), np.zeros(2)
        roots = trig_polynomial_roots(n, a, b, a0, CIRCLE, TOL, 6)
        assert np.isnan(roots[0]).all() and not np.isnan(roots[1]).all()
        assert (
            trig_polynomial_numbers([(bad, 0.0, 1.0), (bad, 0.0, 3.0)], 0.0, CIRCLE, TOL, 6) == []
        )


def test_most_roots() -> None:
    assert most_roots((1, 2, 3), 2.0 * np.pi) == 6
    assert most_roots((5,), 2.0 * np.pi) == 10
    assert most_roots((4, 5, 9), 0.5 * np.pi) == 8
    assert most_roots((5,), 0.5 * np.pi) == 4
    assert most_roots((1, 3), 0.0) == 4


@pytest.mark.parametrize("off", [0.0, 1e-17, -1e-16, 3e-16, 1e-9, -1e-7, 5e-6, 1e-5, -1e-5])
def test_roots_where_the_circle_begins_are_found_once(off: float, tmp_path: Path) -> None:
    """Simple and double ones: round-off tells the signs there."""
    at = CIRCLE[0] + off
    for kind in ("simple", "double"):
        planted = [at, at if kind == "double" else 1.0, 0.1, -0.7, 0.9, 2.0]
        a, b, a0 = with_roots(np.array(planted))
        n = np.arange(1.0, 4.0)
        numbers = trig_polynomial_numbers(
            list(zip(a[0], b[0], n, strict=True)), a0[0], CIRCLE, TOL, 6
        )
        arrays = trig_polynomial_roots(n, a, b, a0, CIRCLE, TOL, 6)[0]
        for found in (np.array(numbers), arrays[~np.isnan(arrays)]):
            z = np.exp(1j * found)
            gap = np.abs(z[None] - np.exp(1j * np.array(planted))[:, None])
            assert gap.min(axis=1).max() < 1e-6 and gap.min(axis=0).max() < 1e-6
            assert len(found) == 6 if kind == "simple" else 5 <= len(found) <= 6
    symmetric = [(0.0, 1.0, 1.0), (0.0, 0.3, 2.0), (0.0, 0.2, 3.0)]  # roots at 0 and pi
    assert np.abs(np.sin(trig_polynomial_numbers(symmetric, 0.0, CIRCLE, TOL, 6))).max() < 1e-12
    assert len(trig_polynomial_numbers(symmetric, 0.0, CIRCLE, TOL, 6)) == 2


def test_cpp_finds_them_where_the_circle_begins(tmp_path: Path) -> None:
    rest = [1.0, 2.0, 3.0, *CIRCLE, TOL, 6.0]
    given = []
    for off in (0.0, 1e-16, -1e-16, 1e-9, 5e-6, 1e-5):
        a, b, a0 = with_roots(np.array([CIRCLE[0] + off, 1.0, 0.1, -0.7, 0.9, 2.0]))
        given.append([*np.stack([a[0], b[0]], axis=1).ravel(), a0[0], *rest])
    program = compiled_header(MAIN % {"n": len(given[0]), "most": 6}, tmp_path)
    for row, line in zip(given, feed(program, np.array(given).ravel().tolist()), strict=True):
        assert line[0] == 6.0 == len(trig_polynomial_branches(*row))
        pairs = np.array(line[1:]).reshape(-1, 2)
        np.testing.assert_allclose(pairs, trig_polynomial_branches(*row), atol=1e-9)
