#pragma once

#include <Eigen/Geometry>

#include "motion_chain.hpp"

namespace ikgen_runtime {

// An entry of the pose that the task reads.
struct Entry {
  int row, column;
};

// Error of a configuration, lengths over the arm's size, and its slope by the joints that move.
// Arm: as for MotionChain; kWholePose; kRead, the entries that are read; kFreeJoints, which are held; kSize (m).
template <class Arm> struct PoseError {
  static constexpr int kCount = Arm::kWholePose ? 6 : sizeof(Arm::kRead) / sizeof(Entry);
  double error[kCount], slope[kCount][Arm::kDof];

  PoseError(const double* q, const Eigen::Isometry3d& pose) noexcept {
    const double* t = pose.matrix().data();  // columns first
    double J[6][Arm::kDof];
    const Frame T = MotionChain<Arm>::forward(q, J);
    if constexpr (Arm::kWholePose) {
      compare_all(t, T, J);
    } else {
      compare_read(t, T, J);
    }
    for (const int j : Arm::kFreeJoints)
      for (auto& row : slope) row[j] = 0.0;
  }

  double largest() const noexcept {
    double worst = 0.0;
    for (const double x : error) worst = std::abs(x) <= worst ? worst : std::abs(x);
    return worst;
  }

 private:
  void compare_all(const double* t, const Frame& T, const double (&J)[6][Arm::kDof]) noexcept {
    double S[3][3];
    for (int i = 0; i < 3; ++i) {
      error[i] = (t[12 + i] - T.p[i]) / Arm::kSize;
      for (int k = 0; k < 3; ++k) S[i][k] = t[i] * T.R[k][0] + t[4 + i] * T.R[k][1] + t[8 + i] * T.R[k][2];
    }
    const double flipped = S[0][0] + S[1][1] + S[2][2] < 1.0 ? 1.0 : 0.0;  // more than a right angle off
    error[3] = 0.5 * (S[2][1] - S[1][2]) + flipped;
    error[4] = 0.5 * (S[0][2] - S[2][0]) + flipped;
    error[5] = 0.5 * (S[1][0] - S[0][1]) + flipped;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < Arm::kDof; ++j) slope[i][j] = i < 3 ? J[i][j] / Arm::kSize : J[i][j];
  }

  void compare_read(const double* t, const Frame& T, const double (&J)[6][Arm::kDof]) noexcept {
    for (int i = 0; i < kCount; ++i) {
      const auto [r, c] = Arm::kRead[i];
      const int u = (r + 1) % 3, v = (r + 2) % 3;
      const bool length = c == 3;
      error[i] = length ? (t[12 + r] - T.p[r]) / Arm::kSize : t[4 * c + r] - T.R[r][c];
      for (int j = 0; j < Arm::kDof; ++j)
        slope[i][j] = length ? J[r][j] / Arm::kSize : J[3 + u][j] * T.R[v][c] - J[3 + v][j] * T.R[u][c];
    }
  }
};

}  // namespace ikgen_runtime
