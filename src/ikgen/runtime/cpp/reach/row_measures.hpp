// How good rows of joint values are, in lanes: far from singularities, and from their limits.
#pragma once

#include <cmath>

#include "arm/lane_chain.hpp"
#include "arrays/lanes.hpp"
#include "arrays/least_eigenvalue.hpp"

namespace ikgen_runtime {

// Arm: as for LaneChain; kFirstRow and kRows, which of the Jacobian's rows the task is about; kMoving, its columns; kSize (m),
// what rows of lengths are over; kLower and kUpper.
template <class Arm, int N> struct RowMeasures {
  using Pack = Lanes<N>;

  // The least singular value of the task's Jacobian, from J J^T, or J^T J where that is smaller.
  static Pack singular_value(const Pack (&q)[Arm::kDof]) noexcept {
    LaneChain<Arm, N> chain;
    for (int j = 0; j < Arm::kDof; ++j) chain.q[j] = q[j];
    chain.start();
    chain.forward();
    Pack whole[6][Arm::kDof], J[kRows][kColumns], S[kOrder][kOrder];
    chain.jacobian(whole);
    for (int i = 0; i < kRows; ++i)
      for (int j = 0; j < kColumns; ++j)
        J[i][j] = (i + Arm::kFirstRow < 3 ? 1.0 / Arm::kSize : 1.0) * whole[i + Arm::kFirstRow][Arm::kMoving[j]];
    take_products(J, S);
    return sqrt(least_eigenvalue(S));
  }

  // How far from the nearest limit, as a share of half the range; 1 where no joint has limits.
  static Pack margin(const Pack (&q)[Arm::kDof]) noexcept {
    Pack least = spread<N>(1.0);
    for (int j = 0; j < Arm::kDof; ++j) {
      const double low = Arm::kLower.data()[j], high = Arm::kUpper.data()[j], range = high - low;
      if (!std::isfinite(range) || range <= 0.0) continue;
      least = min(least, (2.0 / range) * min(q[j] - low, high - q[j]));
    }
    return max(least, 0.0);
  }

 private:
  static constexpr int kRows = Arm::kRows, kColumns = sizeof(Arm::kMoving) / sizeof(Arm::kMoving[0]);
  static constexpr int kOrder = kRows < kColumns ? kRows : kColumns;
};

}  // namespace ikgen_runtime
