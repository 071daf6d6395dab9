// Which rows are better than others.
#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "arrays/constants.hpp"
#include "rows/least_singular_value.hpp"
#include "rows/solution_rows.hpp"

namespace ikgen_runtime {

// Arm: as for LeastSingularValue and SolutionRows; Prefer, its preferences; kPeriod.
template <class Arm> struct RowPreference {
  using Prefer = typename Arm::Prefer;
  typename Arm::Joints wanted;
  double weight[Arm::kDof];
  typename Arm::Options options;
  Prefer prefer;

  // Near to the seed, or the middle of the limits, without a seed too. The object must not be moved.
  RowPreference(const typename Arm::Joints* seed, Prefer kind, bool limits) noexcept : prefer(kind) {
    for (int j = 0; j < Arm::kDof; ++j) {
      const double low = Arm::kLower.data()[j], high = Arm::kUpper.data()[j];
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
    for (int j = 0; j < Arm::kDof; ++j)
      if (Arm::kHeld[j] && Arm::kPeriod[j] > 0.0 && !(Arm::kUpper.data()[j] - Arm::kLower.data()[j] < kInfinity))
        q[j] += Arm::kPeriod[j] * std::nearbyint((wanted.data()[j] - q[j]) / Arm::kPeriod[j]);
    return SolutionRows<Arm>::place(q, options);
  }

  // Less is better: the squared distance, or minus the smallest singular value of the task's Jacobian.
  double cost(const double* q) const noexcept {
    if (prefer == Prefer::Dexterous) return -smallest_singular_value(q);
    double sum = 0.0;
    for (int j = 0; j < Arm::kDof; ++j) sum += weight[j] * (q[j] - wanted.data()[j]) * (q[j] - wanted.data()[j]);
    return sum;
  }

  static double smallest_singular_value(const double* q) noexcept {
    Lanes<1> at[Arm::kDof];
    for (int j = 0; j < Arm::kDof; ++j) at[j] = {q[j]};
    return LeastSingularValue<Arm, 1>::of(at).v;
  }
};

}  // namespace ikgen_runtime
