// The file's own chain, T = F_0 M(v_1) F_1 ... M(v_n) F_n: M turns about or moves along z, v = scale * q[joint] +
// offset.
#pragma once

#include <cmath>
#include <cstddef>
#include <type_traits>
#include <utility>

#include "arm/rigid_frame.hpp"
#include "arrays/lane_sines.hpp"
#include "arrays/small_matrix.hpp"

namespace ikgen_runtime {

struct Motion {
  int joint;
  bool revolute;
  double scale, offset;
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

// Arm: kDof; kMotions, the M of the chain; kFrames, the upper rows of the F. Of one configuration (X: double), or of those in
// lanes.
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

  template <class X> static FrameOf<X> forward(const X* q) noexcept {
    FrameOf<X> T = first<X>();
    advance(T, q, [](std::size_t, const FrameOf<X>&) noexcept {}, kAll);
    return T;
  }

  // Tip frame and geometric Jacobian, linear rows first.
  template <class X> [[gnu::noinline]] static FrameOf<X> forward(const X* q, X (&J)[6][Arm::kDof]) noexcept {
    X axes[kCount][3], origins[kCount][3];
    FrameOf<X> T = first<X>();
    const auto keep = [&](std::size_t i, const FrameOf<X>& at) noexcept {
      for (int r = 0; r < 3; ++r) {
        axes[i][r] = Arm::kMotions[i].scale * at.R[r][2];
        origins[i][r] = at.p[r];
      }
    };
    advance(T, q, keep, kAll);
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

  // The geometric Jacobian, columns first.
  static void jacobian(const double* q, double* out) noexcept {
    double J[6][Arm::kDof];
    forward(q, J);
    for (int j = 0; j < Arm::kDof; ++j)
      for (int r = 0; r < 6; ++r) out[6 * j + r] = J[r][j];
  }

 private:
  static constexpr auto kAll = std::make_index_sequence<static_cast<std::size_t>(kCount)>();

  // Cosines and sines of what turns, and how far what slides moves.
  template <class X> struct Turns {
    static constexpr bool kPack = !std::is_same_v<X, double>;
    static constexpr int kWide = kPack ? kCount : (kCount + 3) / 4 * 4;
    static constexpr double kReduced = 1e5;  // rad: so far `sines` reduces an angle to all digits
    X value[kWide] = {}, cosine[kWide], sine[kWide];

    explicit Turns(const X* q) noexcept {
      for (int i = 0; i < kCount; ++i) {
        value[i] = Arm::kMotions[i].scale * q[Arm::kMotions[i].joint] + Arm::kMotions[i].offset;
        if constexpr (kPack)
          if (Arm::kMotions[i].revolute) turn_to(value[i], cosine[i], sine[i]);
      }
      if constexpr (!kPack) turn_all();
    }

   private:
    // Those of one configuration, several joints at once.
    void turn_all() noexcept {
      for (int i = 0; i < kWide; i += 4) {
        const Sines<4> pair = sines(load<4>(value + i));
        store(pair.cosine, cosine + i);
        store(pair.sine, sine + i);
      }
      for (int i = 0; i < kCount; ++i)
        if (!(std::abs(value[i]) < kReduced)) cosine[i] = std::cos(value[i]), sine[i] = std::sin(value[i]);
    }
  };

  // Column C of (x, y, z) times the constant behind motion I, most of whose entries are 0.
  template <std::size_t I, int C, class X> [[gnu::always_inline]] static X mixed(const X& x, const X& y, const X& z) noexcept {
    const double a = Arm::kFrames[I + 1][0][C], b = Arm::kFrames[I + 1][1][C], c = Arm::kFrames[I + 1][2][C];
    if (a == 0.0 && b == 0.0) return c * z;
    if (a == 0.0) return c == 0.0 ? b * y : b * y + c * z;
    if (b == 0.0) return c == 0.0 ? a * x : a * x + c * z;
    return c == 0.0 ? a * x + b * y : a * x + b * y + c * z;
  }

  // Moves along motion I by its joint, then by the constant behind it.
  template <std::size_t I, class X> [[gnu::always_inline]] static void advance(FrameOf<X>& T, const Turns<X>& turns) noexcept {
    constexpr Motion motion = Arm::kMotions[I];
    for (int r = 0; r < 3; ++r) {
      X x = T.R[r][0], y = T.R[r][1], p = T.p[r];
      const X z = T.R[r][2];
      if constexpr (motion.revolute) {
        x = turns.cosine[I] * T.R[r][0] + turns.sine[I] * T.R[r][1];
        y = turns.cosine[I] * T.R[r][1] - turns.sine[I] * T.R[r][0];
      } else {
        p = p + turns.value[I] * z;
      }
      T.p[r] = p + mixed<I, 3>(x, y, z);
      T.R[r][0] = mixed<I, 0>(x, y, z);
      T.R[r][1] = mixed<I, 1>(x, y, z);
      T.R[r][2] = mixed<I, 2>(x, y, z);
    }
  }

  // Along all motions; `before` is told of each and the frame in which it turns or moves.
  template <class X, class Before, std::size_t... I>
  static void advance(FrameOf<X>& T, const X* q, const Before& before, std::index_sequence<I...>) noexcept {
    const Turns<X> turns(q);
    ((before(I, T), advance<I>(T, turns)), ...);
  }
};

}  // namespace ikgen_runtime
