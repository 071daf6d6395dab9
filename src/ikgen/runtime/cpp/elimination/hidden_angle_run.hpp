#pragma once

#include <array>
#include <cmath>

#include "elimination/general_6r_pairs.hpp"
#include "elimination/general_6r_runs.hpp"

namespace ikgen_runtime {

// --- one run of an elimination with a hidden angle and a pair of angles for each of its roots ----------

namespace elimination {

// Adds the solutions of a plan. eq.E and eq.left: its equations; complete(t3, z4, z5): all values of the loop.
template <class Equations, class Complete>
inline Spectrum run_hidden_angle(const Chain& F, const Frame& T, const Turning& turning, const Loop& loop,
                                 const std::array<int, 3>& plan, const Equations& eq, const Complete& complete,
                                 Solutions& out) noexcept {
  const bool reverse = plan[1] != 0, swap = plan[2] != 0;
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
      const Vector t = complete(t3, z4, z5);
      Vector q;
      for (Index n = 0; n < 6; ++n) q[loop.order[n]] = reverse ? -t[n] : t[n];
      add_refined(F, T, turning, q, roots, out);
    }
  }
  return roots;
}

}  // namespace elimination
}  // namespace ikgen_runtime
