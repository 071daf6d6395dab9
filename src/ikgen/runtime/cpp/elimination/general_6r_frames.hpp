#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "arm/rigid_frame.hpp"
#include "arrays/constants.hpp"

namespace ikgen_runtime {

// --- general_6r: the closed loop of six joints -----------------------------------------------------
// Plain loops over fixed arrays: roots and null vectors of a resultant compile in 1.1 s so, and in 17 s by Eigen's
// PartialPivLU, EigenSolver and FullPivLU (g++ 12 -O3).

namespace elimination {

using Index = std::size_t;

template <Index R, Index C>
struct Mat {  // row-major
  std::array<double, R * C> v;
  constexpr double& operator()(Index i, Index j) noexcept { return v[i * C + j]; }
  constexpr const double& operator()(Index i, Index j) const noexcept { return v[i * C + j]; }
};

using Turning = std::array<bool, 6>;  // which of the six joints turn; the others slide
inline constexpr Turning kAllTurn = {true, true, true, true, true, true};

inline double square(double x) noexcept { return x * x; }

inline Frame moved(const Frame& a, bool turns, double value) noexcept {
  return turns ? rotated(a, std::cos(value), std::sin(value)) : slid(a, value);
}

// An angle in (-pi, pi], where without_turns may leave -pi: what rounding has beside half a turn is one way about.
inline double wrap(double x) noexcept {
  const double y = x - 2.0 * kPi * std::floor((x + kPi) / (2.0 * kPi));
  return y <= -kPi ? kPi : y;
}

using Chain = std::array<Frame, 7>;  // F_0 M(q_1) F_1 ... M(q_6) F_6

// Closed loop M_1 C_1 ... M_6 C_6 = 1 begun at joint `start`; reversed: inverses, negated values.
struct Loop {
  std::array<Frame, 6> C;
  std::array<Index, 6> order;
  bool reverse;
};

inline Loop make_loop(const Chain& F, const Frame& T, Index start, bool reverse) noexcept {
  const std::array<Frame, 6> c{F[1], F[2], F[3], F[4], F[5], compose(F[6], compose(inverse(T), F[0]))};
  Loop out;
  out.reverse = reverse;
  for (Index i = 0; i < 6; ++i) {
    const Index k = reverse ? (start + 6 - i) % 6 : (start + i) % 6;
    out.order[i] = k;
    out.C[i] = reverse ? inverse(c[(k + 5) % 6]) : c[k];
  }
  return out;
}

}  // namespace elimination
}  // namespace ikgen_runtime
