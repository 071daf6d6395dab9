"""The C++ kernel of the elimination about two parallel axes: the solutions of the Python one."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.elimination.test_elimination import apart, configurations, missing
from tests.support.parallel_arms import (
    KINDS,
    exchanged,
    flipped,
    parallel_frames,
    rounded_frames,
)
from tests.support.routines import MACHINES, compiled_header, feed
from tests.support.sampled import sampled
from tests.support.six_turns import general_6r_batch

from ikgen.elimination import EliminationPlan, choose_plan
from ikgen.elimination.loop_frames import forward
from ikgen.runtime.python.elimination.parallel_links import MEETING, PLAIN, UPRIGHT

Array = NDArray[np.float64]
CHAINS = {
    **{f"kind {kind}": parallel_frames(kind) for kind in KINDS},
    **{f"kind {kind}, base and tip exchanged": exchanged(parallel_frames(kind)) for kind in KINDS},
    "antiparallel": flipped(parallel_frames(MEETING)),
    "rounded": rounded_frames(PLAIN),
    "rounded, upright": rounded_frames(UPRIGHT),
}
SOLVE = r"""
#include "numbers.hpp"
#include "elimination/parallel_6r.hpp"
using namespace ikgen_runtime;
template <int Kind> struct Plan {
  static constexpr double kLength = 1.0;
  static constexpr elimination::Parallel kKind = static_cast<elimination::Parallel>(Kind);
  static inline std::array<int, 2> kParallel;
  static inline std::array<std::array<int, 2>, 2> kResultants;
  static inline std::array<std::array<int, 3>, 2> kEigenproblems;
};
template <class Plan> int run() {
  static double F[7][12], T[12];
  static elimination::Solutions all, blurred;
  int n = 0;
  read(Plan::kParallel.data(), 2, "%d");
  for (auto& plan : Plan::kResultants) read(plan.data(), 2, "%d");
  for (auto& plan : Plan::kEigenproblems) read(plan.data(), 3, "%d");
  read(F[0], 84, "%lf");
  const elimination::Chain chain = elimination::chain_of<Plan>(F);
  for (read(&n, 1, "%d"); n > 0; --n) {
    read(T, 12, "%lf");
    const Frame pose = elimination::scaled_frame<Plan>(T);
    all.count = blurred.count = 0;
    const bool alone = elimination::run_parallel<Plan::kKind>(chain, pose, Plan::kParallel, blurred, all);
    all.count = 0;
    elimination::solve_parallel<Plan>(chain, pose, all);
    std::printf("%d ", alone ? 1 : 0);
    for (int k = 0; k < all.count; ++k)
      for (const double x : all.rows[static_cast<std::size_t>(k)].q) std::printf("%.17g ", x);
    std::printf("\n");
  }
  return 0;
}
int main() {
  int kind = 0;
  read(&kind, 1, "%d");
  return kind == 0 ? run<Plan<0>>() : kind == 1 ? run<Plan<1>>() : run<Plan<2>>();
}
"""


@pytest.fixture(scope="module", params=sampled(MACHINES, ["native"]))
def solver(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return compiled_header(SOLVE, tmp_path_factory.mktemp("solve"), *MACHINES[request.param])


def solutions(
    program: Path, plan: EliminationPlan, frames: Array, poses: Array
) -> tuple[list[Array], float]:
    """Rows (k, 6) of each pose (N, 4, 4), and the share of poses that need no other elimination."""
    assert plan.parallel is not None
    F, T = frames.copy(), poses.copy()
    F[:, :3, 3] /= plan.length
    T[:, :3, 3] /= plan.length
    start, reverse, kind = plan.parallel.elimination
    resultants = [*plan.resultants, *plan.resultants, (0, 0), (0, 0)][:2]
    head = [kind, start, reverse, *np.ravel(resultants), *np.ravel(plan.eliminations)]
    numbers = [*head, *F[:, :3].ravel(), len(T), *T[:, :3].ravel()]
    lines = feed(program, [float(x) for x in numbers])
    alone = float(np.mean([line[0] for line in lines]))
    return [np.array(line[1:]).reshape(-1, 6) for line in lines], alone


@pytest.mark.parametrize("name", CHAINS)
def test_every_solution_is_right_and_none_is_missing(solver: Path, name: str) -> None:
    frames = CHAINS[name]
    plan, q = choose_plan(frames), configurations(frames, 80, seed=12)
    poses = np.array([forward(frames, row) for row in q])
    found, alone = solutions(solver, plan, frames, poses)
    reference = general_6r_batch(frames, plan.length, plan.eliminations, poses)
    assert missing(found, q) == 0
    assert alone > (0.5 if "rounded" in name else 0.9)
    for rows, others, T in zip(found, reference, poses, strict=True):
        assert len(rows) == len(others)
        for row in rows:
            assert np.abs(forward(frames, row) - T).max() < 1e-9
            assert apart(others, row).min() < 1e-6


def test_degenerate_poses_are_handed_on(solver: Path) -> None:
    """Axes 1 and 4 parallel, and a fold, where the last two joints stretch the links between."""
    frames = parallel_frames(PLAIN)
    plan = choose_plan(frames)
    q = np.random.default_rng(4).uniform(-np.pi, np.pi, (40, 6))
    q[:20, 2] = -q[:20, 1]
    q[20:, 2] = 0.5 * np.pi + 1e-7 * q[20:, 3]
    poses = np.array([forward(frames, row) for row in q])
    assert missing(solutions(solver, plan, frames, poses)[0], q) == 0


def test_unreachable_poses_and_nonsense_have_no_solution(solver: Path) -> None:
    frames = parallel_frames(UPRIGHT)
    far = forward(frames, np.zeros(6))
    far[:3, 3] += 100.0
    poses = np.array([far, np.full((4, 4), np.nan), np.zeros((4, 4)), np.full((4, 4), 1e200)])
    found, _ = solutions(solver, choose_plan(frames), frames, poses)
    assert [len(rows) for rows in found] == [0, 0, 0, 0]
