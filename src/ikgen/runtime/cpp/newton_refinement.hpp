// Damped Newton steps (Levenberg 1944, Marquardt 1963) on the file's own chain.
#pragma once

#include <algorithm>

#include "constants.hpp"
#include "pose_error.hpp"

namespace ikgen_runtime {

// At most `steps` steps for what is off by at least `fine` and less than `promising` once the stage before is done.
struct RefineStage {
  int steps;
  double fine, promising;
};

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

  // At most `steps` of them, of joints that do not stay `still` where that is given; the error that is left.
  static double run(double* q, const Aim& aim, int steps, const bool* still) noexcept {
    double trial[Arm::kDof], best = kInfinity;
    std::copy_n(q, Arm::kDof, trial);
    for (int i = 0, stalled = 0;; ++i) {
      PoseError<Arm> at(trial, aim);
      if (still != nullptr) at.hold(still);
      const double worst = at.largest();
      stalled = worst < Policy::kProgress * best && worst > Policy::kConverged ? 0 : stalled + 1;
      if (worst < best) {
        best = worst;
        std::copy_n(trial, Arm::kDof, q);
      }
      if (i == steps || stalled == Policy::kPatience || !(best > Policy::kConverged)) return best;
      step(at, worst, trial);
    }
  }

  // The error that steps from q leave: only what is promising takes many. All digits are wanted where they
  // come easily, as rows may lie on a limit.
  static double error_after(double* q, const Aim& aim, const bool* still = nullptr) noexcept {
    double error = kInfinity;
    for (const RefineStage& stage : Policy::kRefinement) {
      error = run(q, aim, stage.steps, still);
      if (!(error >= stage.fine && error < stage.promising)) break;
    }
    return error;
  }

  // Whether they lead to the aim.
  static bool refine(double* q, const Aim& aim) noexcept {
    return error_after(q, aim) < Policy::kArrived;
  }
};

}  // namespace ikgen_runtime
