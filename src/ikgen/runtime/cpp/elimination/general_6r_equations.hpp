#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>

#include "elimination/general_6r_frames.hpp"
#include "elimination/pivoted_qr.hpp"
#include "arrays/lanes.hpp"
#include "arrays/reflections.hpp"

namespace ikgen_runtime {

// --- general_6r: six equations free of theta_1, theta_2 and theta_6 ---------------------------------
// Raghavan & Roth (1990, 1993): R3 C3 R4 C4 R5 C5 = C2^-1 R2^-1 C1^-1 R1^-1 C6^-1 R6^-1; columns z and p do not
// contain theta_6, and fourteen functions of them are bilinear in the cosines and sines.

namespace elimination {

using Complex = std::complex<double>;

template <Index N> inline Complex dot(const std::array<Complex, N>& a, const std::array<Complex, N>& b) noexcept {
  Complex sum(0.0, 0.0);
  for (Index i = 0; i < N; ++i) sum += std::conj(a[i]) * b[i];
  return sum;
}

// Invariants l = z, p, m = p x l, q = (p.p) l - 2 (p.l) p: x of the four (0-3), y (4-7), z (8-11), p.p, p.l.
inline std::array<double, 14> invariants(const Frame& X) noexcept {
  const double l[3] = {X.R[0][2], X.R[1][2], X.R[2][2]};
  const auto& p = X.p;
  const double pp = p[0] * p[0] + p[1] * p[1] + p[2] * p[2], pl = p[0] * l[0] + p[1] * l[1] + p[2] * l[2];
  std::array<double, 14> v;
  for (Index i = 0; i < 3; ++i) {
    const Index j = (i + 1) % 3, k = (i + 2) % 3;
    v[4 * i] = l[i];
    v[4 * i + 1] = p[i];
    v[4 * i + 2] = p[j] * l[k] - p[k] * l[j];
    v[4 * i + 3] = pp * l[i] - 2.0 * pl * p[i];
  }
  v[12] = pp;
  v[13] = pl;
  return v;
}

// G with invariants(C X) = G (invariants(X), 1); a column of zeros for the machine's sake.
inline Mat<14, 16> action(const Frame& C) noexcept {
  const auto& t = C.p;
  const double tt = t[0] * t[0] + t[1] * t[1] + t[2] * t[2];
  Mat<14, 16> G{};
  for (Index j = 0; j < 3; ++j) {
    const double tR = t[0] * C.R[0][j] + t[1] * C.R[1][j] + t[2] * C.R[2][j];
    G(12, 4 * j + 1) = 2.0 * tR;
    G(13, 4 * j) = tR;
    for (Index i = 0; i < 3; ++i) {
      const Index n = (i + 1) % 3, m = (i + 2) % 3;
      const double cross = t[n] * C.R[m][j] - t[m] * C.R[n][j];
      for (Index k = 0; k < 4; ++k) G(4 * i + k, 4 * j + k) = C.R[i][j];
      G(4 * i + 2, 4 * j) = cross;
      G(4 * i + 3, 4 * j + 2) = -2.0 * cross;
      G(4 * i + 3, 4 * j) = tt * C.R[i][j] - 2.0 * t[i] * tR;
    }
  }
  for (Index i = 0; i < 3; ++i) {
    G(4 * i + 3, 13) = -2.0 * t[i];
    G(4 * i + 1, 14) = t[i];
  }
  G(12, 12) = G(13, 13) = 1.0;
  G(12, 14) = tt;
  return G;
}

constexpr double kC3[3] = {1.0, -0.5, -0.5};
constexpr double kS3[3] = {0.0, 0.86602540378443864676, -0.86602540378443864676};

// Invariants of X(theta) from those at three equidistant angles: coefficients of (1, c, s), and a column of zeros
// for the machine's sake.
inline Mat<14, 4> to_trig(const std::array<double, 14>& x, const std::array<double, 14>& y,
                          const std::array<double, 14>& z) noexcept {
  constexpr double third = 1.0 / 3.0, half = 2.0 / 3.0 * kS3[1];
  constexpr double weights[3][4] = {
      {third, 2.0 * third, 0.0, 0.0}, {third, -third, half, 0.0}, {third, -third, -half, 0.0}};
  const Lanes<4> a = load<4>(weights[0]), b = load<4>(weights[1]), c = load<4>(weights[2]);
  Mat<14, 4> out;
  for (Index i = 0; i < 14; ++i) store(x[i] * a + y[i] * b + z[i] * c, &out(i, 0));
  return out;
}

// A turn about z before invariants B in some monomials, then rows A of 15: f + cos c + sin s in the same monomials,
// the first of which is 1.
template <Index R, Index C>
struct alignas(64) Turned {
  Mat<R, C> f, c, s;
};

template <Index R, Index C>
inline Turned<R, C> turn_through(const Mat<R, 16>& A, const Mat<14, C>& B) noexcept {
  static_assert(C % 4 == 0);
  Turned<R, C> out;
  for (Index i = 0; i < R; ++i)
    for (Index j = 0; j < C; j += 4) {
      Lanes<4> f = spread<4>(0.0), c = f, s = f;
      for (Index k = 8; k < 14; ++k) f = f + A(i, k) * load<4>(&B(k, j));
      for (Index k = 0; k < 4; ++k) {
        const Lanes<4> x = load<4>(&B(k, j)), y = load<4>(&B(4 + k, j));
        c = c + A(i, k) * x + A(i, 4 + k) * y;
        s = s + A(i, 4 + k) * x - A(i, k) * y;
      }
      store(f, &out.f(i, j));
      store(c, &out.c(i, j));
      store(s, &out.s(i, j));
    }
  for (Index i = 0; i < R; ++i) out.f(i, 0) += A(i, 14);
  return out;
}

struct Equations {
  Mat<6, 16> E;      // times (invariants of R3 C3 R4 C4 R5 C5, 1, 0)
  Mat<14, 12> left;  // invariants of C3 R4 C4 R5 C5 in (1, c4, s4) x (1, c5, s5), and three columns of zeros
  Mat<14, 3> right;  // invariants of C1^-1 R1^-1 C6^-1 in (1, c1, s1)
  Mat<14, 16> G;     // action of C2
  double mirror[2][6], beta[2];  // reflections of right(8..13, 1..2), see `reflector`
  double r00, r01, r11;          // the triangle left over of those columns
};

// What takes the last two columns of right(8..13, ..) to their triangle; of one column, or of those in lanes.
template <class X> inline void reflect_turns(const Equations& eq, X (&h)[6]) noexcept {
  reflect<0>(eq.mirror[0], eq.beta[0], h);
  reflect<1>(eq.mirror[1], eq.beta[1], h);
}

inline void sample_left(const Loop& loop, Mat<14, 12>& left) noexcept {
  std::array<std::array<double, 14>, 3> v;
  for (Index j = 0; j < 3; ++j) v[j] = invariants(compose(rotated(loop.C[3], kC3[j], kS3[j]), loop.C[4]));
  const Turned<14, 4> four = turn_through(action(loop.C[2]), to_trig(v[0], v[1], v[2]));
  const Lanes<4> none = spread<4>(0.0);
  for (Index r = 0; r < 14; ++r) {  // three of each four
    store(load<4>(&four.f(r, 0)), &left(r, 0));
    store(load<4>(&four.c(r, 0)), &left(r, 3));
    store(load<4>(&four.s(r, 0)), &left(r, 6));
    if (r < 13) store(none, &left(r, 9));
  }
  for (Index k = 9; k < 12; ++k) left(13, k) = 0.0;
}

inline void sample_right(const Loop& loop, Mat<14, 3>& right) noexcept {
  const Frame a = inverse(loop.C[0]), b = inverse(loop.C[5]);
  std::array<std::array<double, 14>, 3> v;
  for (Index i = 0; i < 3; ++i) v[i] = invariants(compose(rotated(a, kC3[i], -kS3[i]), b));
  const Mat<14, 4> u = to_trig(v[0], v[1], v[2]);
  for (Index r = 0; r < 14; ++r)
    for (Index k = 0; k < 3; ++k) right(r, k) = u(r, k);
}

// A unit vector n with n^T (x + i y) = 0, by reflections of its real and imaginary parts: where links of the same lengths
// leave the pairs' columns dependent, minors do not tell it.
inline std::array<Complex, 4> null_by_reflections(const Mat<14, 3>& right) noexcept {
  Mat<8, 6> columns;
  for (Index i = 0; i < 4; ++i)
    for (Index k = 0; k < 3; ++k) {
      columns(i, k) = columns(4 + i, 3 + k) = right(i, k);
      columns(i, 3 + k) = right(4 + i, k);
      columns(4 + i, k) = -right(4 + i, k);
    }
  std::array<double, 8> x{};
  x[7] = 1.0;
  PivotedQr<8, 6>(columns).turn_back(x);
  std::array<Complex, 4> n;
  for (Index i = 0; i < 4; ++i) n[i] = Complex(x[i], x[4 + i]);
  return n;
}

inline constexpr double kDependent = 1e-3;  // minors over the columns' lengths, below which they lose too many digits

inline std::array<Complex, 4> null_of_pairs(const Mat<14, 3>& right) noexcept {  // by minors
  const auto times = [](Complex x, Complex y) {  // without the library's care for infinities
    return Complex(x.real() * y.real() - x.imag() * y.imag(), x.real() * y.imag() + x.imag() * y.real());
  };
  const auto at = [&](Index i, Index j) { return Complex(right(i, j), right(4 + i, j)); };
  Complex minors[4][4];  // rows i and j of the last two columns
  for (Index i = 0; i < 4; ++i)
    for (Index j = 0; j < i; ++j) {
      minors[j][i] = times(at(j, 1), at(i, 2)) - times(at(j, 2), at(i, 1));
      minors[i][j] = -minors[j][i];
    }
  std::array<Complex, 4> n;
  double norm = 1e-300, most = kDependent * kDependent;
  for (Index r = 0; r < 4; ++r) {
    const Index i = r == 0 ? 1 : 0, j = r <= 1 ? 2 : 1, k = r <= 2 ? 3 : 2;
    n[r] = times(at(i, 0), minors[j][k]) - times(at(j, 0), minors[i][k]) + times(at(k, 0), minors[i][j]);
    if (r % 2 == 1) n[r] = -n[r];
    norm += std::norm(n[r]);
  }
  for (Index j = 0; j < 3; ++j)
    most *= std::norm(at(0, j)) + std::norm(at(1, j)) + std::norm(at(2, j)) + std::norm(at(3, j));
  if (!(norm > most)) return null_by_reflections(right);
  const double over = 1.0 / std::sqrt(norm);
  for (Complex& x : n) x *= over;
  return n;
}

// Rows 4 and 5 of E.
inline void eliminate_pairs(Equations& out) noexcept {
  const std::array<Complex, 4> n = null_of_pairs(out.right);
  for (Index k = 0; k < 16; k += 8) {
    Lanes<8> re = spread<8>(0.0), im = re;
    for (Index i = 0; i < 4; ++i) {
      const Lanes<8> x = load<8>(&out.G(i, k)), y = load<8>(&out.G(4 + i, k));
      re = re + n[i].real() * x - n[i].imag() * y;
      im = im + n[i].real() * y + n[i].imag() * x;
    }
    store(re, &out.E(4, k));
    store(im, &out.E(5, k));
  }
}

// Rows 0 to 3 of E: what the reflections leave behind the first two.
inline void eliminate_turns(Equations& out) noexcept {
  for (Index k = 0; k < 16; k += 8) {
    Lanes<8> g[6];
    for (Index i = 0; i < 6; ++i) g[i] = load<8>(&out.G(8 + i, k));
    constexpr double constant[8] = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0};
    for (Index i = 0; i < 6 && k == 8; ++i) g[i] = g[i] - out.right(8 + i, 0) * load<8>(constant);
    reflect_turns(out, g);
    for (Index i = 0; i < 4; ++i) store(g[i + 2], &out.E(i, k));
  }
}

inline void triangulate_turns(Equations& out) noexcept {
  auto& [one, two] = out.mirror;
  for (Index i = 0; i < 6; ++i) {
    one[i] = out.right(8 + i, 1);
    two[i] = out.right(8 + i, 2);
  }
  const Reflected<double> first = reflector<0>(one);
  reflect<0>(one, first.beta, two);
  out.r01 = two[0];
  const Reflected<double> second = reflector<1>(two);
  out.r00 = first.alpha;
  out.r11 = second.alpha;
  out.beta[0] = first.beta;
  out.beta[1] = second.beta;
}

inline Equations eliminate(const Loop& loop) noexcept {
  Equations out;
  out.G = action(loop.C[1]);  // first, as what reads it as lanes waits for it to be in memory
  sample_left(loop, out.left);
  sample_right(loop, out.right);
  triangulate_turns(out);
  eliminate_turns(out);
  eliminate_pairs(out);
  return out;
}

// The six equations in the nine monomials (1, c4, s4) x (1, c5, s5), and three columns of zeros.
using Pencil = Turned<6, 12>;

inline Pencil make_pencil(const Mat<6, 16>& E, const Mat<14, 12>& left) noexcept { return turn_through(E, left); }

}  // namespace elimination
}  // namespace ikgen_runtime
