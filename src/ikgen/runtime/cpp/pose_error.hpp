#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "motion_chain.hpp"

namespace ikgen_runtime {

// Error of a configuration, lengths over the arm's size, and its slope by the joints that move.
// Arm: as for MotionChain; Task, WholePose or PoseEntries; kFreeJoints, which are held; kSize (m).
template <class Arm> struct PoseError {
  static constexpr int kCount = Arm::Task::kCount;
  double error[kCount], slope[kCount][Arm::kDof];

  PoseError(const double* q, const Eigen::Isometry3d& pose) noexcept {
    double J[6][Arm::kDof];
    const Frame T = MotionChain<Arm>::forward(q, J);
    double t[3][4];
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c) t[r][c] = pose.matrix().data()[4 * c + r];
    Arm::Task::error(t, T, error);
    Arm::Task::slope(T, J, slope);
    for (const int j : Arm::kFreeJoints)
      for (auto& row : slope) row[j] = 0.0;
  }

  double largest() const noexcept {
    double worst = 0.0;
    for (const double x : error) worst = std::abs(x) <= worst ? worst : std::abs(x);
    return worst;
  }
};

}  // namespace ikgen_runtime
