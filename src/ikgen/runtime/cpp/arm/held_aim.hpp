#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Geometry>

namespace ikgen_runtime {

// What rows are refined towards: a pose. Arm: kDof, kFree, kFreeJoints; kArmAngle, whether the arm angle is held after
// the joints: then arm_angle.hpp has the rest.
template <class Arm, bool kAngle = Arm::kArmAngle> struct HeldAim {
  static constexpr int kCount = 0;  // errors beside the pose's
  Eigen::Isometry3d pose;

  HeldAim(const Eigen::Isometry3d& T, const std::array<double, Arm::kFree>&) noexcept : pose(T) {}
  explicit HeldAim(const Eigen::Isometry3d& T) noexcept : pose(T) {}

  // An aim for taking derivatives alone; its pose is arbitrary.
  static HeldAim own(const double*) noexcept { return HeldAim(Eigen::Isometry3d::Identity()); }

  // What a configuration has of the values that are held.
  static void values(const double* q, std::array<double, Arm::kFree>& held) noexcept {
    for (std::size_t k = 0; k < Arm::kFreeJoints.size(); ++k) held.data()[k] = q[Arm::kFreeJoints.data()[k]];
  }
};

}  // namespace ikgen_runtime
