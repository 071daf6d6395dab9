#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "arrays/constants.hpp"

namespace ikgen_runtime {

// --- general_6r: rigid transforms and the closed loop of six joints --------------------------------
// Plain loops over fixed arrays: Eigen's expressions would cost the including file minutes of compilation.

namespace elimination {

using Index = std::size_t;

template <Index R, Index C>
struct Mat {  // row-major
  std::array<double, R * C> v;
  constexpr double& operator()(Index i, Index j) noexcept { return v[i * C + j]; }
  constexpr const double& operator()(Index i, Index j) const noexcept { return v[i * C + j]; }
};

struct Frame {
  Mat<3, 3> R;
  std::array<double, 3> p;
};

constexpr Frame compose(const Frame& a, const Frame& b) noexcept {
  Frame out{};
  for (Index i = 0; i < 3; ++i) {
    for (Index j = 0; j < 3; ++j)
      out.R(i, j) = a.R(i, 0) * b.R(0, j) + a.R(i, 1) * b.R(1, j) + a.R(i, 2) * b.R(2, j);
    out.p[i] = a.R(i, 0) * b.p[0] + a.R(i, 1) * b.p[1] + a.R(i, 2) * b.p[2] + a.p[i];
  }
  return out;
}

constexpr Frame inverse(const Frame& a) noexcept {
  Frame out{};
  for (Index i = 0; i < 3; ++i) {
    for (Index j = 0; j < 3; ++j) out.R(i, j) = a.R(j, i);
    out.p[i] = -(a.R(0, i) * a.p[0] + a.R(1, i) * a.p[1] + a.R(2, i) * a.p[2]);
  }
  return out;
}

// a * Rz with the angle's cosine c and sine s
constexpr Frame turn(const Frame& a, double c, double s) noexcept {
  Frame out = a;
  for (Index i = 0; i < 3; ++i) {
    out.R(i, 0) = c * a.R(i, 0) + s * a.R(i, 1);
    out.R(i, 1) = c * a.R(i, 1) - s * a.R(i, 0);
  }
  return out;
}

// a * Tz
constexpr Frame slide(const Frame& a, double d) noexcept {
  Frame out = a;
  for (Index i = 0; i < 3; ++i) out.p[i] += d * a.R(i, 2);
  return out;
}

using Turning = std::array<bool, 6>;  // which of the six joints turn; the others slide
inline constexpr Turning kAllTurn = {true, true, true, true, true, true};

inline Frame moved(const Frame& a, bool turns, double value) noexcept {
  return turns ? turn(a, std::cos(value), std::sin(value)) : slide(a, value);
}

inline double wrap(double x) noexcept {  // to (-pi, pi]
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
