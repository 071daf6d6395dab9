// How far elbows are from the half plane of the arm angle, in lanes.
#pragma once

#include "held/arm_angle.hpp"
#include "arm/lane_aim.hpp"
#include "arrays/lane_sines.hpp"
#include "rows/lane_rows.hpp"

namespace ikgen_runtime {

// Arm: as for HeldAim at an arm angle.
template <class Arm, int N> struct LaneAim<Arm, N, true> {
  using Pack = Lanes<N>;
  using Aim = HeldAim<Arm>;
  static constexpr int kCount = 1, kJoints = Aim::kElbowJoints;

  // Of P poses, again and again.
  template <int P> LaneAim(const Pose<P>& pose, const std::array<double, Arm::kFree>& held) noexcept {
    alignas(64) double t[3][4][std::size_t{P}], in[3][std::size_t{P}], across[3][std::size_t{P}];
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c) store(pose.t[r][c], t[r][c]);
    for (int p = 0; p < P; ++p) {
      Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 4; ++c) T.matrix().data()[4 * c + r] = t[r][c][p];
      const Aim aim(T, held);
      for (int r = 0; r < 3; ++r) {
        in[r][p] = aim.into[r];
        across[r][p] = aim.normal[r];
      }
    }
    for (int r = 0; r < 3; ++r) {
      into[r] = spread<N>(load<P>(in[r]));
      normal[r] = spread<N>(load<P>(across[r]));
    }
  }

  [[gnu::always_inline]] void start(const Pack (&q)[Arm::kDof]) noexcept {
    for (int i = 0; i < kJoints; ++i) angle[i] = sines(motion(i).scale * q[motion(i).joint] + motion(i).offset);
  }

  // Adds d, at most 0.1 rad.
  [[gnu::always_inline]] void move(const Pack (&d)[Arm::kDof]) noexcept {
    for (int i = 0; i < kJoints; ++i) angle[i] = turned(angle[i], motion(i).scale * d[motion(i).joint]);
  }

  // As HeldAim::compare, from the elbow back to the base: how it moves with each joint goes along.
  [[gnu::always_inline]] void compare(Pack& error, Pack (&slope)[Arm::kDof]) const noexcept {
    Pack p[3], d[kJoints][3];
    for (int r = 0; r < 3; ++r) p[r] = spread<N>(Elbow::kFrames[kJoints][r][3]);
    for (int i = kJoints - 1; i >= 0; --i) {
      turn(angle[i], p);
      for (int k = i + 1; k < kJoints; ++k) turn(angle[i], d[k]);
      d[i][0] = -motion(i).scale * p[1];
      d[i][1] = motion(i).scale * p[0];
      d[i][2] = spread<N>(0.0);
      for (int k = i; k < kJoints; ++k) place(Elbow::kFrames[i], 0.0, d[k]);
      place(Elbow::kFrames[i], 1.0, p);
    }
    Pack behind = spread<N>(0.0);
    error = behind;
    for (int j = 0; j < Arm::kDof; ++j) slope[j] = spread<N>(0.0);
    for (int r = 0; r < 3; ++r) {
      const Pack missed = Arm::kShoulder[r][3] - p[r];
      error = error + normal[r] * missed;
      behind = behind + into[r] * missed;
      for (int k = 0; k < kJoints; ++k) slope[motion(k).joint] = slope[motion(k).joint] + normal[r] * d[k][r];
    }
    error = error + select(behind > Aim::kBeyond, 1.0, 0.0);
  }

 private:
  using Elbow = typename Arm::Elbow;
  Pack into[3], normal[3];
  Sines<N> angle[kJoints];

  static constexpr Motion motion(int i) noexcept { return Elbow::kMotions[i]; }

  [[gnu::always_inline]] static void turn(const Sines<N>& by, Pack (&v)[3]) noexcept {
    const Pack x = by.cosine * v[0] - by.sine * v[1];
    v[1] = by.sine * v[0] + by.cosine * v[1];
    v[0] = x;
  }

  // Into the frame before; `share` of its origin.
  [[gnu::always_inline]] static void place(const double (&F)[3][4], double share, Pack (&v)[3]) noexcept {
    Pack out[3];
    for (int r = 0; r < 3; ++r) out[r] = (F[r][0] * v[0] + F[r][1] * v[1]) + (F[r][2] * v[2] + share * F[r][3]);
    for (int r = 0; r < 3; ++r) v[r] = out[r];
  }
};

}  // namespace ikgen_runtime
