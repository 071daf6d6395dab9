#pragma once

#include <array>
#include <cstddef>

#include "arm/motion_chain.hpp"

namespace ikgen_runtime {

// An arm with one joint more: it turns about the tool's axis (0: x) through its origin, which a task that reads the
// position and the direction of that axis leaves open. Arm: kDof; kMotions; kFrames; kHeld.
template <class Arm, std::size_t Axis> struct WithToolJoint : Arm {
  static constexpr std::size_t kBefore = sizeof(Arm::kMotions) / sizeof(Motion);
  using Rows = std::array<std::array<double, 4>, 3>;

  static constexpr std::array<Motion, kBefore + 1> motions() noexcept {
    std::array<Motion, kBefore + 1> out{};
    for (std::size_t i = 0; i < kBefore; ++i) out[i] = Arm::kMotions[i];
    out[kBefore] = {Arm::kDof, true, 1.0, 0.0};
    return out;
  }

  static constexpr std::array<bool, Arm::kDof + 1> held() noexcept {
    std::array<bool, Arm::kDof + 1> out{};
    for (std::size_t j = 0; j < std::size_t{Arm::kDof}; ++j) out[j] = Arm::kHeld[j];
    return out;
  }

  // The axis becomes z in front of the joint, and itself behind it.
  static constexpr std::array<Rows, kBefore + 2> frames() noexcept {
    std::array<Rows, kBefore + 2> out{};
    for (std::size_t i = 0; i <= kBefore; ++i)
      for (std::size_t r = 0; r < 3; ++r)
        for (std::size_t c = 0; c < 4; ++c) {
          const bool turned = i == kBefore && c < 3;
          out[i][r][c] = Arm::kFrames[i][r][turned ? (c + Axis + 1) % 3 : c];
        }
    for (std::size_t r = 0; r < 3; ++r) out[kBefore + 1][r][(r + Axis + 1) % 3] = 1.0;
    return out;
  }

  static constexpr int kDof = Arm::kDof + 1;
  static constexpr std::array<Motion, kBefore + 1> kMotions = motions();
  static constexpr std::array<bool, Arm::kDof + 1> kHeld = held();
  static constexpr std::array<Rows, kBefore + 2> kFrames = frames();
};

}  // namespace ikgen_runtime
