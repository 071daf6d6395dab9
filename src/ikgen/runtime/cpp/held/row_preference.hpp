// Which rows are better than others.
#pragma once

#include "held/least_singular_value.hpp"
#include "solving/path_following.hpp"
#include "rows/solution_rows.hpp"

namespace ikgen_runtime {

// A: as for PoseError and SolutionRows; Prefer, its preferences.
template <class A> struct RowPreference {
  using Prefer = typename A::Prefer;
  typename A::Joints wanted;
  double weight[A::kDof];
  typename A::Options options;
  Prefer prefer;

  // Near to the seed, or the middle of the limits, without a seed too. The object must not be moved.
  RowPreference(const typename A::Joints* seed, Prefer kind, bool limits) noexcept : prefer(kind) {
    for (int j = 0; j < A::kDof; ++j) {
      const double low = A::kLower.data()[j], high = A::kUpper.data()[j];
      const bool bounded = high - low < kInfinity, nearby = kind == Prefer::Near && seed;
      const double half = std::max(0.5 * (high - low), 1e-6);
      wanted.data()[j] = bounded && !nearby ? 0.5 * (low + high) : seed ? seed->data()[j] : 0.0;
      weight[j] = nearby ? 1.0 : bounded ? 1.0 / (half * half) : 0.0;
    }
    options.limits = limits;
    options.seed = &wanted;
  }
  RowPreference(const RowPreference&) = delete;

  // Puts a row on the turns that limits and preference ask for; false where it is outside the limits.
  bool place(double* q) const noexcept {
    for (int j = 0; j < A::kDof; ++j)
      if (A::kHeld[j] && A::kPeriod[j] > 0.0 && !(A::kUpper.data()[j] - A::kLower.data()[j] < kInfinity))
        q[j] += A::kPeriod[j] * std::nearbyint((wanted.data()[j] - q[j]) / A::kPeriod[j]);
    return SolutionRows<A>::place(q, options);
  }

  // Less is better: the squared distance, or minus the smallest singular value of the task's Jacobian.
  double cost(const double* q) const noexcept {
    if (prefer == Prefer::Dexterous) return -smallest_singular_value(q);
    double sum = 0.0;
    for (int j = 0; j < A::kDof; ++j) sum += weight[j] * (q[j] - wanted.data()[j]) * (q[j] - wanted.data()[j]);
    return sum;
  }

  static double smallest_singular_value(const double* q) noexcept {
    Lanes<1> at[A::kDof];
    for (int j = 0; j < A::kDof; ++j) at[j] = {q[j]};
    return LeastSingularValue<A, 1>::of(at).v;
  }
};

// Puts the best row at the seed's own values of what is held before those that were found, if it is better: between
// samples lie values that alone reach a pose, as where an arm on a rail points along it. Solver: as for PathStep.
template <class A, class Solver>
[[gnu::noinline]] inline void take_seeds_row(const Eigen::Isometry3d& pose, const typename A::Joints& seed,
                                             const RowPreference<A>& preference, typename A::Solutions& out) noexcept {
  using Row = SolutionRows<A>;
  constexpr double kEqual = 1e-12;  // costs that differ by less are as good
  typename A::Options options;
  options.seed = &seed;
  options.limits = preference.options.limits;
  typename A::Solutions own;
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
  if (out.count < A::kMaxSolutions) ++out.count;
  for (int k = out.count - 1; k > 0; --k) Row::move(out, k - 1, k);
  std::copy_n(Row::row(own, best), A::kDof, Row::row(out, 0));
  Row::flag(out, 0) = Row::flag(own, best);
  out.status = A::Status::Ok;
}

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
