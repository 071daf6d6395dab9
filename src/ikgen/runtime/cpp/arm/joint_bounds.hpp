// How far rows are from their joints' limits.
#pragma once

#include <algorithm>
#include <cmath>

#include "arm/joint_range.hpp"

namespace ikgen_runtime {

// Limits of the joints that move: index, middle and half of the range. Arm: as for SolutionRows.
template <class Arm> struct JointBounds {
  static constexpr double kOpen = 1e6;  // m: a slide's limit that is none; distances from the other keep 1e-10
  int count = 0;
  int joint[Arm::kDof];
  double middle[Arm::kDof], half[Arm::kDof];

  explicit JointBounds(bool limits) noexcept {
    for (int j = 0; j < Arm::kDof && limits; ++j) {
      double low = Arm::kLower.data()[j], high = Arm::kUpper.data()[j];
      const bool bounded = Arm::kPeriod[j] > 0.0 ? high - low < Arm::kPeriod[j] : low > -kInfinity || high < kInfinity;
      if (Arm::kHeld[j] || !bounded) continue;
      low = std::max(low, -kOpen);
      high = std::min(high, kOpen);
      joint[count] = j;
      middle[count] = 0.5 * (low + high);
      if (Arm::kPeriod[j] > 0.0) middle[count] = without_turns(middle[count], Arm::kPeriod[j]);
      half[count++] = 0.5 * (high - low);
    }
  }

  // A joint's value from the middle of its range.
  template <class X> [[gnu::always_inline]] X offset(int i, const X& q) const noexcept {
    const double period = Arm::kPeriod[joint[i]];
    return period > 0.0 ? shortest(q - middle[i], period) : q - middle[i];
  }

  // How far a row is outside at most, whatever turns its joints are on; the place of the joint that is.
  double outside(const double* q, int& bound) const noexcept {
    double most = -kInfinity;
    for (int i = 0; i < count; ++i) {
      const double gap = q[joint[i]] - middle[i], period = Arm::kPeriod[joint[i]];
      const double off = std::abs(period > 0.0 ? without_turns(gap, period) : gap) - half[i];
      if (off > most) bound = i;
      most = std::max(most, off);
    }
    return most;
  }
  double outside(const double* q) const noexcept {
    int bound;
    return outside(q, bound);
  }
};

}  // namespace ikgen_runtime
