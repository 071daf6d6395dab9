#pragma once

#include <cmath>

#include "elimination/coupled_run.hpp"
#include "elimination/six_joint_arm.hpp"
#include "elimination/tall_null_plane.hpp"

namespace ikgen_runtime {

// --- coupled_both: a joint that turns several axes, by half angles of both angles beside it ---------------
// At right angles the twelve equations of the other five joints may be singular at every angle of the coupled joint. By
// half angles of both angles they are 24 in sixteen products, which lose rank where there is a solution. Sixteen sums of
// them, the same for all angles, have a determinant that is a trigonometric polynomial; of its roots those count at which
// the 24 lose rank.

namespace elimination {

struct SumsOfEquations {
  Mat<16, 24> share;  // no two equations count alike

  SumsOfEquations() noexcept {
    for (Index i = 0; i < 16; ++i)
      for (Index j = 0; j < 24; ++j) share(i, j) = std::cos(static_cast<double>((i + 1) * (j + 1)));
  }

  double determinant(const Pencil& of) const noexcept {
    Mat<16, 16> sums{};
    add_product<24>(1.0, share, 0, 0, matrix(of), 0, sums);
    return signed_determinant(sums);
  }

  static TallPairs pairs(const Pencil& of) noexcept {
    constexpr double nearly = 0.03;  // what the first direction leaves over the most at which it may be a null vector
    const TallQr qr(matrix(of));
    const NullPlane plane = null_plane(qr);
    return plane.least < nearly * pivot_of(qr, 0) ? pairs_in(qr, plane) : TallPairs();
  }

  static Tall matrix(const Pencil& of) noexcept {
    auto A = of.f;
    for (Index i = 0; i < A.v.size(); ++i) A.v[i] += of.c.v[i];
    return lift_both(A);
  }
};

struct CoupledBothMethod {
  template <class Plan>
  static bool solve(const CoupledChain<Plan>& F, const Frame& T, const Turning& turning, Solutions& out) noexcept {
    return solve_in_runs<run_coupled<Plan, SumsOfEquations>>(F, T, turning, Plan::kEigenproblems, out);
  }
};

}  // namespace elimination

// Arm: as for SixJointArm, its Plan as for CoupledChain.
template <class Arm, class Plan = typename Arm::Plan>
struct CoupledBoth : SixJointArm<Arm, elimination::CoupledBothMethod, elimination::CoupledChain<Plan>> {};

}  // namespace ikgen_runtime
