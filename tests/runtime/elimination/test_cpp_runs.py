"""How many runs of eliminations the C++ runtime takes, and what round-off leaves of their polynomials."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.support.routines import compiled_header, feed

RUNS = r"""
#include "elimination/general_6r_runs.hpp"
#include "elimination/unit_circle_roots.hpp"
#include "numbers.hpp"
using namespace ikgen_runtime;
static int calls, rows;
static elimination::Spectrum found(const elimination::Chain&, const Frame&, const Frame&,
                                   const elimination::Turning& turning, const std::array<int, 3>&,
                                   elimination::Solutions& out) {
  ++calls;
  for (int k = 0; k < rows; ++k)
    elimination::keep(elimination::solution_of(turning, {0.02 * k, 0.1, 0.2, 0.3, 0.4, 0.5}), out);
  elimination::Spectrum roots;
  roots.real = 0;
  roots.simple = false;
  return roots;
}
int main() {
  elimination::Chain F;
  F.fill(kIdentity);  // all axes on one line
  const elimination::Turning turning = {true, true, true, true, true, true};
  const std::array<std::array<int, 3>, 2> plans = {};
  while (std::scanf("%d", &rows) == 1) {
    elimination::Solutions all;
    calls = 0;
    elimination::solve_in_runs<found>(F, F[0], turning, plans, all);
    std::printf("%d %d\n", calls, all.count);
  }
  const std::array<elimination::Complex, 4> c = {-1.0, 3.0, -3.0, 1.0};  // (z - 1)^3
  const std::array<double, 4> size = {1.0, 3.0, 3.0, 1.0};
  for (const double off : {1e-2, 1e-6})
    std::printf("%.17g\n", std::abs(elimination::newton_ratio(c, size, 1.0 + off)));
}
"""


def test_no_more_runs_than_tell_anything(tmp_path: Path) -> None:
    """Rows come in pairs, but where solutions meet: there the next elimination settles how many they are. A
    continuum has no room for more; beside a threefold root a polynomial has no digits."""
    even, odd, full, away, beside = feed(compiled_header(RUNS, tmp_path), [2, 3, 70])
    assert even == [2, 2] and odd == [4, 3] and full == [1, 64]
    assert away == [pytest.approx(1e-2 / 3, rel=1e-6)] and beside == [0.0]
