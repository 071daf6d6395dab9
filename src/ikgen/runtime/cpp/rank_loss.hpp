#pragma once

#include "moving_joints.hpp"
#include "pose_error.hpp"

namespace ikgen_runtime {

// Arm: as for PoseError; kHeld, a flag a joint.
template <class Arm> struct RankLoss {
  static constexpr MovingJoints<Arm> kJoints{};
  static constexpr int kMoving = MovingJoints<Arm>::kCount, kEquations = PoseError<Arm>::kCount;
  static constexpr int kRank = kMoving < kEquations ? kMoving : kEquations;

  // Whether the slope V at q has a singular value below `bound`: V V^T - bound^2, or V^T V - bound^2 where that is
  // smaller, is not positive definite then.
  static bool below(const double* q, double bound) noexcept {
    const PoseError<Arm> at(q, HeldAim<Arm>::own(q));
    double A[kRank][kRank];
    for (int a = 0; a < kRank; ++a)
      for (int b = 0; b <= a; ++b) {
        double sum = a == b ? -bound * bound : 0.0;
        if constexpr (kMoving < kEquations) {
          for (const auto& row : at.slope) sum += row[kJoints[a]] * row[kJoints[b]];
        } else {
          for (const int j : kJoints.joint) sum += at.slope[a][j] * at.slope[b][j];
        }
        A[a][b] = sum;
      }
    factor(A);
    return !definite(A);
  }
};

}  // namespace ikgen_runtime
