#pragma once

#include <array>
#include <cmath>

#include "elimination/coupled_resultant.hpp"
#include "elimination/general_6r_pairs.hpp"
#include "elimination/general_6r_runs.hpp"
#include "elimination/general_6r_spectrum.hpp"
#include "elimination/six_joint_arm.hpp"
#include "elimination/unit_circle_roots.hpp"

namespace ikgen_runtime {

// --- coupled_6r: six revolute joints of which one turns several axes --------------------------------------
// The angle of that joint is hidden in the elimination of Raghavan & Roth (1990). At an angle of it five joints are
// left, whose loop closes where the twelve equations without three of them are singular. What is coupled lies in the
// links behind the second, third and fourth of the five, so that the null spaces by which the three are eliminated are
// the same for all angles, and the determinant is a trigonometric polynomial.

namespace elimination {

// The twelve equations.
inline Square coupled_matrix(const Equations& eq) noexcept { return lift(make_pencil(eq.E, eq.left)).at(1.0, 0.0); }

inline double signed_determinant(Square& A) noexcept {
  std::array<Index, 12> pivot{};  // not all is written of a matrix that is singular
  double det = factor_by_rows(A, pivot);
  for (Index k = 0; k < 12; ++k) {
    if (pivot[k] != k) det = -det;
    if (A(k, k) < 0.0) det = -det;
  }
  return det;
}

template <class Plan>
inline Spectrum run_coupled(const CoupledChain<Plan>& F, const Frame& T, const Frame& aim, const Turning& turning,
                            const std::array<int, 3>& plan, Solutions& out) noexcept {
  constexpr Index degree = Plan::kDegree, nodes = 2 * degree + 2;
  constexpr double first = 0.05;  // rad, an angle that no right angle shares
  constexpr double real = 0.03;   // rad, the imaginary part of an angle that may be real
  Equations eq = eliminate(coupled_loop(F, aim, plan, first));
  const auto loop_at = [&](double angle) {  // of the equations the left sides alone change
    const Loop loop = coupled_loop(F, aim, plan, angle);
    sample_left(loop, eq.left);
    return loop;
  };
  const auto determinant = [&](double angle) {
    loop_at(angle);
    Square M = coupled_matrix(eq);
    return signed_determinant(M);
  };
  std::array<double, nodes> values;
  for (Index i = 0; i < nodes; ++i)
    values[i] = determinant(first + 2.0 * kPi * static_cast<double>(i) / static_cast<double>(nodes));
  std::array<double, 2 * degree + kClose * (kLooks + Plan::kCrowded.size())> angles;
  int count = circle_roots<degree>(values, first, real, angles);
  count = look_where_close(determinant, real, angles, count);
  for (const Crowded& at : Plan::kCrowded) count = look_closely(determinant, at.angle, real, angles, count);
  Spectrum roots;  // none is known to be all of the pose
  for (int i = 0; i < count; ++i) {
    const double angle = angles[static_cast<Index>(i)];
    const Loop loop = loop_at(angle);
    const Pairs pairs = find_pairs(coupled_matrix(eq));
    for (Index j = 0; j < pairs.count; ++j) {
      const Vector t = complete(loop, eq, 0.0, pairs.z4[j], pairs.z5[j]);
      Vector q;
      for (Index n = 0; n < 6; ++n) q[loop.order[n]] = loop.reverse ? -t[n] : t[n];
      q[Plan::kCoupled] = angle;
      add_refined(F, T, turning, q, roots, out);
    }
  }
  roots.simple = false;
  return roots;
}

// All that a run by lanes is sure of, else what runs one angle at a time agree on.
struct CoupledMethod {
  template <class Plan>
  static bool solve(const CoupledChain<Plan>& F, const Frame& T, const Turning& turning, Solutions& out) noexcept {
    Solutions blurred;
    const bool sure = solve_resultant<run_coupled_resultant<Plan>>(F, T, Plan::kEigenproblems, false, blurred, out) ||
                      solve_in_runs<run_coupled<Plan>>(F, T, turning, Plan::kEigenproblems, out);
    take_blurred(blurred, out);
    return sure;
  }
};

}  // namespace elimination

// Arm: as for SixJointArm, its Plan as for CoupledChain.
template <class Arm, class Plan = typename Arm::Plan>
struct Coupled6r : SixJointArm<Arm, elimination::CoupledMethod, elimination::CoupledChain<Plan>> {};

}  // namespace ikgen_runtime
