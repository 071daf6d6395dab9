#pragma once

#include "elimination/general_6r_runs.hpp"

namespace ikgen_runtime {

namespace elimination {

// The method of a SixJointArm whose Plan has kEigenproblems (start, reverse, swap), in order of preference.
template <auto Run> struct InRuns {
  template <class Plan, class Frames>
  static bool solve(const Frames& F, const Frame& T, const Turning& turning, Solutions& out) noexcept {
    return solve_in_runs<Run>(F, T, turning, Plan::kEigenproblems, out);
  }
};

}  // namespace elimination
}  // namespace ikgen_runtime
