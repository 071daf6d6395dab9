"""The C++ kernel of the general 6R elimination: complete and exact, its polynomial isolated rightly."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.elimination.test_choice_of_plans import seven_axes
from tests.elimination.test_elimination import apart, arm_frames, configurations, missing
from tests.support.routines import MACHINES, compiled_header, feed
from tests.support.sampled import sampled
from tests.support.six_turns import general_6r_batch

from ikgen.elimination import EliminationPlan, choose_plan, hold_joint
from ikgen.elimination.loop_frames import forward
from ikgen.elimination.resultant import RESULTANTS, root_shifts

Array = NDArray[np.float64]
OLD_CASTS = "-Wold-style-cast"
NAMES = [
    "random 1", "random 2", "Issue4", "KawasakiRS05L", "equal links", "bravo7", "fanuc_crx10ia", "xarm6"
]  # fmt: skip
SOLVE = r"""
#include "elimination/general_6r.hpp"
#include "numbers.hpp"
using namespace ikgen_runtime;
struct Plan {
  static constexpr double kLength = 1.0;
  static inline std::array<std::array<int, 2>, 2> kResultants;
  static inline std::array<std::array<int, 3>, 2> kEigenproblems;
};
struct OnlyEigenproblems {
  static constexpr double kLength = 1.0;
  static constexpr std::array<std::array<int, 2>, 0> kResultants = {};
  static inline std::array<std::array<int, 3>, 2> kEigenproblems;
};
int main() {
  static double F[7][12], T[12];
  static elimination::Solutions all;
  int n = 0, method = 0;
  read(&method, 1, "%d");
  read(Plan::kResultants[0].data(), 2, "%d");
  read(Plan::kResultants[1].data(), 2, "%d");
  for (auto& plan : Plan::kEigenproblems) read(plan.data(), 3, "%d");
  OnlyEigenproblems::kEigenproblems = Plan::kEigenproblems;
  read(F[0], 84, "%lf");
  for (read(&n, 1, "%d"); n > 0; --n) {
    read(T, 12, "%lf");
    if (method == 0)
      general_6r<Plan>(F, T, all);
    else
      general_6r<OnlyEigenproblems>(F, T, all);
    for (int k = 0; k < all.count; ++k) {
      const elimination::Solution& row = all.rows[static_cast<std::size_t>(k)];
      for (const double x : row.q) std::printf("%.17g ", x);
      for (const double x : row.c) std::printf("%.17g ", x);
      for (const double x : row.s) std::printf("%.17g ", x);
    }
    std::printf("\n");
  }
}
"""
HELD = r"""
#include <cstdio>
#include "elimination/general_6r_arm.hpp"
using namespace ikgen_runtime;
struct Motion {
  int joint;
  bool revolute;
};
struct Arm {
  static constexpr Motion kMotions[] = {{0, true}, {1, true}, {2, true}, {3, true},
                                        {4, true}, {5, true}, {6, true}, {7, false}};
  static constexpr bool kHeld[] = {false, false, true, false, false, false, false, true};
  static inline double kFrames[9][3][4];
  static constexpr int kMaxSolutions = 16;
  struct Plan {
    static constexpr double kLength = 1.0;
    static inline std::array<std::array<int, 2>, 1> kResultants;
    static inline std::array<std::array<int, 3>, 1> kEigenproblems;
  };
};
int main() {
  static double x[15], roots[16][12];
  for (int& i : Arm::Plan::kResultants[0])
    if (std::scanf("%d", &i) != 1) return 1;
  for (int& i : Arm::Plan::kEigenproblems[0])
    if (std::scanf("%d", &i) != 1) return 1;
  for (int i = 0; i < 108; ++i)
    if (std::scanf("%lf", &Arm::kFrames[i / 12][i / 4 % 3][i % 4]) != 1) return 1;
  for (;;) {
    for (double& e : x)
      if (std::scanf("%lf", &e) != 1) return 0;
    const int count = General6r<Arm>::branches(x, roots);
    for (int k = 0; k < count; ++k)
      for (int i = 0; i < 6; ++i)
        std::printf("%.17g ", std::atan2(roots[k][2 * i + 1], roots[k][2 * i]));
    std::printf("\n");
  }
}
"""
ISOLATE = r"""
#include <cstdio>
#include "elimination/general_6r_roots.hpp"
using namespace ikgen_runtime;
template <int D> int run(double shift) {
  double shifts[elimination::kNodes<D>];
  std::fill(shifts, shifts + elimination::kNodes<D>, shift);
  for (;;) {
    double f[elimination::kNodes<D>];
    for (double& x : f)
      if (std::scanf("%lf", &x) != 1) return 0;
    elimination::Polynomial<D> polynomial = elimination::interpolate<D>(f, 0.0);
    if (shift > 0.0) elimination::add_shift<D>(shifts, polynomial);
    const elimination::Brackets<D> found = elimination::isolate(polynomial);
    elimination::Roots<D> roots;
    elimination::refine_all(polynomial, found, roots);
    std::printf("%d %d", found.doubt ? 1 : 0, roots.count);
    for (int i = 0; i < roots.count; ++i) std::printf(" %.17g", std::atan2(roots.s[i], roots.c[i]));
    for (int i = 0; i < found.zones; ++i)
      std::printf(" %.17g %.17g", found.zone[i].low, found.zone[i].high);
    std::printf("\n");
  }
}
int main() {
  int degree = 0;
  double shift = 0.0;
  if (std::scanf("%d %lf", &degree, &shift) != 2) return 1;
  return degree == 4 ? run<4>(shift) : run<8>(shift);
}
"""


@pytest.fixture(scope="module", params=sampled(MACHINES, ["native"]))
def solver(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return compiled_header(
        SOLVE, tmp_path_factory.mktemp("solve"), OLD_CASTS, *MACHINES[request.param]
    )


@pytest.fixture(scope="module", params=sampled(MACHINES, ["native"]))
def isolator(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return compiled_header(
        ISOLATE, tmp_path_factory.mktemp("isolate"), OLD_CASTS, *MACHINES[request.param]
    )


def solutions(
    program: Path, plan: EliminationPlan, frames: Array, poses: Array, method: int = 0
) -> list[Array]:
    """Rows (k, 18) of each pose (N, 4, 4): angles, cosines, sines; method 1: by eigenproblems alone."""
    F, T = frames.copy(), poses.copy()
    F[:, :3, 3] /= plan.length
    T[:, :3, 3] /= plan.length
    resultants = [*plan.resultants, *plan.resultants, (0, 0), (0, 0)][:2]
    head = [float(x) for x in (method, *np.ravel(resultants), *np.ravel(plan.eliminations))]
    numbers = [*head, *F[:, :3].ravel().tolist(), float(len(T)), *T[:, :3].ravel().tolist()]
    return [np.array(line).reshape(-1, 18) for line in feed(program, numbers)]


@pytest.mark.parametrize("name", NAMES)
def test_every_solution_is_right_and_none_is_missing(solver: Path, name: str) -> None:
    frames = arm_frames(name)
    plan, q = choose_plan(frames), configurations(frames, 150, seed=12)
    poses = np.array([forward(frames, row) for row in q])
    found = solutions(solver, plan, frames, poses)
    assert missing([rows[:, :6] for rows in found], q) == 0
    reference = solutions(solver, plan, frames, poses, method=1)
    for rows, others, T in zip(found, reference, poses, strict=True):
        assert len(rows) == len(others)
        for row in rows:
            error = forward(frames, row[:6]) - T
            assert np.abs(error[:3, :3]).max() < 1e-9
            assert np.abs(error[:3, 3]).max() < 1e-9 * plan.length
            assert apart(others[:, :6], row[:6]).min() < 1e-6
        assert np.abs(rows[:, 6:12] - np.cos(rows[:, :6])).max() < 1e-15 * 4
        assert np.abs(rows[:, 12:] - np.sin(rows[:, :6])).max() < 1e-15 * 4


def test_an_elimination_without_rank_is_followed_by_the_next(solver: Path) -> None:
    frames = hold_joint(seven_axes(), 2, 0.0)
    plan = replace(choose_plan(frames, probes=6), eliminations=((1, 0, 0), (4, 0, 0)))
    q = configurations(frames, 60)
    poses = np.array([forward(frames, row) for row in q])
    found = solutions(solver, plan, frames, poses, method=1)
    assert missing([rows[:, :6] for rows in found], q) == 0
    reference = general_6r_batch(frames, plan.length, ((4, 0, 0), (0, 1, 0)), poses)
    assert [len(rows) for rows in found] == [len(rows) for rows in reference]


@pytest.mark.parametrize("seed", [37, 58, 74])
def test_none_is_missing_where_the_resultant_is_round_off_at_all_angles(
    solver: Path, seed: int
) -> None:
    """Of a torso and an arm whose axes nearly meet, at multiples of 45 degrees: of none of the hidden
    angles it is known from afar whether it is one, and the zone to be looked at closer went round more
    than a turn."""
    rng = np.random.default_rng(seed)
    q = 0.25 * np.pi * rng.integers(-3, 4, (60, 6))
    held = 0.5 * np.pi * rng.integers(-1, 2, 4)
    frames = torso_and_arm(1e-3 * rng.uniform(-1.0, 1.0, (11, 3)), held)
    plan = replace(choose_plan(frames, probes=6), resultants=((4, 0), (2, 1)))
    poses = np.array([forward(frames, row) for row in q])
    found = solutions(solver, plan, frames, poses)
    assert missing([rows[:, :6] for rows in found], q) == 0


def torso_and_arm(moved: Array, held: Array) -> Array:
    """Frames (7, 4, 4) of axes y, x, z of a waist, y and x of a shoulder and x of a wrist, whose origins
    are moved (11, 3), the four joints before that at given values (4,)."""
    origins = np.zeros((11, 3))
    origins[3], origins[6], origins[7] = (0.0, 0.21, 0.26), (0.0, 0.0, -0.26), (0.0, 0.0, -0.25)
    frames, frame = [], np.eye(4)
    for i, name in enumerate("yxzyxzyzyx"):
        frame[:3, 3] += frame[:3, :3] @ (origins[i] + moved[i])
        if 5 <= i < 9:
            frame[:3, :3] = frame[:3, :3] @ about(name, held[i - 5])
            continue
        to = {"x": about("y", 0.5 * np.pi), "y": about("x", -0.5 * np.pi), "z": np.eye(3)}[name]
        frame[:3, :3] = frame[:3, :3] @ to
        frames.append(frame)
        frame = np.eye(4)
        frame[:3, :3] = to.T
    frame[:3, 3] += frame[:3, :3] @ moved[10]
    return np.array([*frames, frame])


def about(axis: str, angle: float) -> Array:
    i = "xyz".index(axis)
    j, k = (i + 1) % 3, (i + 2) % 3
    out = np.eye(3)
    out[j, j] = out[k, k] = round(np.cos(angle), 15)
    out[k, j] = round(np.sin(angle), 15)
    out[j, k] = -out[k, j]
    return out


def test_unreachable_poses_and_nonsense_have_no_solution(solver: Path) -> None:
    frames = arm_frames("random 1")
    plan = choose_plan(frames)
    far = forward(frames, np.zeros(6))
    far[:3, 3] += 100.0 * plan.length
    poses = np.array([far, np.full((4, 4), np.nan), np.zeros((4, 4)), np.full((4, 4), 1e200)])
    assert [len(rows) for rows in solutions(solver, plan, frames, poses)] == [0, 0, 0, 0]


def test_rows_are_in_the_same_order_however_they_are_found(solver: Path) -> None:
    frames = arm_frames("random 2")
    plan, q = choose_plan(frames), configurations(frames, 60, seed=3)
    poses = np.array([forward(frames, row) for row in q])
    first, other = (solutions(solver, plan, frames, poses, method) for method in (0, 1))
    for rows, others in zip(first, other, strict=True):
        assert (
            np.abs(np.remainder(rows[:, :6] - others[:, :6] + np.pi, 2 * np.pi) - np.pi).max()
            < 1e-7
        )


def test_held_joints_take_their_values(tmp_path: Path) -> None:
    """A turning joint and a slide held in an arm of eight joints, at other values for every pose."""
    rng = np.random.default_rng(9)
    frames = np.concatenate([arm_frames("random 1")[:5], arm_frames("random 2")[3:]])
    program = compiled_header(HELD, tmp_path, OLD_CASTS)
    for _ in range(5):
        turn, slide = rng.uniform(-2.0, 2.0), rng.uniform(-0.5, 0.5)
        six = hold_joint(hold_joint(frames, 7, slide, revolute=False), 2, turn)
        plan, q = choose_plan(six, probes=6), configurations(six, 20)
        poses = np.array([forward(six, row) for row in q])
        held = np.broadcast_to([np.cos(turn), np.sin(turn), slide], (len(q), 3))
        inputs = np.concatenate([poses[:, :3].reshape(-1, 12), held], axis=1)
        numbers = [
            *plan.resultants[0],
            *plan.eliminations[0],
            *frames[:, :3].ravel(),
            *inputs.ravel(),
        ]
        lines = feed(program, [float(x) for x in numbers])
        assert missing([np.array(line).reshape(-1, 6) for line in lines], q) == 0


def isolated(program: Path, f: Array, shift: float = 0.0) -> list[list[float]]:
    """What is found of polynomials of degree 4 or 8 with values f (N, n) at the nodes: doubt, count, roots
    and zones; of all functions that differ by at most `shift`."""
    return feed(program, [float((f.shape[1] - 8) // 2), shift, *f.ravel().tolist()])


def nodes(degree: int) -> Array:
    return np.linspace(0.0, 2.0 * np.pi, 2 * degree + 8, endpoint=False)


def planted(roots: Array) -> Array:
    """Values at the nodes of the polynomial with these roots (N, 2 * degree)."""
    gaps = nodes(roots.shape[1] // 2)[None, :, None] - roots[:, None, :]
    f = np.sin(0.5 * gaps).prod(axis=2)
    return np.asarray(f / np.abs(f).max(axis=1, keepdims=True))


@pytest.mark.parametrize("degree", [4, 8])
@pytest.mark.parametrize("gap", [None, 1e-2, 1e-4, 1e-9, 0.0])
def test_no_root_of_a_polynomial_is_lost(isolator: Path, gap: float | None, degree: int) -> None:
    """Each of the real roots is found, or lies in a zone of which nothing is claimed."""
    rng = np.random.default_rng(4)
    spread = np.linspace(-np.pi, np.pi, 2 * degree, endpoint=False)
    spread = spread + rng.uniform(-1.2, 1.2, (60, 2 * degree)) / degree
    if gap is not None:
        spread[:, 1] = spread[:, 0] + gap
    for line, wanted in zip(isolated(isolator, planted(spread)), spread, strict=True):
        doubt, count = line[:2]
        assert doubt == 0.0
        roots = np.array(line[2 : 2 + int(count)])
        zones = np.array(line[2 + int(count) :]).reshape(-1, 2)
        middle, half = zones.mean(axis=1), 0.5 * np.diff(zones, axis=1)[:, 0]
        for root in wanted:
            off = np.abs(np.remainder(roots - root + np.pi, 2 * np.pi) - np.pi)
            away = np.abs(np.remainder(middle - root + np.pi, 2 * np.pi) - np.pi) - half
            assert (off < 1e-7).any() or (away <= 0.0).any()
        if gap in (None, 1e-2):
            assert count == 2 * degree and not len(zones)
        if gap == 0.0:
            assert len(zones)


@pytest.mark.parametrize("degree", [4, 8])
def test_complex_roots_are_not_taken_for_real_ones(isolator: Path, degree: int) -> None:
    rng = np.random.default_rng(5)
    angle, height = rng.uniform(-np.pi, np.pi, (60, degree)), rng.uniform(0.05, 1.0, (60, degree))
    gaps = nodes(degree)[None, :, None] - angle[:, None]
    f = (np.cosh(height)[:, None] - np.cos(gaps)).prod(axis=2)
    lines = isolated(isolator, f / f.max(axis=1, keepdims=True))
    assert all(line == [0.0, 0.0] for line in lines)


@pytest.mark.parametrize("degree", [4, 8])
def test_roots_that_a_shift_may_bring_are_in_a_zone(isolator: Path, degree: int) -> None:
    """A double root is lifted off zero by half of the shift; the single roots are found all the same."""
    rng, shift = np.random.default_rng(6), 1e-5
    spread = np.linspace(-np.pi, np.pi, 2 * degree, endpoint=False)
    spread = spread + rng.uniform(-0.4, 0.4, (60, 2 * degree)) / degree
    spread[:, 1] = spread[:, 0]
    f = planted(spread)
    middle = np.sin(0.5 * (spread[:, :1] - spread[:, 2:])).prod(
        axis=1
    )  # over the double root's square
    lines = isolated(isolator, f + 0.5 * shift * np.sign(middle)[:, None], shift)
    for line, wanted in zip(lines, spread[:, 0], strict=True):
        zones = np.array(line[2 + int(line[1]) :]).reshape(-1, 2)
        away = np.abs(np.remainder(zones.mean(axis=1) - wanted + np.pi, 2 * np.pi) - np.pi)
        assert (away <= 0.5 * np.diff(zones, axis=1)[:, 0]).any()


def test_resultants_of_double_roots_are_not_chosen() -> None:
    """An arm whose solutions pair up in every second hidden angle: one is left that tells them apart."""
    frames = arm_frames("fanuc_crx10ia")
    plan, q = choose_plan(frames), configurations(frames, 20)
    poses = np.array([forward(frames, row) for row in q])
    for T in (frames, poses):
        T[:, :3, 3] /= plan.length
    shifts = np.median(root_shifts(frames, poses, q), axis=1)
    assert plan.resultants
    assert all(shifts[RESULTANTS.index(plan_)] < 1e-4 for plan_ in plan.resultants)
    assert (shifts > 0.1).sum() >= 6
