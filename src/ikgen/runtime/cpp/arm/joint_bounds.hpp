// How far rows are from their joints' limits.
#pragma once

#include <algorithm>
#include <cmath>

#include "arrays/constants.hpp"
#include "arrays/lanes.hpp"

namespace ikgen_runtime {

// The difference of two angles within a turn of each other, on the shortest way.
inline double shortest(double gap) noexcept {
  return gap > kPi ? gap - kTurn : gap < -kPi ? gap + kTurn : gap;
}
template <int N, bool H> [[gnu::always_inline]] inline Lanes<N> shortest(const LanesOf<N, H>& gap) noexcept {
  return gap + select(gap > kPi, -kTurn, select(-kPi > gap, kTurn, 0.0));
}

// Limits of the joints that move: index, middle and half of the range. Arm: as for SolutionRows.
template <class Arm> struct JointBounds {
  static constexpr double kOpen = 1e6;  // m: a slide's limit that is none; distances from the other keep 1e-10
  int count = 0;
  int joint[Arm::kDof];
  double middle[Arm::kDof], half[Arm::kDof];

  explicit JointBounds(bool limits) noexcept {
    for (int j = 0; j < Arm::kDof && limits; ++j) {
      double low = Arm::kLower.data()[j], high = Arm::kUpper.data()[j];
      const bool bounded = Arm::kRevolute[j] ? high - low < kTurn : low > -kInfinity || high < kInfinity;
      if (Arm::kHeld[j] || !bounded) continue;
      low = std::max(low, -kOpen);
      high = std::min(high, kOpen);
      joint[count] = j;
      middle[count] = 0.5 * (low + high);
      if (Arm::kRevolute[j]) middle[count] = without_turns(middle[count]);
      half[count++] = 0.5 * (high - low);
    }
  }

  // A joint's value from the middle of its range.
  template <class X> [[gnu::always_inline]] X offset(int i, const X& q) const noexcept {
    return Arm::kRevolute[joint[i]] ? shortest(q - middle[i]) : q - middle[i];
  }

  // How far a row is outside at most, whatever turns its joints are on; the place of the joint that is.
  double outside(const double* q, int& bound) const noexcept {
    double most = -kInfinity;
    for (int i = 0; i < count; ++i) {
      const double gap = q[joint[i]] - middle[i];
      const double off = std::abs(Arm::kRevolute[joint[i]] ? without_turns(gap) : gap) - half[i];
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
