#pragma once

#include <array>
#include <cmath>

#include "elimination/general_6r_candidate.hpp"

namespace ikgen_runtime {

// --- coupled_6r: a chain in which one joint turns several axes, and the loop of the other five -----------

namespace elimination {

// Plan: kAxes, of the axes in their order along the chain; kCoupled, the joint that turns several; kDegree, of the
// determinant; kCrowded, angles near which that has roots at every pose; kEigenproblems (start, reverse, degree).
struct Crowded {  // how many roots every pose has near an angle (rad)
  double angle;
  int order;
};

template <class Plan> struct CoupledChain : std::array<Frame, Plan::kAxes.size() + 1> {};

template <class Plan>
constexpr Axis axis_of(const CoupledChain<Plan>&, Index i) noexcept {
  return Plan::kAxes[i];
}

// The loop of the other five as one of six whose third angle is 0: what the coupled joint turns lies behind it.
template <class Plan>
inline Loop coupled_loop(const CoupledChain<Plan>& F, const Frame& T, const std::array<int, 3>& plan,
                         double angle) noexcept {
  std::array<Index, 5> joints{};
  std::array<Frame, 6> link{};  // before the first of the five, then behind each
  Index n = 0;
  link[0] = F[0];
  for (Index i = 0; i < Plan::kAxes.size(); ++i) {
    const Axis axis = Plan::kAxes[i];
    if (axis.joint == Plan::kCoupled) {
      link[n] = compose(moved(link[n], true, axis.ratio * angle + axis.shift), F[i + 1]);
    } else {
      joints[n++] = axis.joint;
      link[n] = F[i + 1];
    }
  }
  link[5] = compose(link[5], compose(inverse(T), link[0]));
  Loop out{};
  out.reverse = plan[1] != 0;
  const Index start = static_cast<Index>(plan[0]);
  for (Index i = 0; i < 5; ++i) {
    const Index k = out.reverse ? (start + 5 - i) % 5 : (start + i) % 5, at = i < 2 ? i : i + 1;
    out.order[at] = joints[k];
    out.C[i < 1 ? i : i + 1] = out.reverse ? inverse(link[(k + 4) % 5 + 1]) : link[k + 1];
  }
  out.order[2] = Plan::kCoupled;
  out.C[1] = kIdentity;
  return out;
}

}  // namespace elimination
}  // namespace ikgen_runtime
