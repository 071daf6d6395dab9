// Damped Newton steps on the file's own chain.
#pragma once

#include <algorithm>

#include "newton/damped_step.hpp"
#include "arm/pose_error.hpp"
#include "newton/refinement_course.hpp"

namespace ikgen_runtime {

// Arm: as for PoseError, and its Policy.
template <class Arm> struct NewtonRefinement {
  using Aim = HeldAim<Arm>;
  using Policy = typename Arm::Policy;

  // The error that steps from q leave, of joints that do not stay `still` where that is given.
  static double error_after(double* q, const Aim& aim, const bool* still = nullptr) noexcept {
    double trial[Arm::kDof];
    std::copy_n(q, Arm::kDof, trial);
    for (RefinementCourse<Policy> course;;) {
      PoseError<Arm> at(trial, aim);
      if (still != nullptr) at.hold(still);
      const double worst = at.largest();
      if (course.takes(worst)) std::copy_n(trial, Arm::kDof, q);
      if (course.starts_again()) {
        if (course.done) return course.best;
        std::copy_n(q, Arm::kDof, trial);
      } else {
        double step[Arm::kDof];
        damped_step<Policy>(at.slope, at.error, worst, step);
        for (int j = 0; j < Arm::kDof; ++j) trial[j] += step[j];
      }
    }
  }

  // Whether they lead to the aim.
  static bool refine(double* q, const Aim& aim) noexcept {
    return error_after(q, aim) < Policy::kArrived;
  }
};

}  // namespace ikgen_runtime
