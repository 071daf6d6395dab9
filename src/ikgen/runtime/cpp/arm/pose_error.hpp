#pragma once

#include "arm/held_aim.hpp"
#include "arm/motion_chain.hpp"
#include "arrays/small_matrix.hpp"

namespace ikgen_runtime {

// Error of a configuration, lengths over the arm's size, and its slope by the joints that move.
// Arm: as for MotionChain and HeldAim; Task, WholePose or PoseEntries; kSize (m).
template <class Arm> struct PoseError {
  using Aim = HeldAim<Arm>;
  static constexpr int kTask = Arm::Task::kCount, kCount = kTask + Aim::kCount;
  double error[kCount], slope[kCount][Arm::kDof];

  PoseError(const double* q, const Aim& aim) noexcept {
    double J[6][Arm::kDof];
    const Frame T = MotionChain<Arm>::forward(q, J);
    double t[3][4];
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c) t[r][c] = aim.pose.matrix().data()[4 * c + r];
    Arm::Task::error(t, T, error);
    Arm::Task::slope(T, J, slope);
    if constexpr (Aim::kCount > 0) aim.compare(q, error[kTask], slope[kTask]);
    for (const int j : Arm::kFreeJoints)
      for (auto& row : slope) row[j] = 0.0;
  }

  // Leaves joints out of the slope.
  void hold(const bool* still) noexcept {
    for (int j = 0; j < Arm::kDof; ++j)
      for (auto& row : slope) row[j] = still[j] ? 0.0 : row[j];
  }

  double largest() const noexcept {
    double worst = 0.0;
    for (const double x : error) worst = worse(worst, x);
    return worst;
  }
};

}  // namespace ikgen_runtime
