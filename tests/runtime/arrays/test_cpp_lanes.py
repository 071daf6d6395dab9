"""Sines and Newton steps in lanes of the C++ runtime."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.chains import make_chain, rotation, translation
from tests.support.cpp_modules import solver_module as published_module
from tests.support.held_arms import held_module
from tests.support.rounded_arms import (
    EXACT,
    FOLDED,
    X,
    Z,
    beside_the_wrist,
    meeting_shoulder,
    spherical_wrist,
    three_parallel,
)
from tests.support.routines import MACHINES, compiled_header, feed
from tests.support.sampled import sampled
from tests.support.solving import solver_module

from ikgen.emit.cpp.cpp_emitter import emit_header
from ikgen.emit.solver_module import SolverModule
from ikgen.kinematics.modified_dh import to_dh
from ikgen.model.chain import Chain

pytestmark = pytest.mark.usefixtures("solved_once")

Array = NDArray[np.float64]

SINES = r"""
#include <cstdio>
#include "arrays/lane_sines.hpp"
using namespace ikgen_runtime;
int main() {
  for (double x = 0.0, d = 0.0; std::scanf("%lf %lf", &x, &d) == 2;) {
    const double in[4] = {x, -x, x + 1.0, 0.0}, by[4] = {d, d, -d, 0.0};
    const auto at = sines(load<4>(in));
    const auto on = turned(at, load<4>(by));
    double out[4][4];
    store(at.cosine, out[0]), store(at.sine, out[1]), store(on.cosine, out[2]), store(on.sine, out[3]);
    for (int i = 0; i < 4; ++i) {
      std::printf("%.17g %.17g ", in[i], by[i]);
      std::printf("%.17g %.17g %.17g %.17g\n", out[0][i], out[1][i], out[2][i], out[3][i]);
    }
  }
}
"""
ROWS = r"""
#include <cstdio>
#include <vector>
#include "arm_ik.hpp"
// For each configuration its rows by solve, by solve_batch and by the careful way alone; how many rows
// need care; and of how many starts beside them steps in lanes lead elsewhere than one by one.
using namespace arm_ik;
using detail::Arm;
void print(const Solutions& found) {
  std::printf("%d", found.count);
  for (const Joints& q : found)
    for (int j = 0; j < kDof; ++j) std::printf(" %.17g", q[j]);
  std::printf("\n");
}
int elsewhere(const Eigen::Isometry3d& pose, const Options& options, detail::Arm::Rows<1> rows) {
  constexpr int kLanes = Arm::Rows<1>::kLanes;
  int lanes[kLanes];
  double error[kLanes], alone[kLanes][kDof], left[kLanes];
  for (int i = 0; i < kLanes; ++i) {
    lanes[i] = i;
    for (int j = 0; j < kDof; ++j) {
      if (!Arm::kHeld[j]) rows.q[j][i] += 0.02 * (i + j);
      alone[i][j] = rows.q[j][i];
    }
    const detail::HeldAim<Arm> aim(pose, options.free);
    left[i] = detail::NewtonRefinement<Arm>::error_after(alone[i], aim);
  }
  Arm::take_along(detail::gather<1>(&pose), options.free, lanes, kLanes - 1, &rows, error);
  int count = 0;
  for (int i = 0; i < kLanes - 1; ++i) {
    double apart = std::abs(error[i] - left[i]);
    for (int j = 0; j < kDof && left[i] < 1e-12; ++j)
      apart = std::max(apart, std::abs(rows.q[j][i] - alone[i][j]));
    count += !(apart < 1e-7);
  }
  return count;
}
int main() {
  std::vector<Eigen::Isometry3d> poses;
  Joints q;
  for (bool more = true; more;) {
    for (int j = 0; j < kDof; ++j) more = std::scanf("%lf", &q[j]) == 1;
    if (more) poses.push_back(forward(q));
  }
  std::vector<Solutions> batch(poses.size());
  Options options;
  options.limits = false;
  solve_batch(poses.data(), static_cast<std::ptrdiff_t>(poses.size()), batch.data(), options);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    print(solve(poses[i], options));
    print(batch[i]);
    Solutions careful;
    detail::RowPlaces<detail::Arm> none;
    detail::CarefulSolve<detail::Arm>::solve(poses[i], options, none, careful);
    print(careful);
    detail::Arm::Rows<1> rows;
    const auto pose = detail::gather<1>(&poses[i]);
    constexpr detail::Range anywhere = {detail::kUnbounded<kDof>.lower, detail::kUnbounded<kDof>.upper};
    detail::Arm::branches(pose, detail::Seed(), options.free, anywhere, rows);
    detail::Arm::refine(pose, options.free, anywhere, rows);
    int rough = 0;
    for (const double flags : rows.flags)
      rough += (static_cast<int>(flags) & (detail::kRough | detail::kHit)) != 0;
    std::printf("%d\n", rough);
    std::printf("%d\n", elsewhere(poses[i], options, rows));
  }
}
"""
SLIDE = make_chain(
    "RPRRR",
    [
        translation(0, 0, 0.4),
        rotation(X, 1.5708) @ translation(0, 0.2, 0),
        rotation(X, 1.5708) @ translation(0.1, 0, 0),
        translation(0.3, 0, 0) @ rotation(X, 1.5708),
        translation(0, 2e-4, 0) @ rotation(X, -1.5708),
    ],
    [Z] * 5,
    translation(0, 0.05, 0.1),
)


@pytest.mark.parametrize("machine", sampled(MACHINES, ["native"]))
def test_sines_are_right_to_round_off(machine: str, tmp_path: Path) -> None:
    program = compiled_header(SINES, tmp_path, *MACHINES[machine])
    random = np.random.default_rng(2)
    values = np.concatenate(
        [random.uniform(-7, 7, 400), 50 * random.normal(size=50), np.arange(9) * math.pi / 4]
    )
    turns = random.uniform(-0.1, 0.1, len(values))
    lines = feed(program, np.column_stack([values, turns]).ravel().tolist())
    assert len(lines) == 4 * len(values)
    for x, d, c, s, c_on, s_on in lines:
        assert max(abs(c - math.cos(x)), abs(s - math.sin(x))) < 4e-16
        assert max(abs(c_on - math.cos(x + d)), abs(s_on - math.sin(x + d))) < 6e-16 + 1e-16 * abs(
            x
        )


def answers(
    module: SolverModule, q: Array, folder: Path, *flags: str
) -> list[tuple[list[Array], int]]:
    """Of each configuration the rows by `solve`, in a batch and one by one, and how many rows the lanes
    left to the latter. Steps of several starts in lanes lead where those one by one do."""
    (folder / "arm_ik.hpp").write_text(emit_header(replace(module, name="arm")))
    program = compiled_header(ROWS, folder, f"-I{folder}", *flags)
    lines = feed(program, q.ravel().tolist())
    assert len(lines) == 5 * len(q)
    assert sum(one[0] > 0 for one in lines[4::5]) <= 1 + 0.02 * len(q)  # at the verge of a stage
    return [
        (
            [np.array(one[1:]).reshape(int(one[0]), -1) for one in lines[i : i + 3]],
            int(lines[i + 3][0]),
        )
        for i in range(0, len(lines), 5)
    ]


def apart(a: Array, b: Array) -> Array:
    return np.abs(np.remainder(a - b + math.pi, 2 * math.pi) - math.pi).max(axis=-1)


def rounded(chain: Chain) -> SolverModule:
    module = solver_module(to_dh(chain))
    assert module.rounded
    return module


WRIST = spherical_wrist(EXACT, offset=2e-6)


@pytest.mark.parametrize("robot", sampled(["wrist", "doosan_m1013"], ["doosan_m1013"]))
def test_lanes_find_what_one_by_one_finds(robot: str, tmp_path: Path) -> None:
    module = rounded(WRIST) if robot == "wrist" else published_module(robot)
    q = np.random.default_rng(4).uniform(-3, 3, (340, 6))
    q[300:, 4] = 1e-7  # beside the wrist's singularity all are handed on
    found = answers(module, q, tmp_path, "-march=native")
    assert all(rough > 0 for _, rough in found[300:])
    q, found = q[:300], found[:300]
    for at, ((rows, batch, careful), _) in zip(q, found, strict=True):
        assert apart(rows, at).min() < 1e-9
        assert rows.shape == batch.shape and len(rows) >= len(careful)
        assert np.abs(rows - batch).max() < 1e-9
        for row in careful:
            assert apart(rows, row).min() < 1e-6
    assert sum(rough > 0 for _, rough in found) < 0.2 * len(q)


@pytest.mark.long
def test_a_slide_and_fewer_joints_than_equations(tmp_path: Path) -> None:
    q = np.random.default_rng(4).uniform(-1, 1, (60, 5))
    found = answers(rounded(SLIDE), q, tmp_path, "-march=native")
    for at, ((rows, _, careful), _) in zip(q, found, strict=True):
        assert apart(rows, at).min() < 1e-9 and len(rows) == len(careful)
    assert sum(rough > 0 for _, rough in found) < 10


@pytest.mark.long
def test_lanes_find_the_rows_at_an_arm_angle(tmp_path: Path) -> None:
    """Elbows on the half plane that is asked for, as one by one."""
    module = held_module("rounded_arm_angle", tmp_path)
    assert module.rounded
    q = np.random.default_rng(4).uniform(-2, 2, (100, 7))
    found = answers(module, q, tmp_path, "-march=native")
    for (rows, batch, careful), rough in found:
        assert rows.shape == batch.shape and len(rows) == len(careful)
        assert apart(rows, batch).max(initial=0.0) < 1e-9  # joint 3 is at half a turn
        assert all(apart(rows, row).min() < 1e-8 for row in careful) or rough
    assert sum(len(rows) == 8 for (rows, _, _), _ in found) > 80
    assert sum(rough > 0 for _, rough in found) < 40


@pytest.mark.long
def test_a_continuum_that_rounding_breaks_is_searched_all_around(tmp_path: Path) -> None:
    q = np.array(FOLDED)
    found = answers(rounded(meeting_shoulder()), q, tmp_path)
    for at, (answered, _) in zip(q, found, strict=True):
        for rows in answered:
            assert len(rows) and apart(rows, at).min() < 1e-4


@pytest.mark.long
def test_behind_a_direction_that_rounding_turns_rows_are_found(tmp_path: Path) -> None:
    q = beside_the_wrist(300)
    for at, (answered, _) in zip(q, answers(rounded(three_parallel()), q, tmp_path), strict=True):
        for rows in answered:
            assert len(rows) and apart(rows, at).min() < 1e-6
