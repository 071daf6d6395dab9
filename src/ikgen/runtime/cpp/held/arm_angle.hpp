// The arm angle, held in place of a joint: that of the half plane from the line through the shoulder and the pose's wrist
// through the row's elbow, counted about the direction to the wrist from the side of the first axis.
#pragma once

#include <algorithm>
#include <cmath>

#include "arm/held_aim.hpp"
#include "arm/motion_chain.hpp"

namespace ikgen_runtime {

// The shoulder's point, and directions from the line to the wrist: where the arm angle is 0, and a quarter turn on.
// Arm: Elbow, as for MotionChain, the chain of the first joints to the elbow; kShoulder, the shoulder's frame in the base,
// z along the first axis; kWrist, in the tip's frame; kUpperArm (m), shoulder to elbow.
template <class Arm> struct ElbowPlane {
  static constexpr double kOnAxis = 1e-8;  // distance of the wrist from the first axis, over that from the shoulder
  double x[3], y[3];

  explicit ElbowPlane(const Eigen::Isometry3d& pose) noexcept {
    const double* t = pose.matrix().data();  // columns first
    double d[3], w[3], size = 0.0;
    for (int r = 0; r < 3; ++r)
      d[r] = t[r] * Arm::kWrist[0] + t[4 + r] * Arm::kWrist[1] + t[8 + r] * Arm::kWrist[2] + t[12 + r] - Arm::kShoulder[r][3];
    for (int c = 0; c < 3; ++c) {
      w[c] = d[0] * Arm::kShoulder[0][c] + d[1] * Arm::kShoulder[1][c] + d[2] * Arm::kShoulder[2][c];
      size += w[c] * w[c];
    }
    size = std::max(std::sqrt(size), 1e-12);
    for (double& entry : w) entry /= size;
    const double off = std::hypot(w[0], w[1]), some = std::max(off, kOnAxis);
    const bool on = off <= kOnAxis;
    const double c = on ? 1.0 : w[0] / some, s = on ? 0.0 : w[1] / some;
    place(-c * w[2], -s * w[2], on ? 0.0 : off, x);
    place(s, -c, 0.0, y);
  }

  // Where the elbow is beside the line: along x and y.
  void beside(const double* p, double& along_x, double& along_y) const noexcept {
    along_x = along_y = 0.0;
    for (int r = 0; r < 3; ++r) {
      along_x += (p[r] - Arm::kShoulder[r][3]) * x[r];
      along_y += (p[r] - Arm::kShoulder[r][3]) * y[r];
    }
  }

 private:
  static void place(double a, double b, double c, double* out) noexcept {
    for (int r = 0; r < 3; ++r) out[r] = Arm::kShoulder[r][0] * a + Arm::kShoulder[r][1] * b + Arm::kShoulder[r][2] * c;
  }
};

// The pose, and the half plane that the elbow is to be in.
template <class Arm> struct HeldAim<Arm, true> {
  static constexpr int kCount = 1, kElbowJoints = Arm::Elbow::kDof;
  static constexpr std::size_t kAngle = Arm::kFree - 1;
  static constexpr double kBeyond = 1e-5;  // distance of the elbow from the line, to the other side, that counts
  Eigen::Isometry3d pose;
  double into[3], normal[3];  // the half plane from the line, and at right angles to it, over the upper arm

  HeldAim(const Eigen::Isometry3d& T, const std::array<double, Arm::kFree>& held) noexcept : pose(T) {
    const ElbowPlane<Arm> plane(T);
    const double c = std::cos(held.data()[kAngle]), s = std::sin(held.data()[kAngle]);
    for (int r = 0; r < 3; ++r) {
      into[r] = (c * plane.x[r] + s * plane.y[r]) / Arm::kUpperArm;
      normal[r] = (c * plane.y[r] - s * plane.x[r]) / Arm::kUpperArm;
    }
  }

  static HeldAim own(const double* q) noexcept {
    std::array<double, Arm::kFree> held;
    values(q, held);
    return HeldAim(pose_of(q), held);
  }

  static void values(const double* q, std::array<double, Arm::kFree>& held) noexcept {
    for (std::size_t k = 0; k < Arm::kFreeJoints.size(); ++k) held.data()[k] = q[Arm::kFreeJoints.data()[k]];
    const ElbowPlane<Arm> plane(pose_of(q));
    double x, y;
    plane.beside(MotionChain<typename Arm::Elbow>::forward(q).p, x, y);
    held.data()[kAngle] = std::atan2(y, x);
  }

  // How far the elbow is from the half plane, over the upper arm, and the slope of that by the joints.
  void compare(const double* q, double& error, double (&slope)[Arm::kDof]) const noexcept {
    double J[6][kElbowJoints];
    const Frame elbow = MotionChain<typename Arm::Elbow>::forward(q, J);
    double behind = 0.0;
    error = 0.0;
    for (int r = 0; r < 3; ++r) {
      error += normal[r] * (Arm::kShoulder[r][3] - elbow.p[r]);
      behind += into[r] * (Arm::kShoulder[r][3] - elbow.p[r]);
    }
    error += behind > kBeyond ? 1.0 : 0.0;
    for (int j = 0; j < Arm::kDof; ++j) {
      slope[j] = 0.0;
      for (int r = 0; r < 3 && j < kElbowJoints; ++r) slope[j] += normal[r] * J[r][j];
    }
  }

  // The slope of minus that by the arm angle.
  double turned(const double* q) const noexcept {
    const Frame elbow = MotionChain<typename Arm::Elbow>::forward(q);
    double behind = 0.0;
    for (int r = 0; r < 3; ++r) behind += into[r] * (Arm::kShoulder[r][3] - elbow.p[r]);
    return behind;
  }

 private:
  static Eigen::Isometry3d pose_of(const double* q) noexcept {
    Eigen::Isometry3d out;
    by_columns(MotionChain<Arm>::forward(q), out.matrix().data());
    return out;
  }
};

}  // namespace ikgen_runtime
