#pragma once

#include "pose_error.hpp"

namespace ikgen_runtime {

// Arm: as for PoseError, and kFree, how many joints are held.
template <class Arm> struct RankLoss {
  static constexpr int kMoving = Arm::kDof - Arm::kFree, kEquations = PoseError<Arm>::kCount;
  static constexpr bool kTall = kMoving < kEquations;

  // Whether the slope at q has a singular value below `bound`.
  static bool below(const double* q, double bound) noexcept {
    const PoseError<Arm> at(q, Eigen::Isometry3d::Identity());
    double V[kTall ? kMoving : kEquations][kTall ? kEquations : kMoving];
    for (int e = 0; e < kEquations; ++e)
      for (int j = 0, k = 0; j < Arm::kDof; ++j) {
        if (Arm::kHeld[j]) continue;
        V[kTall ? k : e][kTall ? e : k] = at.slope[e][j];
        ++k;
      }
    return !clearly_regular(V, bound) && least_singular_square(V) < bound * bound;
  }
};

}  // namespace ikgen_runtime
