// The file's own chain, T = F_0 M(v_1) F_1 ... M(v_n) F_n: M turns about or moves along z, v = scale * q[joint] +
// offset.
#pragma once

#include <cmath>

#include "small_matrix.hpp"

namespace ikgen_runtime {

struct Motion {
  int joint;
  bool revolute;
  double scale, offset;
};

struct Frame {
  double R[3][3], p[3];
};

// A frame's matrix, columns first.
inline void by_columns(const Frame& T, double* t) noexcept {
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) t[4 * c + r] = T.R[r][c];
    t[12 + r] = T.p[r];
    t[4 * r + 3] = 0.0;
  }
  t[15] = 1.0;
}

// Arm: kDof; kMotions, the M of the chain; kFrames, the upper rows of the F.
template <class Arm> struct MotionChain {
  static constexpr int kCount = sizeof(Arm::kMotions) / sizeof(Motion);

  static Frame first() noexcept {
    Frame T;
    for (int r = 0; r < 3; ++r) {
      for (int k = 0; k < 3; ++k) T.R[r][k] = Arm::kFrames[0][r][k];
      T.p[r] = Arm::kFrames[0][r][3];
    }
    return T;
  }

  // Moves along motion i by its joint, then by the constant behind it.
  static void advance(Frame& T, int i, const double* q) noexcept {
    const Motion& motion = Arm::kMotions[i];
    const auto& F = Arm::kFrames[i + 1];
    const double v = motion.scale * q[motion.joint] + motion.offset;
    const double c = motion.revolute ? std::cos(v) : 1.0, s = motion.revolute ? std::sin(v) : 0.0;
    const double d = motion.revolute ? 0.0 : v;
    for (int r = 0; r < 3; ++r) {
      const double x = c * T.R[r][0] + s * T.R[r][1], y = c * T.R[r][1] - s * T.R[r][0], z = T.R[r][2];
      T.p[r] += d * z + (x * F[0][3] + y * F[1][3] + z * F[2][3]);
      for (int k = 0; k < 3; ++k) T.R[r][k] = x * F[0][k] + y * F[1][k] + z * F[2][k];
    }
  }

  static Frame forward(const double* q) noexcept {
    Frame T = first();
    for (int i = 0; i < kCount; ++i) advance(T, i, q);
    return T;
  }

  // Tip frame and geometric Jacobian, linear rows first.
  [[gnu::noinline]] static Frame forward(const double* q, double (&J)[6][Arm::kDof]) noexcept {
    double axes[kCount][3], origins[kCount][3];
    Frame T = first();
    for (int i = 0; i < kCount; ++i) {
      for (int r = 0; r < 3; ++r) {
        axes[i][r] = Arm::kMotions[i].scale * T.R[r][2];
        origins[i][r] = T.p[r];
      }
      advance(T, i, q);
    }
    for (auto& row : J)
      for (double& x : row) x = 0.0;
    for (int i = 0; i < kCount; ++i) {
      const int j = Arm::kMotions[i].joint;
      double linear[3] = {axes[i][0], axes[i][1], axes[i][2]};
      if (Arm::kMotions[i].revolute) {
        const double arm[3] = {T.p[0] - origins[i][0], T.p[1] - origins[i][1], T.p[2] - origins[i][2]};
        cross(axes[i], arm, linear);
        for (int r = 0; r < 3; ++r) J[3 + r][j] += axes[i][r];
      }
      for (int r = 0; r < 3; ++r) J[r][j] += linear[r];
    }
    return T;
  }
};

}  // namespace ikgen_runtime
