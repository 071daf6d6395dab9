"""How far a configuration is off a pose, in C++."""

from __future__ import annotations

import math
from pathlib import Path

from tests.support.routines import compiled_header, feed

GOLDEN = Path(__file__).parents[2] / "golden" / "pan_lift_ik.hpp"

PROGRAM = """
#include "GOLDEN"
#include <cstdio>
namespace ik = pan_lift_ik;
int main() {
  ik::Joints q;
  while (std::scanf("%lf %lf", &q[0], &q[1]) == 2) {
    const ik::detail::HeldAim<ik::detail::Arm> aim(ik::forward(ik::Joints(0.1, 0.2)), {});
    std::printf("%.17g\\n", ik::detail::PoseError<ik::detail::Arm>(q.data(), aim).largest());
  }
}
"""


def test_what_is_no_number_is_as_far_off_as_can_be(tmp_path: Path) -> None:
    program = compiled_header(PROGRAM.replace("GOLDEN", str(GOLDEN)), tmp_path)
    nan, inf = math.nan, math.inf
    rows = [(0.1, 0.2), (0.1, 0.3), (nan, 0.2), (0.1, nan), (inf, nan), (0.1, -inf)]
    right, off, *others = (one for (one,) in feed(program, [x for row in rows for x in row]))
    assert right < 1e-15 < 0.01 < off < 0.2
    assert others == [inf] * 4
