"""Blocks of a map in C++: poses read from a file, solved, and what the best of their rows measure."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.routines import MACHINES, compiled_header, feed

Array = NDArray[np.float64]

MEASURES = r"""
#include <array>
#include <cstdio>
#include "arrays/constants.hpp"
#include "reach/row_measures.hpp"
using namespace ikgen_runtime;
struct Lift {
  static constexpr int kDof = 3;
  static constexpr double kFirst[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
  static constexpr Link kLinks[] = {{0, true, 1, 0, 1, 0, 1, 0, 1, 0},
                                    {1, true, 1, 0, 1, 0, 1, 0, 1, 0},
                                    {2, false, 1, 0, 1, 0, 0, 0, 1, 0}};
  static constexpr double kLast[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
  static constexpr std::array<double, 3> kLower = {-3.0, -kInfinity, 0.5}, kUpper = {1.0, 2.0, 0.5};
  static constexpr double kSize = 4.0;
};
struct Place : Lift {
  static constexpr int kFirstRow = 0, kRows = 3, kMoving[] = {0, 1, 2};
};
struct Whole : Lift {
  static constexpr int kFirstRow = 0, kRows = 6, kMoving[] = {0, 1};
};
struct Turning : Lift {
  static constexpr int kFirstRow = 3, kRows = 3, kMoving[] = {1};
};
struct Loose : Lift {
  static constexpr std::array<double, 3> kLower = {-kInfinity, 0, 0}, kUpper = {kInfinity, kInfinity, 0};
  static constexpr int kFirstRow = 0, kRows = 3, kMoving[] = {0, 1, 2};
};
int main() {
  double at[3][2];
  while (std::scanf("%lf %lf %lf %lf %lf %lf", at[0], at[0] + 1, at[1], at[1] + 1, at[2], at[2] + 1) == 6) {
    const Lanes<2> q[3] = {load<2>(at[0]), load<2>(at[1]), load<2>(at[2])};
    using AtPlace = RowMeasures<Place, 2>;
    const Lanes<2> found[] = {AtPlace::singular_value(q), RowMeasures<Whole, 2>::singular_value(q),
                              RowMeasures<Turning, 2>::singular_value(q), AtPlace::margin(q),
                              RowMeasures<Loose, 2>::margin(q)};
    for (int lane = 0; lane < 2; ++lane) {
      for (const Lanes<2>& one : found) {
        double values[2];
        store(one, values);
        std::printf("%.17g ", values[lane]);
      }
      std::printf("\n");
    }
  }
}
"""


def slopes(q: Array) -> Array:
    """Jacobians (k, 6, 3) of two turning links of 1 m that a lift carries, lengths over 4 m."""
    a, b = q[:, 0], q[:, 0] + q[:, 1]
    J = np.zeros((len(q), 6, 3))
    J[:, 0, 0], J[:, 0, 1] = -np.sin(a) - np.sin(b), -np.sin(b)
    J[:, 1, 0], J[:, 1, 1] = np.cos(a) + np.cos(b), np.cos(b)
    J[:, 2, 2] = J[:, 5, 0] = J[:, 5, 1] = 1.0
    J[:, :3] /= 4.0
    return J


def test_rows_are_measured_by_what_the_task_reads_and_the_joints_move(tmp_path: Path) -> None:
    q = np.random.default_rng(4).uniform((-3.0, -3.0, 0.0), (1.0, 2.0, 1.0), (20, 3))
    q[0] = (0.4, 0.0, 0.2)  # stretched
    q[1] = (1.5, 1.0, 0.2)  # outside
    program = compiled_header(MEASURES, tmp_path)
    pairs = q.reshape(-1, 2, 3).transpose(0, 2, 1)
    found = np.array(feed(program, pairs.ravel().tolist()))
    J = slopes(q)
    place, whole = (np.linalg.svd(M, compute_uv=False)[:, -1] for M in (J[:, :3], J[:, :, :2]))
    np.testing.assert_allclose(found[1:, 0], place[1:], rtol=1e-11)
    assert found[0, 0] < 1e-8
    np.testing.assert_allclose(found[:, 1], whole, rtol=1e-11)
    np.testing.assert_allclose(found[:, 2], 1.0, rtol=1e-15)
    room = np.minimum(q[:, 0] + 3.0, 1.0 - q[:, 0]) / 2.0  # limits of the others leave no range
    np.testing.assert_allclose(found[:, 3], np.clip(room, 0.0, 1.0), atol=1e-15)
    assert found[1, 3] == 0.0 and (found[:, 4] == 1.0).all()


BLOCK = r"""
#include "elbow.hpp"
#include "reach/solved_block.hpp"
struct Arm : elbow::Arm {
  static constexpr double kFirst[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
  static constexpr ikgen_runtime::Link kLinks[] = {{0, true, 1, 0, 1, 0, 1, 0, 1, 0},
                                                   {1, true, 1, 0, 1, 0, 1, 0, 1, 0}};
  static constexpr double kLast[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};
  static constexpr int kFirstRow = 0, kRows = 3, kMoving[] = {0, 1};
  static constexpr double kSize = 4.0;
  static void solve_batch(const Eigen::Isometry3d* poses, std::ptrdiff_t count, Solutions* out) noexcept {
    elbow::Quick::solve(poses, count, elbow::Given(Options()), out);
  }
};
int main(int, char** argv) {
  ikgen_runtime::PoseBlock block;
  if (!block.read(argv[1])) return 3;
  return ikgen_runtime::SolvedBlock<Arm>(block).write(argv[2]) ? 0 : 4;
}
"""


@pytest.fixture(scope="module", params=MACHINES)
def program(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return compiled_header(BLOCK, tmp_path_factory.mktemp("block"), *MACHINES[request.param])


def run(program: Path, request: Path, answer: Path) -> int:
    return subprocess.run([str(program), str(request), str(answer)], check=False).returncode


def turned(angles: Array) -> Array:
    c, s, one = np.cos(angles), np.sin(angles), np.ones_like(angles)
    R = [[c, -s, 0 * one], [s, c, 0 * one], [0 * one, 0 * one, one]]
    return np.array(R).transpose(2, 0, 1)


def test_every_pose_has_its_rows_and_what_the_best_of_them_measures(
    program: Path, tmp_path: Path
) -> None:
    """More poses than are solved at once, three rotations each, of which the arm's task reads none."""
    x, y = np.random.default_rng(5).uniform(-2.2, 2.2, (2, 401))
    x[0] = 3.0
    positions = np.stack([x, y, 0 * x], axis=1)
    rotations = turned(np.array([0.0, 1.0, -2.0]))
    head = np.array([len(positions), len(rotations)], dtype=float)
    columns = rotations.transpose(0, 2, 1)
    asked, answer = tmp_path / "request", tmp_path / "answer"
    asked.write_bytes(np.concatenate([head, positions.ravel(), columns.ravel()]).tobytes())
    assert run(program, asked, answer) == 0
    n = len(positions) * len(rotations)
    data = answer.read_bytes()
    assert len(data) == 9 * n
    count = np.frombuffer(data, np.uint8, n).reshape(-1, 3)
    sigma, margin = np.frombuffer(data, np.float32, offset=n).reshape(2, -1, 3)
    for found in (count, sigma, margin):
        assert (found == found[:, :1]).all()
    best = [expected(*point) for point in positions[:, :2].tolist()]
    np.testing.assert_array_equal(count[:, 0], [rows for rows, _, _ in best])
    np.testing.assert_allclose(sigma[:, 0], [s for _, s, _ in best], rtol=1e-5, atol=1e-7)
    np.testing.assert_allclose(margin[:, 0], [m for _, _, m in best], atol=1e-6)
    assert count[0, 0] == sigma[0, 0] == 0 and set(count[:, 0]) == {0, 1, 2}


def expected(x: float, y: float) -> tuple[int, float, float]:
    """How many rows, their best singular value, and their best margin, from the law of cosines."""
    lower, upper = np.array([-3.0, -2.5]), np.array([3.0, 7.0])
    c = 0.5 * (x * x + y * y) - 1.0
    rows = []
    for bend in (np.arccos(c), -np.arccos(c)) if abs(c) <= 1.0 else ():
        q = np.array([np.arctan2(y, x) - 0.5 * bend, bend])
        q[0] = np.arctan2(np.sin(q[0]), np.cos(q[0]))
        q[1] += 2.0 * np.pi if q[1] < lower[1] else 0.0
        if (q >= lower).all() and (q <= upper).all():
            rows.append(q)
    if not rows:
        return 0, 0.0, 0.0
    q = np.array(rows)
    sigma = np.linalg.svd(slopes(q)[:, :3, :2], compute_uv=False)[:, -1]
    margin = (2.0 * np.minimum(q - lower, upper - q) / (upper - lower)).min(axis=1)
    return len(rows), float(sigma.max()), float(margin.max())


def test_files_that_cannot_be_read_or_written_are_told(program: Path, tmp_path: Path) -> None:
    missing, part, whole = tmp_path / "missing", tmp_path / "part", tmp_path / "whole"
    numbers = np.array([1.0, 1.0, 0.5, 0.5, 0.0, *np.eye(3).ravel()])
    part.write_bytes(numbers[:-1].tobytes())
    whole.write_bytes(numbers.tobytes())
    assert run(program, missing, tmp_path / "answer") == 3
    assert run(program, part, tmp_path / "answer") == 3
    assert run(program, whole, tmp_path / "no" / "answer") == 4
    assert run(program, whole, tmp_path / "answer") == 0
