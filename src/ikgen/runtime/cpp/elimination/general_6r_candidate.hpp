#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "arrays/small_matrix.hpp"
#include "elimination/general_6r_equations.hpp"
#include "elimination/general_6r_solutions.hpp"
#include "newton/damped_newton.hpp"
#include "newton/lyapunov_schmidt.hpp"

namespace ikgen_runtime {

// --- general_6r: a candidate completed and refined, one at a time -----------------------------------

namespace elimination {

// Angles 1 and 2 of the loop from the invariants u of R2^-1 ...: linearly, and by the phase.
inline std::array<Complex, 2> outer_pair(const Equations& eq, const std::array<double, 14>& u) noexcept {
  double h[6];
  for (Index i = 0; i < 6; ++i) h[i] = u[8 + i] - eq.right(8 + i, 0);
  reflect_turns(eq, h);
  const double y = h[1] / eq.r11, x = (h[0] - eq.r01 * y) / eq.r00, n1 = std::sqrt(x * x + y * y) + 1e-300;
  const double c1 = x / n1, s1 = y / n1;
  Complex z2(0.0, 0.0);
  for (Index i = 0; i < 4; ++i) {
    const Complex z(eq.right(i, 0) + eq.right(i, 1) * c1 + eq.right(i, 2) * s1,
                    eq.right(4 + i, 0) + eq.right(4 + i, 1) * c1 + eq.right(4 + i, 2) * s1);
    z2 += z * Complex(u[i], -u[4 + i]);
  }
  return {Complex(c1, s1), z2 / (std::abs(z2) + 1e-300)};
}

// The invariants of C2 R3 C3 R4 C4 R5 C5: `left` in (1, c4, s4) x (1, c5, s5), turned, by the action G of C2.
inline std::array<double, 14> inner_invariants(const Mat<14, 12>& left, const Mat<14, 16>& G, Complex z3, Complex z4,
                                               Complex z5) noexcept {
  const double b4[3] = {1.0, z4.real(), z4.imag()}, b5[3] = {1.0, z5.real(), z5.imag()};
  std::array<double, 14> v{}, u{};
  for (Index r = 0; r < 14; ++r)
    for (Index k = 0; k < 9; ++k) v[r] += left(r, k) * b4[k / 3] * b5[k % 3];
  for (Index i = 0; i < 4; ++i) {
    const double x = v[i], y = v[4 + i];
    v[i] = z3.real() * x - z3.imag() * y;
    v[4 + i] = z3.imag() * x + z3.real() * y;
  }
  for (Index r = 0; r < 14; ++r) {
    u[r] = G(r, 14);
    for (Index k = 0; k < 14; ++k) u[r] += G(r, k) * v[k];
  }
  return u;
}

// The angle about z that takes a rotation about z back.
inline double angle_back(const Frame& X) noexcept {
  return std::atan2(X.R[0][1] - X.R[1][0], X.R[0][0] + X.R[1][1]);
}

// All loop angles from three: theta_1 and theta_2 linearly, theta_6 from the rotation left over.
inline std::array<double, 6> complete(const Loop& loop, const Equations& eq, double t3, Complex z4,
                                      Complex z5) noexcept {
  const Complex z3(std::cos(t3), std::sin(t3));
  const std::array<double, 14> u = inner_invariants(eq.left, eq.G, z3, z4, z5);
  const std::array<Complex, 2> outer = outer_pair(eq, u);
  const Complex z[5] = {outer[0], outer[1], z3, z4, z5};
  Frame X = loop.C[5];
  for (Index i = 0; i < 5; ++i) X = compose(rotated(X, z[i].real(), z[i].imag()), loop.C[i]);
  return {std::arg(z[0]), std::arg(z[1]), t3, std::arg(z4), std::arg(z5), angle_back(X)};
}

using Vector = std::array<double, 6>;

// Error of a configuration, lengths over the arm's, its slope, and the largest error of an entry of the pose.
struct State {
  double error[6], slope[6][6] = {}, worst = 0.0;
  double largest() const noexcept { return worst; }
};

// A joint that moves an axis of a chain, and the axis' value by the joint's: ratio times it, and shift.
struct Axis {
  Index joint;
  double ratio, shift;
};

constexpr Axis axis_of(const Chain&, Index i) noexcept { return {i, 1.0, 0.0}; }

// F: a Chain, or another of frames with axis_of.
template <class Frames>
inline State residual(const Frames& F, const Frame& T, const double* q, const Turning& turning) noexcept {
  constexpr Index axes = sizeof(Frames) / sizeof(Frame) - 1;
  State out;
  Frame X = F[0];
  Mat<axes, 3> p, z;
  for (Index i = 0; i < axes; ++i) {
    for (Index k = 0; k < 3; ++k) {
      z(i, k) = X.R[k][2];
      p(i, k) = X.p[k];
    }
    const Axis axis = axis_of(F, i);
    X = compose(moved(X, turning[axis.joint], axis.ratio * q[axis.joint] + axis.shift), F[i + 1]);
  }
  Mat<3, 3> S{};
  for (Index i = 0; i < 3; ++i) {
    for (Index j = 0; j < 3; ++j) {
      for (Index k = 0; k < 3; ++k) S(i, j) += T.R[i][k] * X.R[j][k];
      out.worst = worse(out.worst, T.R[i][j] - X.R[i][j]);
    }
    out.error[i] = T.p[i] - X.p[i];
    out.worst = worse(out.worst, out.error[i]);
  }
  for (Index k = 0; k < 3; ++k) {
    const Index m = (k + 1) % 3, n = (k + 2) % 3;
    out.error[3 + k] = 0.5 * (S(n, m) - S(m, n));
    for (Index i = 0; i < axes; ++i) {
      const Axis axis = axis_of(F, i);
      const bool turns = turning[axis.joint];
      const double arm = z(i, m) * (X.p[n] - p(i, n)) - z(i, n) * (X.p[m] - p(i, m));
      out.slope[k][axis.joint] += axis.ratio * (turns ? arm : z(i, k));
      if (turns) out.slope[3 + k][axis.joint] += axis.ratio * z(i, k);
    }
  }
  return out;
}

// How a candidate is refined, as RefinementCourse and damped_step have it. Where more than two solutions meet steps do less
// than halve the error: what has come near takes as many as rows need that are to be told apart.
struct CandidatePolicy {
  static constexpr int kPatience = 40;
  static constexpr double kDamping = 1e-3, kLeastDamping = 1e-13, kLargestStep = 0.4, kConverged = 1e-13, kProgress = 0.8;
  static constexpr RefineStage kRefinement[] = {{3, 0.0, 0.1}, {6, 0.0, 1e-3}, {31, 0.0, 0.0}};
};

// The residual that damped Newton steps on the chain leave.
template <class Frames>
inline double refine_one(const Frames& F, const Frame& T, const Turning& turning, Vector& q) noexcept {
  return damped_newton<CandidatePolicy, 6>(q.data(), [&](const double* at) { return residual(F, T, at, turning); });
}

inline Solution solution_of(const Turning& turning, const Vector& q) noexcept {
  Solution out;
  for (Index i = 0; i < 6; ++i) {
    out.q[i] = turning[i] ? wrap(q[i]) : q[i];
    out.c[i] = std::cos(q[i]);
    out.s[i] = std::sin(q[i]);
  }
  return out;
}

inline constexpr double kExactly = 1e-12;  // error of a row that is right to round-off

struct Still {
  double direction[6], flow[6];
};

// The unit direction in which a slope moves the pose least, and what it does to it.
inline Still still_of(const State& at) noexcept {
  constexpr double least = 1e-18;
  Still out = {{1.0, -0.7, 0.4, 0.9, -0.3, 0.6}, {}};
  double N[6][6];
  gram_of_columns(at.slope, N);
  shift_diagonal(least, N);
  factor(N, least);
  inverse_iteration(N, out.direction);
  for (Index k = 0; k < 6; ++k)
    for (Index i = 0; i < 6; ++i) out.flow[k] += at.slope[k][i] * out.direction[i];
  return out;
}

// Undamped steps from q, where damped ones stall beside a continuum: there the error along a curve is as small as its
// slope, and normal equations keep the square of that alone. Along the direction in which the pose hardly moves what the
// others leave of the error is taken away, in bounded steps. Returns the residual, and q only where it is round-off.
template <class Frames>
[[gnu::cold, gnu::noinline]] inline double refine_along(const Frames& F, const Frame& T, const Turning& turning, Vector& q) noexcept {
  constexpr double farthest = 0.3, enough = 1e-14, shift = 1e-13;
  Vector x = q, best = q;
  State at = residual(F, T, x.data(), turning);
  const double given = at.worst;
  double least = given;
  for (int step = 0; step < 30 && least > enough; ++step) {
    const Still still = still_of(at);
    const StillSplit<6, 6, 1> others(at.slope, &still.direction, shift);
    const LeftAcross<6, 6> taken(others, at.error, still.flow, still.flow);
    double left = 0.0, slope = 0.0;
    for (const auto& row : taken.rest) {
      left += row[0] * row[1];
      slope += row[1] * row[1];
    }
    const double along = slope > 0.0 ? std::min(std::max(left / slope, -farthest), farthest) : 0.0;
    for (Index i = 0; i < 6; ++i)
      x[i] += std::min(std::max(taken.going[i][0], -farthest), farthest) + along * (still.direction[i] - taken.going[i][1]);
    at = residual(F, T, x.data(), turning);
    if (!(at.worst < least)) continue;
    least = at.worst;
    best = x;
  }
  if (!(least < kExactly)) return given;
  q = best;
  return least;
}

}  // namespace elimination
}  // namespace ikgen_runtime
