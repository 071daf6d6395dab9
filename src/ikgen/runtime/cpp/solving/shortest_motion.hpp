// The shortest motions to a pose, of all joints but some that are stopped.
#pragma once

#include <algorithm>

#include "arm/moving_joints.hpp"
#include "newton/newton_refinement.hpp"

namespace ikgen_runtime {

// Arm: as for PoseError.
template <class Arm> struct ShortestMotion {
  static constexpr int kDof = Arm::kDof;
  static constexpr double kDamping = 1e-8;  // where Newton steps arrive

  // The shortest motion by the Jacobian, of joints that are not stopped; the error before it.
  static double move(double* at, const Eigen::Isometry3d& pose, const bool* stopped, double damping) noexcept {
    PoseError<AllMoving<Arm>> here(at, HeldAim<AllMoving<Arm>>(pose));
    constexpr int n = PoseError<AllMoving<Arm>>::kCount;
    const double worst = here.largest();
    double N[n][n];
    here.hold(stopped);
    gram_of_rows(here.slope, N);
    shift_diagonal(damping, N);
    factor(N);
    substitute(N, here.error);
    for (int j = 0; j < kDof; ++j) {
      double step = 0.0;
      for (int a = 0; a < n; ++a) step += here.slope[a][j] * here.error[a];
      at[j] += std::min(std::max(step, -1.0), 1.0);
    }
    return worst;
  }

  // The best row of shortest motions of joints that are not stopped; whether it has the pose.
  static bool newton(const double* from, const Eigen::Isometry3d& pose, const bool* stopped, double* row) noexcept {
    double error = kInfinity, tried[kDof];
    std::copy_n(from, kDof, row);
    std::copy_n(from, kDof, tried);
    for (int i = 0; i < 30; ++i) {
      double before[kDof];
      std::copy_n(tried, kDof, before);
      const double here = move(tried, pose, stopped, kDamping);
      const bool slow = !(here < 0.5 * error);
      if (here < error) {
        error = here;
        std::copy_n(before, kDof, row);
      }
      if ((slow && i > 2) || error < Arm::Policy::kConverged) break;
    }
    return error < Arm::Policy::kArrived;
  }
};

}  // namespace ikgen_runtime
