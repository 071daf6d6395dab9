#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "elimination/general_6r_candidate.hpp"
#include "elimination/pivoted_qr.hpp"

namespace ikgen_runtime {

// --- the closed loop of six joints seen from those that turn: slides leave rotations alone ---------------

namespace elimination {

// R_1 K_1 ... R_r K_r = 1 of r revolute joints, the first of the loop's among them: rotations K and displacements k
// behind each; the directions u of the slides, each behind the revolute joint of that number `at`.
struct RevoluteLoop {
  Index turns = 0, slides = 0;
  std::array<Mat<3, 3>, 4> K;
  std::array<std::array<double, 3>, 4> k;
  std::array<std::array<double, 3>, 3> u;
  std::array<Index, 3> at;
  std::array<Index, 4> turn_place;    // places in the loop
  std::array<Index, 3> slide_place;
};

inline RevoluteLoop revolute_loop(const Loop& loop, const Turning& turning) noexcept {
  RevoluteLoop out{};
  Frame behind{};
  for (Index i = 0; i < 6; ++i) {
    if (turning[loop.order[i]]) {
      out.turn_place[out.turns++] = i;
      behind = loop.C[i];
    } else {
      for (Index r = 0; r < 3; ++r) out.u[out.slides][r] = behind.R[r][2];
      out.at[out.slides] = out.turns - 1;
      out.slide_place[out.slides++] = i;
      behind = compose(behind, loop.C[i]);
    }
    for (Index r = 0; r < 3; ++r) {
      for (Index c = 0; c < 3; ++c) out.K[out.turns - 1](r, c) = behind.R[r][c];
      out.k[out.turns - 1][r] = behind.p[r];
    }
  }
  return out;
}

template <class S> using Matrix3 = std::array<std::array<S, 3>, 3>;
template <class S> using Vector3 = std::array<S, 3>;

template <class S>
inline Matrix3<S> widened(const Mat<3, 3>& K) noexcept {
  Matrix3<S> out;
  for (Index i = 0; i < 3; ++i)
    for (Index j = 0; j < 3; ++j) out[i][j] = K(i, j);
  return out;
}

// A Rz K
template <class S>
inline Matrix3<S> turned(const Matrix3<S>& A, const S& c, const S& s, const Mat<3, 3>& K) noexcept {
  Matrix3<S> out;
  for (Index i = 0; i < 3; ++i) {
    const S x = c * A[i][0] + s * A[i][1], y = c * A[i][1] - s * A[i][0], z = A[i][2];
    for (Index j = 0; j < 3; ++j) out[i][j] = x * K(0, j) + y * K(1, j) + z * K(2, j);
  }
  return out;
}

template <class S>
struct Angles {
  std::array<S, 4> c, s;
};

// What of three angles with R_1 K_1 R_2 K_2 R_3 = M can be said before the choice between their two solutions: the
// cosine of the middle one, less a constant angle of which c0 and s0 are cosine and sine; the divisor h = 1 - m^2.
struct Triple {
  const Mat<3, 3>*K1, *K2;
  Mat<3, 3> M;
  double x, c0, s0, h;
};

inline Triple triple(const Mat<3, 3>& K1, const Mat<3, 3>& K2, const Mat<3, 3>& M) noexcept {
  Triple out{&K1, &K2, M, 0.0, 0.0, 0.0, 0.0};
  const double m = M(2, 2);
  const double beta = K1(2, 0) * K2(0, 2) + K1(2, 1) * K2(1, 2), gamma = K1(2, 1) * K2(0, 2) - K1(2, 0) * K2(1, 2);
  const double size = std::max(std::sqrt(beta * beta + gamma * gamma), 1e-9);  // less: axes are parallel
  out.x = (m - K1(2, 2) * K2(2, 2)) / size;
  out.c0 = beta / size;
  out.s0 = gamma / size;
  out.h = 1.0 - m * m;
  return out;
}

// The angles `from`, from + 1 and from + 2 for the sine y of the middle one.
template <class S>
inline void complete(const Triple& at, const S& y, Index from, Angles<S>& out) noexcept {
  const double over = 1.0 / (std::abs(at.h) < 1e-12 ? 1e-12 : at.h);
  const S c2 = at.c0 * at.x - at.s0 * y, s2 = at.s0 * at.x + at.c0 * y;
  const Matrix3<S> W = turned(widened<S>(*at.K1), c2, s2, *at.K2);
  const Mat<3, 3>& M = at.M;
  out.c[from] = (W[0][2] * M(0, 2) + W[1][2] * M(1, 2)) * over;
  out.s[from] = (W[0][2] * M(1, 2) - W[1][2] * M(0, 2)) * over;
  out.c[from + 1] = c2;
  out.s[from + 1] = s2;
  out.c[from + 2] = (M(2, 0) * W[2][0] + M(2, 1) * W[2][1]) * over;
  out.s[from + 2] = (M(2, 0) * W[2][1] - M(2, 1) * W[2][0]) * over;
}

// The displacement of the loop without its slides, and their directions.
template <class S>
struct Gap {
  Vector3<S> p;
  std::array<Vector3<S>, 3> u;
};

template <class S>
inline Gap<S> gap_of(const RevoluteLoop& loop, const Angles<S>& t) noexcept {
  constexpr Mat<3, 3> identity{{1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}};
  Gap<S> out{};
  Matrix3<S> A = widened<S>(identity);
  for (Index i = 0; i < loop.turns; ++i) {
    const Matrix3<S> R = turned(A, t.c[i], t.s[i], identity);
    for (Index r = 0; r < 3; ++r) {
      for (Index j = 0; j < 3; ++j) out.p[r] += R[r][j] * loop.k[i][j];
      for (Index n = 0; n < loop.slides; ++n)
        for (Index j = 0; j < 3 && loop.at[n] == i; ++j) out.u[n][r] += R[r][j] * loop.u[n][j];
    }
    A = turned(A, t.c[i], t.s[i], loop.K[i]);
  }
  return out;
}

// The six joint values: angles as they are, lengths of N slides that come nearest to closing the loop.
template <Index N>
inline Vector closed(const RevoluteLoop& loop, const Loop& order, const Angles<double>& t) noexcept {
  const Gap<double> gap = gap_of(loop, t);
  Mat<3, N> U;
  for (Index r = 0; r < 3; ++r)
    for (Index n = 0; n < N; ++n) U(r, n) = gap.u[n][r];
  const std::array<double, N> lengths = PivotedQr<3, N>(U).solve(gap.p);
  Vector q{};
  for (Index i = 0; i < loop.turns; ++i) q[order.order[loop.turn_place[i]]] = std::atan2(t.s[i], t.c[i]);
  for (Index n = 0; n < N; ++n) q[order.order[loop.slide_place[n]]] = -lengths[n];
  return q;
}

}  // namespace elimination
}  // namespace ikgen_runtime
