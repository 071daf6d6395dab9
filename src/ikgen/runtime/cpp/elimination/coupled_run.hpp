#pragma once

#include <array>
#include <cmath>

#include "elimination/coupled_loop.hpp"
#include "elimination/general_6r_runs.hpp"
#include "elimination/general_6r_spectrum.hpp"
#include "elimination/unit_circle_roots.hpp"

namespace ikgen_runtime {

// --- one run of an elimination of a chain in which one joint turns several axes ---------------------------

namespace elimination {

template <Index N>
inline double signed_determinant(Mat<N, N>& A) noexcept {
  std::array<Index, N> pivot{};  // not all is written of a matrix that is singular
  double det = factor_by_rows(A, pivot);
  for (Index k = 0; k < N; ++k) {
    if (pivot[k] != k) det = -det;
    if (A(k, k) < 0.0) det = -det;
  }
  return det;
}

// Way: what vanishes at the coupled joint's angles, and the two angles after it, from the equations in these two.
template <class Plan, class Way>
inline Spectrum run_coupled(const CoupledChain<Plan>& F, const Frame& T, const Frame& aim, const Turning& turning,
                            const std::array<int, 3>& plan, Solutions& out) noexcept {
  constexpr Index degree = Plan::kDegree, nodes = 2 * degree + 2;
  constexpr double first = 0.05;  // rad, an angle that no right angle shares
  constexpr double real = 0.03;   // rad, the imaginary part of an angle that may be real
  const Way way;
  Equations eq = eliminate(coupled_loop(F, aim, plan, first));
  const auto loop_at = [&](double angle) {  // of the equations the left sides alone change
    const Loop loop = coupled_loop(F, aim, plan, angle);
    sample_left(loop, eq.left);
    return loop;
  };
  const auto determinant = [&](double angle) {
    loop_at(angle);
    return way.determinant(make_pencil(eq.E, eq.left));
  };
  std::array<double, nodes> values;
  for (Index i = 0; i < nodes; ++i)
    values[i] = determinant(first + 2.0 * kPi * static_cast<double>(i) / static_cast<double>(nodes));
  std::array<double, 2 * degree + kClose * (kLooks + Plan::kCrowded.size())> angles;
  Unsure unsure;
  int count = circle_roots<degree>(values, first, real, angles, unsure);
  count = look_where_close(determinant, real, unsure, angles, count);
  for (const Crowded& at : Plan::kCrowded) count = look_closely(determinant, at.angle, real, angles, count);
  Spectrum roots;                                    // none is known to be all of the pose
  roots.perhaps = unsure.count > 0 ? kRoom : 0;  // two runs may have lost the same of a crowd
  for (int i = 0; i < count; ++i) {
    const double angle = angles[static_cast<Index>(i)];
    const Loop loop = loop_at(angle);
    const auto pairs = way.pairs(make_pencil(eq.E, eq.left));
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

}  // namespace elimination
}  // namespace ikgen_runtime
