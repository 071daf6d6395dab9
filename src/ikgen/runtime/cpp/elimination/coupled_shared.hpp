#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "elimination/coupled_run.hpp"
#include "elimination/general_6r_pairs.hpp"
#include "elimination/six_joint_arm.hpp"
#include "elimination/unit_circle_roots.hpp"

namespace ikgen_runtime {

// --- coupled_shared: a joint that turns several axes, of which several solutions have each angle ----------
// A spherical wrist, or an angle that is found by its cosine, gives every value of the coupled joint more than one
// solution. The twelve equations lose that much rank there, and their determinant is a power of a polynomial: its roots
// lie in one place, where rounding takes them apart. Sums of the equations and of their products, so many that one
// solution takes their rank, have a determinant whose roots there are simple. What else it has of roots is left out. At
// a root the six equations have no unknowns but theta_4 and theta_5: three sums of them, linear in (1, c5, s5), have a
// determinant of degree three in theta_4.

namespace elimination {

using SharedPairs = PairsUpTo<12>;

template <Index kShare>
struct SharedEquations {
  static constexpr Index kSize = 13 - kShare;
  Mat<12, 12> share;  // no two equations count alike

  SharedEquations() noexcept {
    for (Index i = 0; i < 12; ++i)
      for (Index j = 0; j < 12; ++j) share(i, j) = std::cos(static_cast<double>((i + 1) * (j + 1)));
  }

  double determinant(const Pencil& of) const noexcept {
    Mat<kSize, 12> sums{};
    Mat<kSize, kSize> both{};
    add_product<12>(1.0, share, 0, 0, lift(of).at(1.0, 0.0), 0, sums);
    for (Index i = 0; i < kSize; ++i)
      for (Index k = 0; k < 12; ++k)
        for (Index j = 0; j < kSize; ++j) both(i, j) += sums(i, k) * share(k, j);
    return signed_determinant(both);
  }

  // theta_4 where three sums have no rank; theta_5 from the largest of the six equations there, which all are like it
  // where two theta_5 go with theta_4.
  SharedPairs pairs(const Pencil& of) const noexcept {
    constexpr Index nodes = 7;
    constexpr double real = 0.03;    // rad, the imaginary part of a theta_4 that may be real
    constexpr double nearly = 0.03;  // of the equations' size: what angles leave of them that may be a solution
    std::array<double, nodes> values;
    for (Index i = 0; i < nodes; ++i) {
      const double angle = 2.0 * kPi * static_cast<double>(i) / static_cast<double>(nodes);
      const Mat<6, 3> at = inner(of, std::cos(angle), std::sin(angle));
      Mat<3, 3> three{};
      add_product<6>(1.0, share, 0, 0, at, 0, three);
      values[i] = signed_determinant(three);
    }
    std::array<double, 6> angles;
    Unsure unsure;
    const int count = circle_roots<3>(values, 0.0, real, angles, unsure);
    double size = 0.0;
    for (Index i = 0; i < 6; ++i)
      for (Index j = 0; j < 9; ++j) size += square(of.f(i, j) + of.c(i, j));
    SharedPairs out;
    for (int n = 0; n < count; ++n) {
      const double angle = angles[static_cast<Index>(n)], c4 = std::cos(angle), s4 = std::sin(angle);
      const Mat<6, 3> at = inner(of, c4, s4);
      Index row = 0;
      double most = -1.0;
      for (Index i = 0; i < 6; ++i) {
        const double norm = square(at(i, 0)) + square(at(i, 1)) + square(at(i, 2));
        if (norm > most) most = norm, row = i;
      }
      const double c = at(row, 1), s = at(row, 2), over = c * c + s * s;
      if (!(over > 0.0)) continue;
      const double along = std::min(std::max(-at(row, 0) / std::sqrt(over), -1.0), 1.0);
      const double across = std::sqrt(1.0 - along * along), one = 1.0 / std::sqrt(over);
      for (const double side : {across, -across}) {
        const double c5 = one * (along * c - side * s), s5 = one * (along * s + side * c);
        double left = 0.0;
        for (Index i = 0; i < 6; ++i) left += square(at(i, 0) + c5 * at(i, 1) + s5 * at(i, 2));
        if (!(left < nearly * nearly * size)) continue;
        out.z4[out.count] = Complex(c4, s4);
        out.z5[out.count++] = Complex(c5, s5);
      }
    }
    return out;
  }

  // The six equations in (1, c5, s5).
  static Mat<6, 3> inner(const Pencil& of, double c, double s) noexcept {
    const auto term = [&](Index i, Index j) { return of.f(i, j) + of.c(i, j); };
    Mat<6, 3> out;
    for (Index i = 0; i < 6; ++i)
      for (Index j = 0; j < 3; ++j) out(i, j) = term(i, j) + c * term(i, 3 + j) + s * term(i, 6 + j);
    return out;
  }
};

struct CoupledSharedMethod {
  template <class Plan>
  static bool solve(const CoupledChain<Plan>& F, const Frame& T, const Turning& turning, Solutions& out) noexcept {
    return solve_in_runs<run_coupled<Plan, SharedEquations<Plan::kShare>>>(F, T, turning, Plan::kEigenproblems, out);
  }
};

}  // namespace elimination

// Arm: as for SixJointArm, its Plan as for CoupledChain, with kShare, how many solutions may share an angle.
template <class Arm, class Plan = typename Arm::Plan>
struct CoupledShared : SixJointArm<Arm, elimination::CoupledSharedMethod, elimination::CoupledChain<Plan>> {};

}  // namespace ikgen_runtime
