// The file's own chain in lanes, as a frame `first` and links Rz(u) Tz(v) Tx(x) Ty(y) Rx(twist), then a frame `last`.
#pragma once

#include <cstddef>
#include <utility>

#include "arm/motion_chain.hpp"

namespace ikgen_runtime {

// A joint's motion, and four constants behind it. Of u and v the joint's own is scale * q[joint] + offset, the other 0
// but for a slide's u.
struct Link {
  int joint;
  bool revolute;
  double scale, offset, turn_cosine, turn_sine, x, y, twist_cosine, twist_sine;
};

template <int N> using LaneFrame = FrameOf<Lanes<N>>;

// Arm: kDof; kLinks; kFirst and kLast, the upper rows of the frames at the ends.
template <class Arm, int N> struct LaneChain {
  using Pack = Lanes<N>;
  static constexpr std::size_t kCount = sizeof(Arm::kLinks) / sizeof(Link);

  Pack q[Arm::kDof];
  Sines<N> angle[kCount];  // of the revolute motions
  LaneFrame<N> tip;
  Pack axis[kCount][3], origin[kCount][3];

  [[gnu::always_inline]] void start() noexcept { start(std::make_index_sequence<kCount>()); }

  // Adds d, at most 0.1 rad for what turns.
  [[gnu::always_inline]] void add(const Pack (&d)[Arm::kDof]) noexcept {
    for (int j = 0; j < Arm::kDof; ++j) q[j] = q[j] + d[j];
  }

  // Turns the angles by what was added.
  [[gnu::always_inline]] void turn(const Pack (&d)[Arm::kDof]) noexcept {
    turn(d, std::make_index_sequence<kCount>());
  }

  // Tip, axes and origins at q.
  [[gnu::always_inline]] void forward() noexcept { forward(std::make_index_sequence<kCount>()); }

  // The geometric Jacobian of the tip there, linear rows first.
  [[gnu::always_inline]] void jacobian(Pack (&J)[6][Arm::kDof]) const noexcept {
    add_columns(J, std::make_index_sequence<kCount>());
  }

 private:
  template <std::size_t... I> [[gnu::always_inline]] void start(std::index_sequence<I...>) noexcept {
    ((Arm::kLinks[I].revolute ? void(angle[I] = sines(value<I>())) : void()), ...);
  }

  template <std::size_t I> [[gnu::always_inline]] Pack value() const noexcept {
    constexpr Link link = Arm::kLinks[I];
    return link.scale * q[link.joint] + link.offset;
  }

  template <std::size_t... I>
  [[gnu::always_inline]] void turn(const Pack (&d)[Arm::kDof], std::index_sequence<I...>) noexcept {
    ((Arm::kLinks[I].revolute ? void(angle[I] = turned(angle[I], Arm::kLinks[I].scale * d[Arm::kLinks[I].joint])) : void()), ...);
  }

  template <std::size_t... I> [[gnu::always_inline]] void forward(std::index_sequence<I...>) noexcept {
    LaneFrame<N> T;
    for (int r = 0; r < 3; ++r) {
      for (int k = 0; k < 3; ++k) T.R[r][k] = spread<N>(Arm::kFirst[r][k]);
      T.p[r] = spread<N>(Arm::kFirst[r][3]);
    }
    (advance<I>(T), ...);
    for (int r = 0; r < 3; ++r) {
      const Pack x = T.R[r][0], y = T.R[r][1], z = T.R[r][2];
      tip.p[r] = T.p[r] + (x * Arm::kLast[0][3] + y * Arm::kLast[1][3] + z * Arm::kLast[2][3]);
      for (int k = 0; k < 3; ++k) tip.R[r][k] = x * Arm::kLast[0][k] + y * Arm::kLast[1][k] + z * Arm::kLast[2][k];
    }
  }

  template <std::size_t I> [[gnu::always_inline]] void advance(LaneFrame<N>& T) noexcept {
    constexpr Link link = Arm::kLinks[I];
    for (int r = 0; r < 3; ++r) {
      axis[I][r] = T.R[r][2];
      origin[I][r] = T.p[r];
      Pack x = T.R[r][0], y = T.R[r][1];
      const Pack z = T.R[r][2];
      if constexpr (link.revolute) {
        x = angle[I].cosine * T.R[r][0] + angle[I].sine * T.R[r][1];
        y = angle[I].cosine * T.R[r][1] - angle[I].sine * T.R[r][0];
      } else {
        x = link.turn_cosine * T.R[r][0] + link.turn_sine * T.R[r][1];
        y = link.turn_cosine * T.R[r][1] - link.turn_sine * T.R[r][0];
        T.p[r] = T.p[r] + value<I>() * z;
      }
      if constexpr (link.x != 0.0) T.p[r] = T.p[r] + link.x * x;
      if constexpr (link.y != 0.0) T.p[r] = T.p[r] + link.y * y;
      T.R[r][0] = x;
      if constexpr (link.twist_sine == 0.0 && link.twist_cosine == 1.0) {
        T.R[r][1] = y;
      } else {
        T.R[r][1] = link.twist_cosine * y + link.twist_sine * z;
        T.R[r][2] = link.twist_cosine * z - link.twist_sine * y;
      }
    }
  }

  template <std::size_t... I>
  [[gnu::always_inline]] void add_columns(Pack (&J)[6][Arm::kDof], std::index_sequence<I...>) const noexcept {
    (add_column<I>(J), ...);
  }

  template <std::size_t I> [[gnu::always_inline]] void add_column(Pack (&J)[6][Arm::kDof]) const noexcept {
    constexpr Link link = Arm::kLinks[I];
    for (int r = 0; r < 3; ++r) {
      const int u = (r + 1) % 3, v = (r + 2) % 3;
      Pack linear = axis[I][r], angular = spread<N>(0.0);
      if constexpr (link.revolute) {
        linear = axis[I][u] * (tip.p[v] - origin[I][v]) - axis[I][v] * (tip.p[u] - origin[I][u]);
        angular = axis[I][r];
      }
      add<I>(linear, J[r][link.joint]);
      add<I>(angular, J[3 + r][link.joint]);
    }
  }

  // Takes part in an entry of its joint's column, which begins with the joint's first link.
  template <std::size_t I> [[gnu::always_inline]] static void add(const Pack& x, Pack& entry) noexcept {
    constexpr Link link = Arm::kLinks[I];
    const Pack part = link.scale * x;
    entry = begins(I) ? part : entry + part;
  }

  static constexpr bool begins(std::size_t link) noexcept {
    for (std::size_t i = 0; i < link; ++i)
      if (Arm::kLinks[i].joint == Arm::kLinks[link].joint) return false;
    return true;
  }
};

}  // namespace ikgen_runtime
