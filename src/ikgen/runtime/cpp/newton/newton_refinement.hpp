// Damped Newton steps on the file's own chain.
#pragma once

#include "arm/pose_error.hpp"
#include "newton/damped_newton.hpp"

namespace ikgen_runtime {

// Arm: as for PoseError, and its Policy.
template <class Arm> struct NewtonRefinement {
  using Aim = HeldAim<Arm>;
  using Policy = typename Arm::Policy;

  // The error that steps from q leave, of joints that do not stay `still` where that is given.
  static double error_after(double* q, const Aim& aim, const bool* still = nullptr) noexcept {
    return damped_newton<Policy, Arm::kDof>(q, [&](const double* trial) {
      PoseError<Arm> at(trial, aim);
      if (still != nullptr) at.hold(still);
      return at;
    });
  }

  // Whether they lead to the aim.
  static bool refine(double* q, const Aim& aim) noexcept {
    return error_after(q, aim) < Policy::kArrived;
  }
};

}  // namespace ikgen_runtime
