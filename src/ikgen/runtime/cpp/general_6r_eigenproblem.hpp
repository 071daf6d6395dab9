#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "general_6r_pairs.hpp"
#include "general_6r_runs.hpp"

namespace ikgen_runtime {

// --- general_6r: by the eigenproblem ----------------------------------------------------------------

namespace g6 {

// Adds one plan's solutions for the pose T, with the roots of the pose `aim` next to it.
inline Spectrum run_eigenproblem(const Chain& F, const Frame& T, const Frame& aim, const std::array<int, 3>& plan,
                                 Solutions& out) noexcept {
  const bool reverse = plan[1] != 0, swap = plan[2] != 0;
  const Loop loop = make_loop(F, aim, static_cast<Index>(plan[0]), reverse);
  const Equations eq = eliminate(loop);
  Mat<14, 12> left = eq.left;
  if (swap)
    for (Index r = 0; r < 14; ++r)
      for (Index k = 0; k < 9; ++k) left(r, k) = eq.left(r, 3 * (k % 3) + k / 3);
  const Resultant M = lift(make_pencil(eq.E, left));
  Spectrum roots = find_roots(eq.E, left, M, 0.03);
  for (int i = 0; i < roots.count; ++i) {
    const double t3 = roots.theta[static_cast<Index>(i)];
    const Pairs pairs = find_pairs(M.at(std::cos(t3), std::sin(t3)));
    for (Index j = 0; j < pairs.count; ++j) {
      const Complex z4 = swap ? pairs.z5[j] : pairs.z4[j], z5 = swap ? pairs.z4[j] : pairs.z5[j];
      const Vector t = complete(loop, eq, t3, z4, z5);
      Vector q;
      for (Index n = 0; n < 6; ++n) q[loop.order[n]] = reverse ? -t[n] : t[n];
      add_refined(F, T, kAllTurn, q, roots, out);
    }
  }
  return roots;
}

// Adds all solutions of a pose to those that are known.
template <std::size_t N>
inline void solve_eigenproblem(const Chain& F, const Frame& T, const std::array<std::array<int, 3>, N>& plans,
                               Solutions& out) noexcept {
  const auto run = [&](const Frame& aim, const std::array<int, 3>& plan, Solutions& mine) noexcept {
    return run_eigenproblem(F, T, aim, plan, mine);
  };
  solve_in_runs(T, plans, run, out);
}

}  // namespace g6
}  // namespace ikgen_runtime
