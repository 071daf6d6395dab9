"""The C++ eigenvalues of small real matrices, of whatever size: those of NumPy."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.routines import compiled_header, feed

SOLVE = r"""
#include <cstdio>
#include "elimination/general_6r_eigenvalues.hpp"
using namespace ikgen_runtime;
template <std::size_t N> bool one() {
  elimination::Mat<N, N> a{};
  std::array<elimination::Complex, N> found{};
  for (std::size_t i = 0; i < N; ++i)
    for (std::size_t j = 0; j < N; ++j)
      if (std::scanf("%lf", &a(i, j)) != 1) return false;
  if (!elimination::eigenvalues(a, found)) return false;
  for (const elimination::Complex& x : found) std::printf("%.17g %.17g ", x.real(), x.imag());
  std::printf("\n");
  return true;
}
int main() {
  int n = 0;
  while (std::scanf("%d", &n) == 1)
    if (!(n == 8 ? one<8>() : one<16>())) return 1;
}
"""


@pytest.mark.parametrize("size", [8, 16])
def test_eigenvalues_are_those_of_numpy(size: int, tmp_path: Path) -> None:
    program = compiled_header(SOLVE, tmp_path)
    rng = np.random.default_rng(4)
    matrices = rng.normal(size=(20, size, size))
    numbers = [x for a in matrices for x in (float(size), *a.ravel().tolist())]
    lines = feed(program, numbers)
    assert len(lines) == len(matrices)
    for a, line in zip(matrices, lines, strict=True):
        found = np.array(line).reshape(size, 2) @ (1.0, 1.0j)
        gaps = np.abs(np.linalg.eigvals(a)[:, None] - found)
        assert gaps.min(axis=0).max() < 1e-9
        assert gaps.min(axis=1).max() < 1e-9
