// The file's own chain, T = F_0 M(v_1) F_1 ... M(v_n) F_n: M turns about or moves along z, v = scale * q[joint] +
// offset.
#pragma once

#include <cmath>
#include <type_traits>

#include "lane_sines.hpp"
#include "small_matrix.hpp"

namespace ikgen_runtime {

struct Motion {
  int joint;
  bool revolute;
  double scale, offset;
};

template <class X> struct FrameOf {  // X: double, or lanes
  X R[3][3], p[3];
};
using Frame = FrameOf<double>;

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

  template <class X = double> static FrameOf<X> first() noexcept {
    FrameOf<X> T;
    for (int r = 0; r < 3; ++r) {
      for (int k = 0; k < 3; ++k) T.R[r][k] = constant<X>(Arm::kFrames[0][r][k]);
      T.p[r] = constant<X>(Arm::kFrames[0][r][3]);
    }
    return T;
  }

  // Moves along motion i by its joint, then by the constant behind it.
  template <class X> static void advance(FrameOf<X>& T, int i, const X* q) noexcept {
    const Motion& motion = Arm::kMotions[i];
    const auto& F = Arm::kFrames[i + 1];
    const X v = motion.scale * q[motion.joint] + motion.offset;
    X c = constant<X>(1.0), s = constant<X>(0.0), d = v;
    if (motion.revolute) turn_by(v, c, s, d);
    for (int r = 0; r < 3; ++r) {
      const X x = c * T.R[r][0] + s * T.R[r][1], y = c * T.R[r][1] - s * T.R[r][0], z = T.R[r][2];
      T.p[r] = T.p[r] + (d * z + (x * F[0][3] + y * F[1][3] + z * F[2][3]));
      for (int k = 0; k < 3; ++k) T.R[r][k] = x * F[0][k] + y * F[1][k] + z * F[2][k];
    }
  }

  static Frame forward(const double* q) noexcept {
    Frame T = first();
    for (int i = 0; i < kCount; ++i) advance(T, i, q);
    return T;
  }

  // Tip frame and geometric Jacobian, linear rows first.
  template <class X> [[gnu::noinline]] static FrameOf<X> forward(const X* q, X (&J)[6][Arm::kDof]) noexcept {
    X axes[kCount][3], origins[kCount][3];
    FrameOf<X> T = first<X>();
    for (int i = 0; i < kCount; ++i) {
      for (int r = 0; r < 3; ++r) {
        axes[i][r] = Arm::kMotions[i].scale * T.R[r][2];
        origins[i][r] = T.p[r];
      }
      advance(T, i, q);
    }
    for (auto& row : J)
      for (X& x : row) x = constant<X>(0.0);
    for (int i = 0; i < kCount; ++i) {
      const int j = Arm::kMotions[i].joint;
      X linear[3] = {axes[i][0], axes[i][1], axes[i][2]};
      if (Arm::kMotions[i].revolute) {
        const X arm[3] = {T.p[0] - origins[i][0], T.p[1] - origins[i][1], T.p[2] - origins[i][2]};
        cross(axes[i], arm, linear);
        for (int r = 0; r < 3; ++r) J[3 + r][j] = J[3 + r][j] + axes[i][r];
      }
      for (int r = 0; r < 3; ++r) J[r][j] = J[r][j] + linear[r];
    }
    return T;
  }

 private:
  template <class X> static X constant(double x) noexcept {
    if constexpr (std::is_same_v<X, double>) {
      return x;
    } else {
      return spread<kWidth<X>>(x);
    }
  }

  // The cosine and sine of what turns, and no distance.
  template <class X> static void turn_by(const X& v, X& c, X& s, X& d) noexcept {
    if constexpr (std::is_same_v<X, double>) {
      c = std::cos(v);
      s = std::sin(v);
    } else {
      const auto both = sines(v);
      c = both.cosine;
      s = both.sine;
    }
    d = constant<X>(0.0);
  }
};

}  // namespace ikgen_runtime
