#pragma once

#include "motion_chain.hpp"

namespace ikgen_runtime {

// The task of the whole pose: position, then rotation. t: the pose's matrix, columns first.
template <class Arm> struct WholePose {
  static constexpr int kCount = 6;

  static void compare(const double* t, const Frame& T, const double (&J)[6][Arm::kDof], double (&error)[6],
                      double (&slope)[6][Arm::kDof]) noexcept {
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
};

}  // namespace ikgen_runtime
