"""Which rows in lanes are far from singularities, in C++."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.support.routines import compiled_header, feed

CODE = r"""
#include <cstdio>
#include "elbow.hpp"
#include "rows/singular_value.hpp"
int main() {
  double first = 0.0, second = 0.0, flags = 0.0;
  while (std::scanf("%lf %lf %lf", &first, &second, &flags) == 3) {
    elbow::Arm::Rows<1> rows;
    for (int lane = 0; lane < 2; ++lane) {
      rows.q[0][lane] = first;
      rows.q[1][lane] = lane == 0 ? second : 1.0;
      rows.flags[lane] = lane == 0 ? flags : 0.0;
    }
    const double q[2] = {first, second};
    bool out[2];
    elbow::SingularValue<elbow::Arm>::regular(rows, 1e-4, out);
    std::printf("%d %d %d\n", out[0], out[1], elbow::SingularValue<elbow::Arm>::below(q, 1e-4));
  }
}
"""
REAL = 2.0


@pytest.mark.parametrize("machine", ["", "-march=native"])
def test_rows_in_lanes_are_regular_where_their_slope_keeps_its_rank(
    machine: str, tmp_path: Path
) -> None:
    """Stretched or folded by x the arm's slope has a singular value of about x / sqrt(5) or x."""
    bends = [0.0, 1e-6, 1.1e-4, 3e-4, 1e-2, 1.0, -2.0, 3.1415, -3.14]
    rows = [(first, bend, REAL) for first in (-3.0, 0.4, 40.0) for bend in bends]
    rows += [(0.0, float("nan"), REAL), (0.0, 1.0, 0.0)]
    program = compiled_header(CODE, tmp_path, *([machine] if machine else []))
    said = feed(program, [x for row in rows for x in row])
    assert len(said) == len(rows) and not any(other for _, other, _ in said)
    for (_, _, real), (regular, _, below) in zip(rows, said, strict=True):
        assert regular == (below == 0.0 and real == REAL)
    assert [regular for regular, _, _ in said[:9]] == [0, 0, 0, 1, 1, 1, 1, 0, 1]
