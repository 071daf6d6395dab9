// What rows in lanes are refined towards beside the pose.
#pragma once

#include <array>

#include "arrays/lanes.hpp"

namespace ikgen_runtime {

// Arm: as for HeldAim; where the arm angle is held lane_elbow.hpp has the rest.
template <class Arm, int N, bool kAngle = Arm::kArmAngle> struct LaneAim {
  static constexpr int kCount = 0;  // errors beside the pose's

  template <class Poses> LaneAim(const Poses&, const std::array<double, Arm::kFree>&) noexcept {}

  void start(const Lanes<N> (&)[Arm::kDof]) noexcept {}
  void move(const Lanes<N> (&)[Arm::kDof]) noexcept {}
};

}  // namespace ikgen_runtime
