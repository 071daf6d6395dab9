#pragma once

#include "elimination/general_6r.hpp"
#include "elimination/parallel_turns.hpp"

namespace ikgen_runtime {

// --- parallel_6r: all real solutions of a 6R chain with two parallel axes ------------------------------
// Eliminated about these axes, by a polynomial that says itself where it is not sure; what it leaves open, general_6r
// completes.

namespace elimination {

// Adds the solutions for the pose T. True where they are all, as in `run_resultant`.
template <Parallel Kind>
inline bool run_parallel(const Chain& F, const Frame& T, const std::array<int, 2>& plan, Solutions& blurred,
                         Solutions& out) noexcept {
  constexpr int degree = kParallelDegree<Kind>, each = Kind == Parallel::kPlain ? 2 : 1;  // solutions of a root
  const Loop loop = make_loop(F, T, static_cast<Index>(plan[0]), plan[1] != 0);
  const ParallelLoop p = parallel_loop<Kind>(loop);
  Roots<degree> roots;
  const auto values = [&](bool, const auto& c, const auto& s, auto& f, auto& blur, auto& shift) {
    return parallel_values<Kind>(p, c, s, f, blur, shift);
  };
  bool all = find_roots<degree>(values, roots);
  constexpr int room = 2 * each * kRoots<degree> + kWide;
  alignas(64) double c[room], s[room], sign[room], live[room];
  const int count = each * roots.count;
  for (int i = 0; i < count + kWide - 1; ++i) {
    const int root = i < count ? i / each : 0;
    c[i] = count > 0 ? roots.c[root] : 1.0;
    s[i] = count > 0 ? roots.s[root] : 0.0;
    sign[i] = i % each == 0 ? 1.0 : -1.0;
    live[i] = i < count ? 1.0 : 0.0;
  }
  for (int i = 0; i < count; i += kWide) {
    double some[kWide];
    for (int l = 0; l < kWide; ++l) some[l] = live[i + l];
    const Pair six = {load<kWide>(c + i), load<kWide>(s + i)};
    all = add_rows(F, T, complete<Kind>(loop, p, six, load<kWide>(sign + i)), some, out) && all;
  }
  for (int i = 0; i < each; ++i) {
    const Wide side = spread<kWide>(i == 0 ? 1.0 : -1.0);
    add_blurred(F, T, [&](const Pair& six) { return complete<Kind>(loop, p, six, side); }, roots, blurred);
  }
  return all;
}

template <class Plan>
inline bool solve_parallel(const Chain& F, const Frame& T, Solutions& out) noexcept {
  Solutions blurred;
  const bool all = run_parallel<Plan::kKind>(F, T, Plan::kParallel, blurred, out);
  return (all && (out.count > 0 || Plan::kResultants.empty())) || solve_6r<Plan>(F, T, all, blurred, out);
}

struct Parallel6rMethod {
  template <class Plan>
  static bool solve(const Chain& F, const Frame& T, const Turning&, Solutions& out) noexcept {
    return solve_parallel<Plan>(F, T, out);
  }
};

}  // namespace elimination

// Arm: as for SixJointArm, its Plan as for general_6r, with kKind, and kParallel, the loop (start, reverse) whose
// second and third axes are parallel.
template <class Arm> struct Parallel6r : SixJointArm<Arm, elimination::Parallel6rMethod> {};

}  // namespace ikgen_runtime
