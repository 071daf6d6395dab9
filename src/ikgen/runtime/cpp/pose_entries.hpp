#pragma once

#include "motion_chain.hpp"

namespace ikgen_runtime {

// A task that reads some entries of the pose, Arm::kRead. t: the pose's matrix, columns first.
template <class Arm> struct PoseEntries {
  static constexpr int kCount = sizeof(Arm::kRead) / sizeof(Arm::kRead[0]);

  static void compare(const double* t, const Frame& T, const double (&J)[6][Arm::kDof], double (&error)[kCount],
                      double (&slope)[kCount][Arm::kDof]) noexcept {
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
