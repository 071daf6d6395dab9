#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "arrays/constants.hpp"
#include "arrays/lane_sines.hpp"

namespace ikgen_runtime {

// Sums of the rows' angles, of each joint another multiple, less whole turns: rows that are the same have nearly the same
// sum, and others hardly ever. Arm: as for SolutionRows, and Rows<P>.
template <class Arm> struct RowSums {
  // Of rows in lanes.
  template <class Rows> static void take(const Rows& rows, double (&sums)[Rows::kLanes]) noexcept {
    constexpr int N = Rows::kLanes < kNative ? Rows::kLanes : kNative;
    for (int at = 0; at < Rows::kLanes; at += N) {
      Lanes<N> sum = spread<N>(0.0);
      for (int j = 0; j < Arm::kDof; ++j)
        if (Arm::kPeriod[j] > 0.0) sum = sum + multiple(j) * load<N>(rows.q[j] + at);
      store(sum - kTurn * nearest(sum / kTurn), sums + at);
    }
  }

  // Whether sums tell all of these rows apart.
  static bool apart(const double* sums, int count) noexcept {
    double least = kTurn;
    for (int k = 1; k < count; ++k)
      for (int i = 0; i < k; ++i) {
        const double gap = std::abs(sums[k] - sums[i]);
        least = std::min(least, std::min(gap, kTurn - gap));
      }
    return least > bound();
  }

 private:
  static constexpr double multiple(int j) noexcept { return Arm::kPeriod[j] > 0.0 ? (j + 1.0) * (kTurn / Arm::kPeriod[j]) : 0.0; }

  // What rows that are the same can have between their sums.
  static constexpr double bound() noexcept {
    double out = Arm::Policy::kCoincident;  // more than rounding
    for (int j = 0; j < Arm::kDof; ++j) out += multiple(j) * Arm::Policy::kCoincident;
    return out;
  }
};

}  // namespace ikgen_runtime
