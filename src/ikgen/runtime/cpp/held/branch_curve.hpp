// How a row moves with the held value.
#pragma once

#include "arm/moving_joints.hpp"
#include "arm/pose_error.hpp"
#include "arrays/small_matrix.hpp"

namespace ikgen_runtime {

// What a row misses of the pose, and the slope of that by the joints that move and, last, the held value. Arm: as for
// PoseError.
template <class Arm> struct BranchCurve {
  static constexpr MovingJoints<Arm> kJoints{};
  static constexpr int kMoving = MovingJoints<Arm>::kCount, kCount = PoseError<Arm>::kCount;
  double error[kCount], slope[kCount][kMoving + 1];

  BranchCurve(const Eigen::Isometry3d& pose, double* q, double held) noexcept {
    if constexpr (Arm::kArmAngle) {
      const HeldAim<Arm> aim(pose, {held});
      take(PoseError<Arm>(q, aim));
      for (auto& row : slope) row[kMoving] = 0.0;
      slope[kCount - 1][kMoving] = aim.turned(q);
    } else {
      q[Arm::kFreeJoints[0]] = held;
      const PoseError<AllMoving<Arm>> at(q, HeldAim<AllMoving<Arm>>(pose));
      take(at);
      for (int e = 0; e < kCount; ++e) slope[e][kMoving] = at.slope[e][Arm::kFreeJoints[0]];
    }
  }

  // Derivatives of all joints by the held value, by least squares.
  void flow(double (&out)[Arm::kDof]) const noexcept {
    double V[kCount][kMoving], by_held[kCount], d[kMoving];
    for (int e = 0; e < kCount; ++e) {
      std::copy_n(slope[e], kMoving, V[e]);
      by_held[e] = -slope[e][kMoving];
    }
    least_squares(V, by_held, 0.0, d);
    for (int j = 0; j < Arm::kDof; ++j) out[j] = Arm::kHeld[j] ? 1.0 : 0.0;
    for (int k = 0; k < kMoving; ++k) out[kJoints[k]] = d[k];
  }

 private:
  template <class Error> void take(const Error& at) noexcept {
    for (int e = 0; e < kCount; ++e) {
      error[e] = at.error[e];
      for (int k = 0; k < kMoving; ++k) slope[e][k] = at.slope[e][kJoints[k]];
    }
  }
};

}  // namespace ikgen_runtime
