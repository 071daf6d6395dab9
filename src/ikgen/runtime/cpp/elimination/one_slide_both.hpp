#pragma once

#include <array>

#include "elimination/both_half_angles.hpp"
#include "elimination/method_in_runs.hpp"
#include "elimination/six_joint_arm.hpp"
#include "elimination/slide_loop.hpp"

namespace ikgen_runtime {

// --- one_slide_both: five revolute joints and a slide, by half angles of both angles beside the hidden one ----

namespace elimination {

inline Spectrum run_one_slide_both(const Chain& F, const Frame& T, const Frame& aim, const Turning& turning,
                                   const std::array<int, 3>& plan, Solutions& out) noexcept {
  return run_slide_loop(F, aim, turning, plan, [&](const Loop& loop, const SlideEquations& eq, const auto& all) noexcept {
    return run_both_half_angles(F, T, turning, loop, plan[1] != 0, eq, all, out);
  });
}

}  // namespace elimination

using OneSlideBothMethod = elimination::InRuns<elimination::run_one_slide_both>;

// Arm: as for OneSlide; its plans swap nothing.
template <class Arm> struct OneSlideBoth : SixJointArm<Arm, OneSlideBothMethod> {};

}  // namespace ikgen_runtime
