#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "arrays/small_matrix.hpp"
#include "elimination/general_6r_equations.hpp"
#include "elimination/general_6r_solutions.hpp"

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

struct State {
  Vector e;
  Mat<6, 6> J;
  double r, square;
};

// A joint that moves an axis of a chain, and the axis' value by the joint's: ratio times it, and shift.
struct Axis {
  Index joint;
  double ratio, shift;
};

constexpr Axis axis_of(const Chain&, Index i) noexcept { return {i, 1.0, 0.0}; }

// F: a Chain, or another of frames with axis_of.
template <class Frames>
inline State residual(const Frames& F, const Frame& T, const Vector& q, const Turning& turning) noexcept {
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
  out.r = out.square = 0.0;
  for (Index i = 0; i < 3; ++i) {
    for (Index j = 0; j < 3; ++j) {
      for (Index k = 0; k < 3; ++k) S(i, j) += T.R[i][k] * X.R[j][k];
      out.r = std::max(out.r, std::abs(T.R[i][j] - X.R[i][j]));
    }
    out.e[i] = T.p[i] - X.p[i];
    out.r = std::max(out.r, std::abs(out.e[i]));
  }
  out.J = {};
  for (Index k = 0; k < 3; ++k) {
    const Index m = (k + 1) % 3, n = (k + 2) % 3;
    out.e[3 + k] = 0.5 * (S(n, m) - S(m, n));
    for (Index i = 0; i < axes; ++i) {
      const Axis axis = axis_of(F, i);
      const bool turns = turning[axis.joint];
      const double arm = z(i, m) * (X.p[n] - p(i, n)) - z(i, n) * (X.p[m] - p(i, m));
      out.J(k, axis.joint) += axis.ratio * (turns ? arm : z(i, k));
      if (turns) out.J(3 + k, axis.joint) += axis.ratio * z(i, k);
    }
  }
  for (const double x : out.e) out.square += x * x;
  return out;
}

// (J^T J + mu)^-1 x
inline Vector inverse_normal(const State& at, const Vector& x, double mu) noexcept {
  double A[6][6], solved[6];
  for (Index i = 0; i < 6; ++i) {
    solved[i] = x[i];
    for (Index j = 0; j <= i; ++j) {
      A[i][j] = i == j ? mu : 0.0;
      for (Index k = 0; k < 6; ++k) A[i][j] += at.J(k, i) * at.J(k, j);
    }
  }
  factor(A, 1e-18);
  substitute(A, solved);
  Vector out;
  std::copy_n(solved, 6, out.begin());
  return out;
}

inline Vector damped_step(const State& at, double mu) noexcept {
  Vector x{};
  for (Index k = 0; k < 6; ++k)
    for (Index i = 0; i < 6; ++i) x[i] += at.J(k, i) * at.e[k];
  return inverse_normal(at, x, mu);
}

// Damped Newton (Levenberg-Marquardt) on the chain; returns the residual, and in `before` that of the start. Where
// solutions meet steps halve the error, or do less: what has come near takes as many as rows need that are to be told
// apart.
template <class Frames>
inline double refine_one(const Frames& F, const Frame& T, const Turning& turning, Vector& q, double& before) noexcept {
  State now = residual(F, T, q, turning);
  before = now.r;
  double damp = 1e-3;
  for (int step = 0; step < 40; ++step) {
    if (!(now.r > 1e-14 && now.r < (step < 3 ? 1e4 : step < 9 ? 0.1 : 1e-3))) break;
    const Vector dq = damped_step(now, damp * std::min(now.square, 1.0) + 1e-13);
    double size = 0.0;
    for (const double x : dq) size = std::max(size, std::abs(x));
    if (!(size < 1e300)) break;
    Vector trial = q;
    for (Index i = 0; i < 6; ++i) trial[i] += size > 0.4 ? dq[i] * (0.4 / size) : dq[i];
    const State next = residual(F, T, trial, turning);
    if (next.square < now.square) {
      q = trial;
      now = next;
      damp = 1e-3;
    } else {
      damp *= 1e3;
      if (now.r < 1e-12 || damp > 1e6) break;
    }
  }
  return now.r;
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
  Vector direction, flow;
};

// The unit direction in which a slope moves the pose least, by inverse iteration, and what it does to it.
inline Still still_of(const State& at) noexcept {
  Still out;
  out.direction = {1.0, -0.7, 0.4, 0.9, -0.3, 0.6};
  for (int pass = 0; pass < 4; ++pass) {
    out.direction = inverse_normal(at, out.direction, 1e-18);
    double square = 0.0;
    for (const double e : out.direction) square += e * e;
    for (double& e : out.direction) e /= std::sqrt(square) + 1e-300;
  }
  out.flow = {};
  for (Index k = 0; k < 6; ++k)
    for (Index i = 0; i < 6; ++i) out.flow[k] += at.J(k, i) * out.direction[i];
  return out;
}

// Undamped steps from q, where damped ones stall beside a continuum: there the error along a curve is as small as its
// slope, and normal equations keep the square of that alone. Along the direction in which the pose hardly moves what the
// others leave of the error is taken away, in bounded steps. Returns the residual, and q only where it is round-off.
template <class Frames>
[[gnu::cold, gnu::noinline]] inline double refine_along(const Frames& F, const Frame& T, const Turning& turning, Vector& q) noexcept {
  constexpr double farthest = 0.3, enough = 1e-14;
  Vector x = q, best = q;
  State at = residual(F, T, x, turning);
  const double given = at.r;
  double least = given;
  for (int step = 0; step < 30 && least > enough; ++step) {
    const Still still = still_of(at);
    State others = at;
    for (Index k = 0; k < 6; ++k)
      for (Index i = 0; i < 6; ++i) others.J(k, i) -= still.flow[k] * still.direction[i];
    const Vector across = damped_step(others, 1e-13);
    others.e = still.flow;
    const Vector back = damped_step(others, 1e-13);
    double left = 0.0, slope = 0.0;
    for (Index k = 0; k < 6; ++k) {
      double rest = at.e[k], flow = still.flow[k];
      for (Index i = 0; i < 6; ++i) {
        const double V = at.J(k, i) - still.flow[k] * still.direction[i];
        rest -= V * across[i];
        flow -= V * back[i];
      }
      left += rest * flow;
      slope += flow * flow;
    }
    const double along = slope > 0.0 ? std::min(std::max(left / slope, -farthest), farthest) : 0.0;
    for (Index i = 0; i < 6; ++i)
      x[i] += std::min(std::max(across[i], -farthest), farthest) + along * (still.direction[i] - back[i]);
    at = residual(F, T, x, turning);
    if (!(at.r < least)) continue;
    least = at.r;
    best = x;
  }
  if (!(least < kExactly)) return given;
  q = best;
  return least;
}

}  // namespace elimination
}  // namespace ikgen_runtime
