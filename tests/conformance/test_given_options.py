"""What callers of a header hand in beside poses: seeds in the output, far ones, numbers that are none."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.routines import compiled_header, feed
from tests.support.solving import FIXTURES

from ikgen.derivation.derive import derive
from ikgen.emit.cpp.cpp_emitter import emit_header
from ikgen.emit.python.python_emitter import emit_module
from ikgen.records.request import Request
from ikgen.verify.runners.python_module import PythonModule

pytestmark = pytest.mark.usefixtures("solved_once")

DRIVER = r"""
#include <cmath>
#include <cstdio>
#include <vector>
#include "arm_ik.hpp"
namespace ik = arm_ik;
void print(const ik::Solutions& found) {
  std::printf("%d %d", static_cast<int>(found.status), found.count);
  for (int k = 0; k < found.count; ++k)
    for (int j = 0; j < ik::kDof; ++j) std::printf(" %.17g", found.q[k][j]);
  std::printf("\n");
}
int main() {
  double kind;
  Eigen::Isometry3d pose;
  ik::Joints seed;
  while (std::scanf("%lf", &kind) == 1) {
    for (int i = 0; i < 16; ++i) std::scanf("%lf", &pose.matrix().data()[i]);
    for (int j = 0; j < ik::kDof; ++j) std::scanf("%lf", &seed[j]);
    ik::Options options;
    options.seed = &seed;
    if (kind == 0) {  // projected
      options.project = true;
      print(ik::solve(pose, options));
    } else if (kind == 1) {  // projected, a free value that is no number
      options.project = true;
      options.free[0] = std::nan("");
      print(ik::solve(pose, options));
    } else if (kind == 2) {  // the seed in the output
      std::vector<ik::Solutions> out(5);
      out[0].q[0] = seed;
      options.seed = &out[0].q[0];
      const std::vector<Eigen::Isometry3d> poses(5, pose);
      ik::solve_batch(poses.data(), 5, out.data(), options);
      print(out[4]);
    } else if (kind == 3) {
      ik::SearchOptions wanted;
      wanted.seed = &seed;
      wanted.limits = false;
      print(ik::search(pose, wanted));
    } else {
      ik::Solutions out;
      const ik::Path path = ik::follow(&pose, 1, seed, out.q.data(), false);
      out.status = path.status;
      out.count = static_cast<int>(path.reached);
      print(out);
    }
  }
}
"""
PROJECTED, NO_NUMBER, IN_THE_OUTPUT, SEARCH, FOLLOW = range(5)
OK, INVALID = 0, 3


def test_a_header_reads_options_as_the_module_does(tmp_path: Path) -> None:
    module = derive(Request(FIXTURES / "franka_fr3.urdf", name="arm")).module
    (tmp_path / "arm_ik.hpp").write_text(emit_header(module))
    (tmp_path / "arm_ik.py").write_text(emit_module(module))
    arm = PythonModule(tmp_path / "arm_ik.py").module
    q = np.array([0.1, 0.2, 0.3, -1.5, 0.2, 1.5, 0.5])
    pose, beyond = arm.forward(q), arm.forward(q)
    beyond[:3, 3] *= 5.0
    far = q + 2e9 * np.pi * np.array([1.0, 0.0, -1.0, 0.0, 1.0, 0.0, 0.0])
    none = np.where(np.arange(7) == 2, np.nan, q)
    asked = [
        (PROJECTED, beyond, q), (PROJECTED, beyond, none), (NO_NUMBER, beyond, q), (IN_THE_OUTPUT, pose, q),
        (SEARCH, pose, far), (FOLLOW, pose, far), (FOLLOW, pose, none), (FOLLOW, pose, q),
    ]  # fmt: skip
    program = compiled_header(DRIVER, tmp_path)
    lines = feed(program, [float(x) for k, T, s in asked for x in (k, *T.T.ravel(), *s)])
    status = [int(line[0]) for line in lines]
    rows = [np.reshape(line[2:], (int(line[1]), 7)) for line in lines]
    assert status == [OK, OK, INVALID, OK, OK, OK, INVALID, OK]
    nearest = arm.solve(beyond, seed=q, project=True)
    assert (rows[0][:, 6] == 0.5).all() and np.abs(rows[0][0] - nearest.q[0]).max() < 1e-5
    assert (rows[1][:, 6] == arm.solve(beyond, project=True).q[0, 6]).all()
    assert len(rows[2]) == 0
    assert np.abs(rows[3][0] - q).max() < 1e-9 and len(rows[3]) == len(arm.solve(pose, seed=q))
    for found in (rows[4], rows[5]):
        assert len(found) and np.abs(found).max() < 1e3
        assert np.abs(arm.forward(found) - pose).max() < 1e-9
    assert np.abs(rows[7][0] - q).max() < 1e-9
