#pragma once

#include "arrays/lanes.hpp"

namespace ikgen_runtime {

// The task of the whole pose: position, then rotation; of one configuration (X: double), or of those in lanes.
template <class Arm> struct WholePose {
  static constexpr int kCount = 6;
  static constexpr bool kPosition = true;  // is read

  // t: the rows of the pose; T: the tip's frame.
  template <class X, class Tip>
  [[gnu::always_inline]] static void error(const X (&t)[3][4], const Tip& T, X* error) noexcept {
    X S[3][3];
    for (int i = 0; i < 3; ++i) {
      error[i] = (t[i][3] - T.p[i]) / Arm::kSize;
      for (int k = 0; k < 3; ++k) S[i][k] = t[i][0] * T.R[k][0] + t[i][1] * T.R[k][1] + t[i][2] * T.R[k][2];
    }
    const X flipped = select(1.0 > S[0][0] + S[1][1] + S[2][2], 1.0, 0.0);  // more than a right angle off
    error[3] = 0.5 * (S[2][1] - S[1][2]) + flipped;
    error[4] = 0.5 * (S[0][2] - S[2][0]) + flipped;
    error[5] = 0.5 * (S[1][0] - S[0][1]) + flipped;
  }

  // J: the tip's geometric Jacobian.
  template <class X, class Tip>
  [[gnu::always_inline]] static void slope(const Tip&, const X (&J)[6][Arm::kDof], X (*slope)[Arm::kDof]) noexcept {
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < Arm::kDof; ++j) slope[i][j] = i < 3 ? J[i][j] / Arm::kSize : J[i][j];
  }
};

}  // namespace ikgen_runtime
