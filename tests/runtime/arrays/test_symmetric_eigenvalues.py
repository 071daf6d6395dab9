"""Eigenvalues of small symmetric matrices of the C++ runtime, in lanes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.routines import compiled_header, feed

PROGRAM = r"""
#include <cstdio>
#include "arrays/lanes.hpp"
#include "arrays/least_eigenvalue.hpp"
#include "arrays/small_matrix.hpp"
using namespace ikgen_runtime;
int main() {
  double x;
  for (bool some = true; some;) {
    Lanes<2> A[@order@][@order@];
    for (auto& row : A)
      for (auto& entry : row) {
        some = std::scanf("%lf", &x) == 1;
        const double both[2] = {x, 2.0 * x};
        entry = load<2>(both);
      }
    if (!some) break;
    double out[2];
    store(@function@(A), out);
    std::printf("%.17g %.17g\n", out[0], out[1]);
  }
}
"""


def compiled(function: str, order: int, folder: Path) -> Path:
    """The program of a function of matrices of this order, and of twice these beside them."""
    text = PROGRAM.replace("@function@", function).replace("@order@", str(order))
    return compiled_header(text, folder)


def test_one_from_below(tmp_path: Path) -> None:
    rng = np.random.default_rng(1)
    full = rng.normal(size=(20, 4, 4))
    flat = rng.normal(size=(20, 4, 3))
    apart = np.diag([3.0, 1.0, 1.0, 2.0])[None]
    matrices = np.concatenate(
        [full @ full.transpose(0, 2, 1), flat @ flat.transpose(0, 2, 1), apart, np.zeros((1, 4, 4))]
    )
    program = compiled("eigenvalue<1>", 4, tmp_path)
    found = np.array(feed(program, matrices.ravel().tolist()))
    expected = np.linalg.eigvalsh(matrices)[:, 1]
    np.testing.assert_allclose(found, np.stack([expected, 2.0 * expected], axis=1), atol=1e-13)


@pytest.mark.parametrize("order", [1, 2, 3, 6])
def test_the_least(order: int, tmp_path: Path) -> None:
    """Of matrices of full rank to most of its digits, also where others are equal or hardly greater."""
    rng = np.random.default_rng(2)
    turned = np.linalg.qr(rng.normal(size=(40, order, order)))[0]
    values = np.sort(10.0 ** rng.uniform(-4.0, 0.0, (40, order)), axis=1)
    values[10:20] = values[10:20, :1]
    values[20:30] = values[20:30, :1] * (1.0 + 1e-6 * np.arange(order))
    values[30:, 0] = 0.0
    matrices = np.einsum("nij,nj,nkj->nik", turned, values, turned)
    matrices = 0.5 * (matrices + matrices.transpose(0, 2, 1))
    program = compiled("least_eigenvalue", order, tmp_path)
    found = np.array(feed(program, matrices.ravel().tolist()))
    np.testing.assert_allclose(found, values[:, :1] * [1.0, 2.0], atol=3e-15)
    zero = feed(program, [0.0] * order**2)
    assert zero == [[0.0, 0.0]]
