// Rows of a pose, best first.
#pragma once

#include "rows/row_preference.hpp"

namespace ikgen_runtime {

// Rows of `solve`, best first. Solver: solve(pose, options, out).
template <class Arm, class Solver>
inline void order_rows(const Eigen::Isometry3d& pose, const typename Arm::Joints* seed, typename Arm::Prefer prefer, bool limits,
                       typename Arm::Solutions& out) noexcept {
  const RowPreference<Arm> preference(seed, prefer, limits);
  typename Arm::Options options;
  options.seed = seed;
  options.limits = limits;
  Solver::solve(pose, options, out);
  for (int k = 0; k < out.count; ++k) preference.place(SolutionRows<Arm>::row(out, k));
  SolutionRows<Arm>::sort(out, [&](const double* q) noexcept { return preference.cost(q); });
}

}  // namespace ikgen_runtime
