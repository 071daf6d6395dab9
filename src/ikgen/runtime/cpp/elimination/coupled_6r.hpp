#pragma once

#include "elimination/coupled_resultant.hpp"
#include "elimination/coupled_run.hpp"
#include "elimination/general_6r_pairs.hpp"
#include "elimination/six_joint_arm.hpp"

namespace ikgen_runtime {

// --- coupled_6r: six revolute joints of which one turns several axes --------------------------------------
// The angle of that joint is hidden in the elimination of Raghavan & Roth (1990). At an angle of it five joints are
// left, whose loop closes where the twelve equations without three of them are singular. What is coupled lies in the
// links behind the second, third and fourth of the five, so that the null spaces by which the three are eliminated are
// the same for all angles, and the determinant is a trigonometric polynomial.

namespace elimination {

struct TwelveEquations {
  static double determinant(const Pencil& of) noexcept {
    Square M = matrix(of);
    return signed_determinant(M);
  }
  static Pairs pairs(const Pencil& of) noexcept { return find_pairs(matrix(of)); }
  static Square matrix(const Pencil& of) noexcept { return lift(of).at(1.0, 0.0); }
};

// All that a run by lanes is sure of, else what runs one angle at a time agree on.
struct CoupledMethod {
  template <class Plan>
  static bool solve(const CoupledChain<Plan>& F, const Frame& T, const Turning& turning, Solutions& out) noexcept {
    Solutions blurred;
    const bool sure = solve_resultant<run_coupled_resultant<Plan>>(F, T, Plan::kEigenproblems, false, blurred, out) ||
                      solve_in_runs<run_coupled<Plan, TwelveEquations>>(F, T, turning, Plan::kEigenproblems, out);
    take_blurred(blurred, out);
    return sure;
  }
};

}  // namespace elimination

// Arm: as for SixJointArm, its Plan as for CoupledChain.
template <class Arm, class Plan = typename Arm::Plan>
struct Coupled6r : SixJointArm<Arm, elimination::CoupledMethod, elimination::CoupledChain<Plan>> {};

}  // namespace ikgen_runtime
