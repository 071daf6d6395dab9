// The smallest singular value of the task's Jacobian, in lanes.
#pragma once

#include <algorithm>

#include "arm/motion_chain.hpp"
#include "arm/moving_joints.hpp"
#include "arrays/lanes.hpp"
#include "arrays/least_eigenvalue.hpp"
#include "arrays/small_matrix.hpp"

namespace ikgen_runtime {

// Arm: as for PoseError. Rows of lengths are not over the arm's size.
template <class Arm, int N> struct LeastSingularValue {
  using Pack = Lanes<N>;

  // From the least eigenvalue of J J^T, or of J^T J where that is smaller.
  static Pack of(const Pack (&q)[Arm::kDof]) noexcept {
    Pack J[6][Arm::kDof], slope[kRows][Arm::kDof], S[kOrder][kOrder];
    const FrameOf<Pack> T = MotionChain<AllMoving<Arm>>::forward(q, J);
    Arm::Task::slope(T, J, slope);
    for (int a = 0; a < kRows; ++a)
      if (Arm::kWholePose ? a < 3 : Arm::kRead[a][1] == 3)
        for (Pack& x : slope[a]) x = Arm::kSize * x;
    take_products(slope, S);
    if constexpr (kDependent) Arm::Task::fill(T, kFar, S);
    if constexpr (kInPlane) return sqrt(max(eigenvalue<kOrder - kRank>(S), 0.0));
    return sqrt(least_eigenvalue(S));
  }

  // Of `count` rows, row(k) each.
  template <class Row> static void of_rows(int count, const Row& row, double* out) noexcept {
    for (int k = 0; k < count; k += N) {
      double values[N];
      Pack q[Arm::kDof];
      for (int j = 0; j < Arm::kDof; ++j) {
        for (int i = 0; i < N; ++i) values[i] = row(k + i < count ? k + i : k)[j];
        q[j] = load<N>(values);
      }
      store(of(q), values);
      std::copy_n(values, std::min(N, count - k), out + k);
    }
  }

 private:
  static constexpr int kRows = Arm::Task::kCount, kLess = Arm::kDof < kRows ? Arm::kDof : kRows;
  static constexpr int kRank = AllMoving<Arm>::kRank;
  static constexpr bool kInPlane =  // all joints move fewer freedoms
      kRank < kLess && (Arm::kWholePose || kRank < kRows - Arm::Columns::kRelations);
  static constexpr bool kDependent = !kInPlane && kRank < kLess;  // rows
  static constexpr int kOrder = kDependent ? kRows : kLess;
  static constexpr double kFar = 1e4;  // above the least
};

}  // namespace ikgen_runtime
