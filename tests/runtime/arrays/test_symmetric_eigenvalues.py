"""Eigenvalues of small symmetric matrices of the C++ runtime, in lanes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from tests.support.routines import compiled_header, feed

SECOND = r"""
#include <cstdio>
#include "arrays/lanes.hpp"
#include "arrays/small_matrix.hpp"
using namespace ikgen_runtime;
int main() {
  double x;
  for (bool some = true; some;) {
    Lanes<2> A[4][4];
    for (auto& row : A)
      for (auto& entry : row) {
        some = std::scanf("%lf", &x) == 1;
        const double both[2] = {x, 2.0 * x};
        entry = load<2>(both);
      }
    if (!some) break;
    double out[2];
    store(eigenvalue<1>(A), out);
    std::printf("%.17g %.17g\n", out[0], out[1]);
  }
}
"""


def test_one_from_below(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    full = rng.normal(size=(20, 4, 4))
    flat = rng.normal(size=(20, 4, 3))
    apart = np.diag([3.0, 1.0, 1.0, 2.0])[None]
    matrices = np.concatenate(
        [full @ full.transpose(0, 2, 1), flat @ flat.transpose(0, 2, 1), apart, np.zeros((1, 4, 4))]
    )
    program = compiled_header(SECOND, tmp_path)
    found = np.array(feed(program, matrices.ravel().tolist()))
    expected = np.linalg.eigvalsh(matrices)[:, 1]
    np.testing.assert_allclose(found, np.stack([expected, 2.0 * expected], axis=1), atol=1e-13)
