"""The C++ eliminations of six joints with slides: the same rows as Python's, in the same order."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.elimination.test_slides import (
    WITHOUT_RANK,
    apart,
    configurations,
    general_frames,
    missing,
    solver,
    surgical,
    turning_of,
    without_rank,
)
from tests.support.routines import compiled_header, feed

from ikgen.elimination import choose_plan
from ikgen.elimination.loop_frames import forward
from ikgen.elimination.routine import six_joints_batch

Array = NDArray[np.float64]

SOLVE = r"""
#include "numbers.hpp"
#include "elimination/one_slide.hpp"
#include "elimination/one_slide_both.hpp"
#include "elimination/three_slides.hpp"
#include "elimination/two_slides.hpp"
using namespace ikgen_runtime;
struct Plan {
  static constexpr double kLength = 1.0;
  static inline std::array<std::array<int, 3>, 2> kEigenproblems;
};
int main() {
  static double F[7][12], T[12];
  int turns[6], slides = 0, both = 0, n = 0;
  if (!read(turns, 6, "%d") || !read(&both, 1, "%d")) return 1;
  for (auto& plan : Plan::kEigenproblems)
    if (!read(plan.data(), 3, "%d")) return 1;
  if (!read(F[0], 84, "%lf") || !read(&n, 1, "%d")) return 1;
  elimination::Turning turning;
  for (std::size_t i = 0; i < 6; ++i) {
    turning[i] = turns[i] != 0;
    slides += turning[i] ? 0 : 1;
  }
  const elimination::Chain chain = elimination::chain_of<Plan>(F);
  for (; n > 0 && read(T, 12, "%lf"); --n) {
    elimination::Solutions all;
    const Frame target = elimination::scaled_frame<Plan>(T);
    if (slides == 1 && both) OneSlideBothMethod::solve<Plan>(chain, target, turning, all);
    if (slides == 1 && !both) OneSlideMethod::solve<Plan>(chain, target, turning, all);
    if (slides == 2) TwoSlidesMethod::solve<Plan>(chain, target, turning, all);
    if (slides == 3) ThreeSlidesMethod::solve<Plan>(chain, target, turning, all);
    elimination::sort_rows(turning, all);
    for (int k = 0; k < all.count; ++k)
      for (const double x : all.rows[static_cast<std::size_t>(k)].q) std::printf("%.17g ", x);
    std::printf("\n");
  }
}
"""


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return compiled_header(SOLVE, tmp_path_factory.mktemp("slides"))


@pytest.mark.parametrize(
    "kinds", ["RRRPRR", "PRRRRR", "RPRPRR", "RRPPRR", "PRRPRR", "RPRPRP", "small", *WITHOUT_RANK]
)
def test_rows_are_those_of_python(program: Path, kinds: str) -> None:
    turning, frames = turning_of(kinds), general_frames(seed=3)
    if kinds == "small":
        turning, frames = surgical()
    if kinds in WITHOUT_RANK:
        turning, frames = without_rank(kinds)
    plan = choose_plan(frames, turning, probes=8)
    q = configurations(frames, turning, 60, seed=11)
    poses = np.array([forward(frames, row, turning) for row in q])
    scaled, targets = frames.copy(), poses.copy()
    scaled[:, :3, 3] /= plan.length
    targets[:, :3, 3] /= plan.length
    head = [*turning, plan.both, *np.ravel(plan.eliminations)]
    numbers = [*head, *scaled[:, :3].ravel(), len(q), *targets[:, :3].ravel()]
    unit = np.where(turning, 1.0, plan.length)
    lines = feed(program, [float(x) for x in numbers])
    found = [np.array(line).reshape(-1, 6) * unit for line in lines]
    assert missing(found, q, turning) == 0
    for rows, others in zip(found, six_joints_batch(frames, solver(plan), poses), strict=True):
        assert len(rows) == len(others)
        for row, other in zip(rows, others, strict=True):
            assert apart(other[None], row, turning)[0] < 1e-6
