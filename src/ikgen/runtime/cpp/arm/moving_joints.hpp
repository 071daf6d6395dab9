#pragma once

#include <array>

namespace ikgen_runtime {

// The joints that are not held. Arm: kDof; kFreeJoints; kHeld, a flag a joint.
template <class Arm> struct MovingJoints {
  static constexpr int kCount = Arm::kDof - static_cast<int>(Arm::kFreeJoints.size());
  int joint[kCount] = {};

  constexpr MovingJoints() noexcept {
    for (int j = 0, k = 0; j < Arm::kDof; ++j)
      if (!Arm::kHeld[j]) joint[k++] = j;
  }
  constexpr int operator[](int k) const noexcept { return joint[k]; }

  // Their columns of a matrix.
  template <class X, int Rows> void columns(const X (&of)[Rows][Arm::kDof], X (&out)[Rows][kCount]) const noexcept {
    for (int r = 0; r < Rows; ++r)
      for (int k = 0; k < kCount; ++k) out[r][k] = of[r][joint[k]];
  }
};

// An arm all of whose joints move.
template <class Arm> struct AllMoving : Arm {
  static constexpr int kFree = 0;
  static constexpr std::array<int, 0> kFreeJoints = {};
  static constexpr bool kHeld[Arm::kDof] = {}, kArmAngle = false;
  static constexpr int kRank = Arm::kWholePose ? Arm::kFreedoms : Arm::kDof - Arm::kFree;  // what the task fixes, or less
};

}  // namespace ikgen_runtime
