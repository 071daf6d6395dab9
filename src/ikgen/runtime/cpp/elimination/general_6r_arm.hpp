#pragma once

#include "elimination/general_6r.hpp"
#include "elimination/six_joint_arm.hpp"

namespace ikgen_runtime {

// --- general_6r: the elimination for an arm, its held joints at given values -------------------------

struct General6rMethod {
  template <class Plan>
  static bool solve(const elimination::Chain& F, const Frame& T, const elimination::Turning&, elimination::Solutions& out) noexcept {
    return elimination::solve_6r<Plan>(F, T, out);
  }
};

// Arm: as for SixJointArm, its Plan as for general_6r.
template <class Arm> struct General6r : SixJointArm<Arm, General6rMethod> {};

}  // namespace ikgen_runtime
