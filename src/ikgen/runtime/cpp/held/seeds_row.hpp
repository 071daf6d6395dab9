// The rows at a seed's own values of what is held.
#pragma once

#include "rows/row_preference.hpp"

namespace ikgen_runtime {

// Puts the best row at the seed's own values of what is held before those that were found, if it is better: between
// samples lie values that alone reach a pose, as where an arm on a rail points along it. Solver: solve(pose, options, out).
template <class Arm, class Solver>
[[gnu::noinline]] inline void take_seeds_row(const Eigen::Isometry3d& pose, const typename Arm::Joints& seed,
                                             const RowPreference<Arm>& preference, typename Arm::Solutions& out) noexcept {
  using Row = SolutionRows<Arm>;
  constexpr double kEqual = 1e-12;  // costs that differ by less are as good
  typename Arm::Options options;
  options.seed = &seed;
  options.limits = preference.options.limits;
  typename Arm::Solutions own;
  Solver::solve(pose, options, own);
  double least = out.count > 0 ? preference.cost(Row::row(out, 0)) : kInfinity;
  if (out.count > 0) least -= kEqual * (1.0 + std::abs(least));
  int best = -1;
  for (int k = 0; k < own.count; ++k) {
    if (!preference.place(Row::row(own, k))) continue;
    const double cost = preference.cost(Row::row(own, k));
    if (!(cost < least)) continue;
    least = cost;
    best = k;
  }
  if (best < 0) return;
  if (out.count < Arm::kMaxSolutions) ++out.count;
  for (int k = out.count - 1; k > 0; --k) Row::move(out, k - 1, k);
  std::copy_n(Row::row(own, best), Arm::kDof, Row::row(out, 0));
  Row::flag(out, 0) = Row::flag(own, best);
  out.status = Arm::Status::Ok;
}

}  // namespace ikgen_runtime
