// Rows of a pose, best first.
#pragma once

#include "rows/row_preference.hpp"
#include "solving/path_following.hpp"

namespace ikgen_runtime {

// Rows of `solve`, best first. Solver: as for PathStep.
template <class A, class Solver>
inline void order_rows(const Eigen::Isometry3d& pose, const typename A::Joints* seed, typename A::Prefer prefer, bool limits,
                       typename A::Solutions& out) noexcept {
  const RowPreference<A> preference(seed, prefer, limits);
  typename A::Options options;
  options.seed = seed;
  options.limits = limits;
  Solver::solve(pose, options, out);
  for (int k = 0; k < out.count; ++k) preference.place(SolutionRows<A>::row(out, k));
  SolutionRows<A>::sort(out, [&](const double* q) noexcept { return preference.cost(q); });
}

}  // namespace ikgen_runtime
