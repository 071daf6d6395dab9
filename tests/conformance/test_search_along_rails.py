"""Searches where one value alone of the held joint reaches a pose: an arm that points along its rail."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.support.routines import compiled_header, feed
from tests.support.serial_urdf import serial_urdf
from tests.support.solving import NO_COMPILER, import_text

from ikgen.derivation.derive import derive
from ikgen.emit.cpp.cpp_emitter import emit_header
from ikgen.emit.python.python_emitter import emit_module
from ikgen.records.request import Request

pytestmark = pytest.mark.usefixtures("solved_once")

DRIVER = r"""
#include <cstdio>
#include "arm_ik.hpp"
int main() {
  Eigen::Isometry3d pose;
  arm_ik::Joints seed;
  arm_ik::SearchOptions options;
  options.seed = &seed;
  for (;;) {
    for (int i = 0; i < 16; ++i)
      if (std::scanf("%lf", &pose.matrix().data()[i]) != 1) return 0;
    for (int j = 0; j < arm_ik::kDof; ++j) std::scanf("%lf", &seed[j]);
    const auto found = arm_ik::search(pose, options);
    std::printf("%d", found.count);
    for (const auto& q : found)
      for (int j = 0; j < arm_ik::kDof; ++j) std::printf(" %.17g", q[j]);
    std::printf("\n");
  }
}
"""


@pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER or "compiles")
@pytest.mark.long
def test_the_seed_is_found_where_it_takes_the_pose(tmp_path: Path) -> None:
    places = ("0 0 0", "0 0 0.3", "0 0 0.1", "0.4 0 0")
    robot = serial_urdf(
        tmp_path / "rail.urdf",
        [(xyz, "0 0 0") for xyz in places],
        axes=["1 0 0", "0 0 1", "0 1 0", "0 1 0"],
        slides={0: "1 0 0"},
        limit=[(-1.0, 1.0), (-3.0, 3.0), (-2.0, 2.0), (-2.0, 2.0)],
        tip=("0.3 0 0", "0 0 0"),
    )
    module = derive(Request(robot, task="position", free={"j1": None}, name="arm")).module
    arm = import_text(emit_module(module), tmp_path)
    (tmp_path / "arm_ik.hpp").write_text(emit_header(module))
    q = np.random.default_rng(2).uniform(arm.LOWER, arm.UPPER, (40, 4))
    q[:, 1] = 0.0
    poses = arm.forward(q)
    numbers = [x for T, s in zip(poses, q, strict=True) for x in (*T.T.ravel(), *s)]
    lines = feed(compiled_header(DRIVER, tmp_path), [float(x) for x in numbers])
    for T, seed, line in zip(poses, q, lines, strict=True):
        for some in (arm.search(T, seed=seed).q, np.reshape(line[1:], (-1, 4))):
            assert len(some) and np.abs(some[0] - seed).max() < 1e-5
            assert np.abs(arm.forward(some)[:, :3, 3] - T[:3, 3]).max() < 1e-9
