// Which rows are better than others.
#pragma once

#include "rows/least_singular_value.hpp"
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

}  // namespace ikgen_runtime
