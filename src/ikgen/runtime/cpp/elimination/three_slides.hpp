#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "elimination/method_in_runs.hpp"
#include "elimination/revolute_loop.hpp"
#include "elimination/six_joint_arm.hpp"

namespace ikgen_runtime {

// --- three_slides: the rotation gives three angles, the position the lengths of three slides --------------

namespace elimination {

inline Spectrum run_three_slides(const Chain& F, const Frame& T, const Frame& aim, const Turning& turning,
                                 const std::array<int, 3>& plan, Solutions& out) noexcept {
  const Loop order = make_loop(F, aim, static_cast<Index>(plan[0]), false);
  const RevoluteLoop loop = revolute_loop(order, turning);
  Mat<3, 3> M;
  for (Index i = 0; i < 3; ++i)
    for (Index j = 0; j < 3; ++j) M(i, j) = loop.K[2](j, i);
  const Triple at = triple(loop.K[0], loop.K[1], M);
  const double square = 1.0 - at.x * at.x, y = std::sqrt(std::max(square, 0.0));
  Spectrum roots;
  if (square < -1e-6) return roots;
  roots.real = square < 0.0 ? 0 : 2;
  roots.simple = y > 1e-6 && at.h > 1e-6;
  for (const double sine : {y, -y}) {
    Angles<double> t{};
    complete(at, sine, 0, t);
    add_refined(F, T, turning, closed<3>(loop, order, t), roots, out);
  }
  return roots;
}

}  // namespace elimination

using ThreeSlidesMethod = elimination::InRuns<elimination::run_three_slides>;

// Arm: as for SixJointArm, its Plan with kEigenproblems, of which the first of each is a revolute joint.
template <class Arm> struct ThreeSlides : SixJointArm<Arm, ThreeSlidesMethod> {};

}  // namespace ikgen_runtime
