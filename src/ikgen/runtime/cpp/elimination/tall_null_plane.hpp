#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "elimination/tall_resultant.hpp"

namespace ikgen_runtime {

// --- two of three angles from the null space of 24 equations ------------------------------------------------

namespace elimination {

using Null16 = std::array<double, 16>;
using Null16c = std::array<Complex, 16>;

struct NullPlane {  // the two directions that a matrix shrinks most, and what it leaves of them
  Null16 first, second;
  double least, next;
};

inline Null16 back_substitute(const TallQr& qr, double x14, double x15, double& length) noexcept {
  Null16 x{}, out;
  x[14] = x14;
  x[15] = x15;
  double square = x14 * x14 + x15 * x15;
  for (Index i = std::min<Index>(qr.rank, 14); i-- > 0;) {
    double sum = 0.0;
    for (Index j = i + 1; j < 16; ++j) sum += qr.a(i, j) * x[j];
    x[i] = -sum / qr.a(i, i);
    square += x[i] * x[i];
  }
  length = std::sqrt(square);
  for (Index i = 0; i < 16; ++i) out[qr.column[i]] = x[i] / length;
  return out;
}

inline NullPlane null_plane(const TallQr& qr) noexcept {
  NullPlane out;
  double length;
  const double p = pivot_of(qr, 14), r = qr.rank > 14 ? qr.a(14, 15) : 0.0, q = pivot_of(qr, 15);
  const double x14 = p > 0.0 ? -r / qr.a(14, 14) : 0.0;
  out.first = back_substitute(qr, x14, 1.0, length);
  out.least = q / length;
  out.second = back_substitute(qr, 1.0, 0.0, length);
  out.next = p / length;
  return out;
}

// Of a null vector, real or complex, the parts of the powers -3/2, -1/2 and 1/2 of exp(i theta), theta_4 or (angle 1)
// theta_5, and those of the powers -1/2, 1/2 and 3/2: exp(i theta) times as much.
struct Shifted {
  std::array<Complex, 12> lower, upper;
};
inline Shifted shifted(const Null16c& v, Index angle) noexcept {
  constexpr Complex unit(0.0, 1.0);
  Shifted out;
  for (Index i = 0; i < 4; ++i) {
    const auto at = [&](Index k) { return angle == 0 ? v[4 * k + i] : v[4 * i + k]; };
    const Complex one = at(0) + unit * at(1), back = at(0) - unit * at(1);
    out.lower[i] = at(2) - unit * at(3);
    out.lower[4 + i] = out.upper[i] = back;
    out.lower[8 + i] = out.upper[4 + i] = one;
    out.upper[8 + i] = at(2) + unit * at(3);
  }
  return out;
}

inline Null16c to_complex(const Null16& v) noexcept {
  Null16c out;
  std::copy(v.begin(), v.end(), out.begin());
  return out;
}

struct TallPairs {
  Index count = 0;
  std::array<Complex, 3> z4, z5;
};

inline void add_pair(const Null16c& v, TallPairs& out) noexcept {
  Complex z[2];
  for (Index angle = 0; angle < 2; ++angle) {
    const Shifted of = shifted(v, angle);
    z[angle] = dot(of.lower, of.upper);
    const double size = std::abs(z[angle]);
    if (!(size > 0.0)) return;
    z[angle] /= size;
  }
  out.z4[out.count] = z[0];
  out.z5[out.count++] = z[1];
}

// The two null vectors of solutions in a plane: those that the shifts by exp(i theta_4) and exp(i theta_5) only stretch.
inline void split(const NullPlane& plane, TallPairs& out) noexcept {
  constexpr Complex shares[2] = {{1.0, 0.0}, {0.8, 0.6}};  // of both in a mixture that no two solutions have in common
  const Null16c vectors[2] = {to_complex(plane.first), to_complex(plane.second)};
  Complex mixed[2][2] = {};
  for (Index angle = 0; angle < 2; ++angle) {
    const Shifted a = shifted(vectors[0], angle), b = shifted(vectors[1], angle);
    const Complex g00 = dot(a.lower, a.lower), g01 = dot(a.lower, b.lower), g11 = dot(b.lower, b.lower);
    const Complex det = g00 * g11 - g01 * std::conj(g01);
    if (!(std::abs(det) > 0.0)) return;
    for (Index k = 0; k < 2; ++k) {
      const auto& upper = (k == 0 ? a : b).upper;
      const Complex r0 = dot(a.lower, upper), r1 = dot(b.lower, upper);
      mixed[0][k] += shares[angle] * (g11 * r0 - g01 * r1) / det;
      mixed[1][k] += shares[angle] * (g00 * r1 - std::conj(g01) * r0) / det;
    }
  }
  const Complex gap = mixed[0][0] - mixed[1][1], root = std::sqrt(0.25 * gap * gap + mixed[0][1] * mixed[1][0]);
  for (const double sign : {1.0, -1.0}) {
    const Complex x = sign * root - 0.5 * gap;
    const bool above = std::abs(mixed[0][1]) >= std::abs(mixed[1][0]);
    const Complex e0 = above ? mixed[0][1] : x + gap, e1 = above ? x : mixed[1][0];
    Null16c v;
    for (Index i = 0; i < 16; ++i) v[i] = e0 * vectors[0][i] + e1 * vectors[1][i];
    add_pair(v, out);
  }
}

// The angles of the first direction, and of both where the null space has two dimensions.
inline TallPairs pairs_in(const TallQr& qr, const NullPlane& plane) noexcept {
  constexpr double twice = 1e-4;  // what the second direction leaves of it, over the most
  TallPairs out;
  add_pair(to_complex(plane.first), out);
  if (plane.next < twice * pivot_of(qr, 0)) split(plane, out);
  return out;
}

// What the angles leave of the equations.
inline double left_over(const Tall& M, Complex z4, Complex z5) noexcept {
  const Complex h4 = std::sqrt(z4), h5 = std::sqrt(z5), k4 = h4 * z4, k5 = h5 * z5;
  const double four[4] = {h4.real(), h4.imag(), k4.real(), k4.imag()};
  const double five[4] = {h5.real(), h5.imag(), k5.real(), k5.imag()};
  double square = 0.0;
  for (Index i = 0; i < 24; ++i) {
    double sum = 0.0;
    for (Index k = 0; k < 16; ++k) sum += M(i, k) * four[k / 4] * five[k % 4];
    square += sum * sum;
  }
  return 0.5 * std::sqrt(square);
}

}  // namespace elimination
}  // namespace ikgen_runtime
