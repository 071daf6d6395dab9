#pragma once

#include <array>
#include <cmath>

#include "elimination/general_6r_candidate.hpp"
#include "elimination/pivoted_qr.hpp"

namespace ikgen_runtime {

// --- the closed loop of five revolute joints and a slide, as six equations in three angles -----------------
// Raghavan & Roth (1993): the loop is begun so that the slide is its first joint or the second. Of the fourteen
// functions of the other side its monomials 1, d, d^2 are eliminated as cosine and sine would be; six equations are
// left in three angles, the same as those of six revolute joints.

namespace elimination {

struct OtherSide {  // invariants of M2^-1 C1^-1 M1^-1 C6^-1: a constant and eight monomials
  std::array<double, 14> constant;
  Mat<14, 8> monomials;
};

// The slide is the `first` of its two joints, or the other.
inline OtherSide sample_other(const Loop& loop, bool first) noexcept {
  constexpr double at[3] = {0.0, 1.0, -1.0};
  constexpr double parabola[3][3] = {{1.0, 0.0, 0.0}, {0.0, 0.5, -0.5}, {-1.0, 0.5, 0.5}};
  double angle[3][3];
  for (Index k = 0; k < 3; ++k) {
    angle[0][k] = 1.0 / 3.0;
    angle[1][k] = 2.0 / 3.0 * kC3[k];
    angle[2][k] = 2.0 / 3.0 * kS3[k];
  }
  const auto moved_back = [&](const Frame& X, bool slides, Index k) {
    return slides ? slid(X, at[k]) : rotated(X, kC3[k], -kS3[k]);
  };
  const Frame a = inverse(loop.C[0]), b = inverse(loop.C[5]);
  double sums[14][9] = {};
  for (Index i = 0; i < 3; ++i)
    for (Index j = 0; j < 3; ++j) {
      const Frame two = compose(moved_back(kIdentity, !first, j), a);
      const std::array<double, 14> v = invariants(compose(moved_back(two, first, i), b));
      for (Index r = 0; r < 14; ++r)
        for (Index m = 0; m < 9; ++m)
          sums[r][m] += (first ? parabola : angle)[m / 3][i] * (first ? angle : parabola)[m % 3][j] * v[r];
    }
  OtherSide out;
  for (Index r = 0; r < 14; ++r) {
    out.constant[r] = sums[r][0];
    for (Index m = 0; m < 8; ++m) out.monomials(r, m) = sums[r][m + 1];
  }
  return out;
}

struct SlideEquations {
  OtherSide other;
  PivotedQr<14, 8> qr;
  Mat<6, 16> E;
  Mat<14, 12> left;
  Mat<14, 16> G;

  SlideEquations(const Loop& loop, bool first) noexcept
      : other(sample_other(loop, first)), qr(other.monomials), E{}, G(action(loop.C[1])) {
    sample_left(loop, left);
    for (Index i = 0; i < 6; ++i) {
      std::array<double, 14> basis{};
      basis[8 + i] = 1.0;
      qr.turn_back(basis);
      for (Index r = 0; r < 14; ++r) {
        for (Index k = 0; k < 16; ++k) E(i, k) += basis[r] * G(r, k);
        E(i, 14) -= basis[r] * other.constant[r];
      }
    }
  }
};

// All values of the loop from three angles: the slide and the angle beside it linearly, theta_6 from the rotation.
inline Vector complete_with_slide(const Loop& loop, const SlideEquations& eq, bool first, double t3, Complex z4,
                                  Complex z5) noexcept {
  std::array<double, 14> u = inner_invariants(eq.left, eq.G, Complex(std::cos(t3), std::sin(t3)), z4, z5);
  for (Index r = 0; r < 14; ++r) u[r] -= eq.other.constant[r];
  const std::array<double, 8> m = eq.qr.solve(u);
  const double angle = first ? std::atan2(m[1], m[0]) : std::atan2(m[5], m[2]), length = first ? -m[2] : -m[0];
  Vector out = {first ? length : angle, first ? angle : length, t3, std::arg(z4), std::arg(z5), 0.0};
  Frame X = loop.C[5];
  for (Index i = 0; i < 5; ++i) X = compose(moved(X, i != (first ? 0 : 1), out[i]), loop.C[i]);
  out[5] = angle_back(X);
  return out;
}

// What a run does with a slide's loop about the pose `aim`: find(loop, equations, complete), the last of which gives all
// values of the loop from three angles.
template <class Find>
inline auto run_slide_loop(const Chain& F, const Frame& aim, const Turning& turning, const std::array<int, 3>& plan,
                               const Find& find) noexcept {
  const Loop loop = make_loop(F, aim, static_cast<Index>(plan[0]), plan[1] != 0);
  const bool first = !turning[loop.order[0]];
  const SlideEquations eq(loop, first);
  return find(loop, eq, [&](double t3, Complex z4, Complex z5) noexcept {
    return complete_with_slide(loop, eq, first, t3, z4, z5);
  });
}

}  // namespace elimination
}  // namespace ikgen_runtime
