#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "elimination/general_6r_spectrum.hpp"

namespace ikgen_runtime {

// --- general_6r: theta_4 and theta_5 from null vectors -----------------------------------------------

namespace elimination {

template <Index kMost> struct PairsUpTo {
  Index count = 0;
  std::array<Complex, kMost> z4, z5;
};
using Pairs = PairsUpTo<3>;

using Null = std::array<double, 12>;

// exp(i theta_4), exp(i theta_5) from a vector (cos h w, sin h w, cos 3h w, sin 3h w), w = (1, c5, s5).
inline void add_pair(const Null& v, Pairs& out) noexcept {
  Complex z4(0.0, 0.0);
  for (Index i = 0; i < 3; ++i) z4 += Complex(v[6 + i], v[9 + i]) * Complex(v[i], -v[3 + i]);
  const double size = std::abs(z4);
  if (!(size > 0.0)) return;
  z4 /= size;
  const Complex h = std::sqrt(z4);
  const double sign = h.real() * v[0] + h.imag() * v[3] < 0.0 ? -1.0 : 1.0;
  const Complex z5(sign * (h.real() * v[1] + h.imag() * v[4]), sign * (h.real() * v[2] + h.imag() * v[5]));
  const double r = std::abs(z5);
  if (!(r > 0.0)) return;
  out.z4[out.count] = z4;
  out.z5[out.count++] = z5 / r;
}

struct Plane {  // a null space of two dimensions, and the phases within its vectors
  std::array<const Null*, 2> n;
  std::array<std::array<Complex, 6>, 2> u, v;
};

inline Plane make_plane(const Null& a, const Null& b) noexcept {
  Plane out;
  out.n = {&a, &b};
  for (Index k = 0; k < 2; ++k)
    for (Index i = 0; i < 3; ++i) {
      const Null& x = *out.n[k];
      out.u[k][i] = out.v[k][3 + i] = Complex(x[i], x[3 + i]);
      out.u[k][3 + i] = std::conj(out.u[k][i]);
      out.v[k][i] = Complex(x[6 + i], x[9 + i]);
    }
  return out;
}

using Matrix2 = std::array<std::array<Complex, 2>, 2>;

// Least squares u A = v; false where u has no rank.
inline bool shift_matrix(const Plane& p, Matrix2& A) noexcept {
  const Complex g00 = dot(p.u[0], p.u[0]), g01 = dot(p.u[0], p.u[1]), g11 = dot(p.u[1], p.u[1]), g10 = std::conj(g01);
  const Complex det = g00 * g11 - g01 * g10;
  if (!(std::abs(det) > 0.0)) return false;
  for (Index k = 0; k < 2; ++k) {
    const Complex r0 = dot(p.u[0], p.v[k]), r1 = dot(p.u[1], p.v[k]);
    A[0][k] = (g11 * r0 - g01 * r1) / det;
    A[1][k] = (g00 * r1 - g10 * r0) / det;
  }
  return true;
}

// Coordinates of the two vectors of the cone w_0^2 = w_1^2 + w_2^2.
inline std::array<double, 2> on_cone(const Plane& p, double sign) noexcept {
  double H[3] = {0.0, 0.0, 0.0};
  for (Index i = 0; i < 3; ++i) {
    const double s = i == 0 ? 1.0 : -1.0;
    H[0] += s * std::norm(p.u[0][i]);
    H[1] += s * (std::conj(p.u[0][i]) * p.u[1][i]).real();
    H[2] += s * std::norm(p.u[1][i]);
  }
  const double disc = std::sqrt(std::max(H[1] * H[1] - H[0] * H[2], 0.0));
  if (std::abs(H[0]) >= std::abs(H[2])) return {-H[1] - sign * disc, H[0]};
  return {H[2], -H[1] + sign * disc};
}

// The solutions within a null space of two dimensions. Where theta_4 differs the shift u3 = exp(i theta_4) u1
// splits them, else the cone.
inline void split(const Null& a, const Null& b, Pairs& out) noexcept {
  const Plane plane = make_plane(a, b);
  Matrix2 A;
  if (!shift_matrix(plane, A)) return;
  const Complex gap = A[0][0] - A[1][1], root = std::sqrt(0.25 * gap * gap + A[0][1] * A[1][0]);
  for (const double sign : {1.0, -1.0}) {
    std::array<double, 2> c;
    if (std::abs(root) > 0.01) {
      const Complex x = sign * root - 0.5 * gap;
      const bool first = std::abs(A[0][1]) >= std::abs(A[1][0]);
      const Complex e0 = first ? A[0][1] : x + gap, e1 = first ? x : A[1][0];
      const Complex phase = std::conj(std::abs(e0) >= std::abs(e1) ? e0 : e1);
      c = {(e0 * phase).real(), (e1 * phase).real()};
    } else {
      c = on_cone(plane, sign);
    }
    Null x;
    for (Index i = 0; i < 12; ++i) x[i] = c[0] * a[i] + c[1] * b[i];
    add_pair(x, out);
  }
}

struct Staircase {  // a matrix after elimination with complete pivoting
  Square M;
  std::array<Index, 12> column;
  double first = 0.0, last = 0.0;  // its first pivot, and what decides the null space's dimension
};

// Brings the largest entry of the corner from k on to its head; returns its size.
inline double pivot(Staircase& at, Index k) noexcept {
  Square& M = at.M;
  Index r = k, c = k;
  double big = -1.0;
  for (Index i = k; i < 12; ++i)
    for (Index j = k; j < 12; ++j)
      if (std::abs(M(i, j)) > big) {
        big = std::abs(M(i, j));
        r = i;
        c = j;
      }
  for (Index j = 0; j < 12; ++j) std::swap(M(k, j), M(r, j));
  for (Index i = 0; i < 12; ++i) std::swap(M(i, k), M(i, c));
  std::swap(at.column[k], at.column[c]);
  return big;
}

inline void reduce(Staircase& at) noexcept {
  Square& M = at.M;
  for (Index k = 0; k < 12; ++k) at.column[k] = k;
  for (Index k = 0; k < 10; ++k) {
    at.last = pivot(at, k);
    if (k == 0) at.first = at.last;
    if (!(at.last > 1e-13 * at.first)) return;
    for (Index i = k + 1; i < 12; ++i) {
      const double x = M(i, k) / M(k, k);
      for (Index j = k; j < 12; ++j) M(i, j) -= x * M(k, j);
    }
  }
  at.last = 0.0;  // the 2x2 corner left over
  for (Index i = 10; i < 12; ++i)
    for (Index j = 10; j < 12; ++j) at.last = std::max(at.last, std::abs(M(i, j)));
}

inline Null back_substitute(const Staircase& at, double x10, double x11) noexcept {
  std::array<double, 12> x{};
  x[10] = x10;
  x[11] = x11;
  for (Index i = 10; i-- > 0;) {
    double sum = 0.0;
    for (Index j = i + 1; j < 12; ++j) sum += at.M(i, j) * x[j];
    x[i] = at.M(i, i) != 0.0 ? -sum / at.M(i, i) : 0.0;
  }
  double norm = 0.0;
  for (const double e : x) norm += e * e;
  Null out;
  for (Index i = 0; i < 12; ++i) out[at.column[i]] = x[i] / std::sqrt(norm);
  return out;
}

// exp(i theta_4), exp(i theta_5) of the null vectors of M, one or two.
inline Pairs find_pairs(const Square& M) noexcept {
  Staircase at;
  at.M = M;
  reduce(at);
  Pairs out;
  // null vector of the corner: across its larger row
  const double* c = &at.M(10, 10);
  const bool upper = std::abs(c[0]) + std::abs(c[1]) >= std::abs(c[12]) + std::abs(c[13]);
  const double a = upper ? c[0] : c[12], b = upper ? c[1] : c[13];
  if (a != 0.0 || b != 0.0) add_pair(back_substitute(at, -b, a), out);
  if (at.last < 3e-4 * at.first) split(back_substitute(at, 1.0, 0.0), back_substitute(at, 0.0, 1.0), out);
  return out;
}

}  // namespace elimination
}  // namespace ikgen_runtime
