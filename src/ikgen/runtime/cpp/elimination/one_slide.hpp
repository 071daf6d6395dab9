#pragma once

#include <array>

#include "elimination/hidden_angle_run.hpp"
#include "elimination/method_in_runs.hpp"
#include "elimination/six_joint_arm.hpp"
#include "elimination/slide_loop.hpp"

namespace ikgen_runtime {

// --- one_slide: five revolute joints and a slide -------------------------------------------------------

namespace elimination {

inline Spectrum run_one_slide(const Chain& F, const Frame& T, const Frame& aim, const Turning& turning,
                              const std::array<int, 3>& plan, Solutions& out) noexcept {
  return run_slide_loop(F, aim, turning, plan, [&](const Loop& loop, const SlideEquations& eq, const auto& all) noexcept {
    return run_hidden_angle(F, T, turning, loop, plan, eq, all, out);
  });
}

}  // namespace elimination

using OneSlideMethod = elimination::InRuns<elimination::run_one_slide>;

// Arm: as for SixJointArm, its Plan with kEigenproblems (start, reverse, swap), in order of preference.
template <class Arm> struct OneSlide : SixJointArm<Arm, OneSlideMethod> {};

}  // namespace ikgen_runtime
