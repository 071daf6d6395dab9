// Damped Newton steps (Levenberg 1944, Marquardt 1963) on the file's own chain.
#pragma once

#include <algorithm>

#include "pose_error.hpp"
#include "refinement_course.hpp"

namespace ikgen_runtime {

// Arm: as for PoseError, and its Policy.
template <class Arm> struct NewtonRefinement {
  using Aim = HeldAim<Arm>;
  using Policy = typename Arm::Policy;

  // At a fold of the solution set damped steps halve the error.
  static void step(const PoseError<Arm>& at, double worst, double (&q)[Arm::kDof]) noexcept {
    const double bounded = std::min(worst, 1.0);
    double A[Arm::kDof][Arm::kDof], x[Arm::kDof];
    for (int i = 0; i < Arm::kDof; ++i) {
      for (int j = 0; j <= i; ++j) {
        A[i][j] = 0.0;
        for (int e = 0; e < at.kCount; ++e) A[i][j] += at.slope[e][i] * at.slope[e][j];
      }
      A[i][i] += std::max(Policy::kLeastDamping, Policy::kDamping * bounded * bounded);
      x[i] = 0.0;
      for (int e = 0; e < at.kCount; ++e) x[i] += at.slope[e][i] * at.error[e];
    }
    factor(A);
    substitute(A, x);
    for (int j = 0; j < Arm::kDof; ++j) q[j] += std::min(std::max(x[j], -Policy::kLargestStep), Policy::kLargestStep);
  }

  // The error that steps from q leave, of joints that do not stay `still` where that is given.
  static double error_after(double* q, const Aim& aim, const bool* still = nullptr) noexcept {
    double trial[Arm::kDof];
    std::copy_n(q, Arm::kDof, trial);
    for (RefinementCourse<Policy> course;;) {
      PoseError<Arm> at(trial, aim);
      if (still != nullptr) at.hold(still);
      const double worst = at.largest();
      if (course.takes(worst)) std::copy_n(trial, Arm::kDof, q);
      if (!course.starts_again())
        step(at, worst, trial);
      else if (course.done)
        return course.best;
      else
        std::copy_n(q, Arm::kDof, trial);
    }
  }

  // Whether they lead to the aim.
  static bool refine(double* q, const Aim& aim) noexcept {
    return error_after(q, aim) < Policy::kArrived;
  }
};

}  // namespace ikgen_runtime
