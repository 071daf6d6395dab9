#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <cstddef>

#include "general_6r_frames.hpp"

namespace ikgen_runtime {

// --- general_6r: six equations free of theta_1, theta_2 and theta_6 ---------------------------------
// Raghavan & Roth (1990, 1993): R3 C3 R4 C4 R5 C5 = C2^-1 R2^-1 C1^-1 R1^-1 C6^-1 R6^-1; columns z and p do not
// contain theta_6, and fourteen functions of them are bilinear in the cosines and sines.

namespace g6 {

using Complex = std::complex<double>;

// Invariants l = z, p, m = p x l, q = (p.p) l - 2 (p.l) p: x of the four (0-3), y (4-7), z (8-11), p.p, p.l.
inline std::array<double, 14> invariants(const Frame& X) noexcept {
  const double l[3] = {X.R(0, 2), X.R(1, 2), X.R(2, 2)};
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

// G with invariants(C X) = G (invariants(X), 1).
inline Mat<14, 15> action(const Frame& C) noexcept {
  const auto& t = C.p;
  const double tt = t[0] * t[0] + t[1] * t[1] + t[2] * t[2];
  Mat<14, 15> G{};
  for (Index j = 0; j < 3; ++j) {
    const double tR = t[0] * C.R(0, j) + t[1] * C.R(1, j) + t[2] * C.R(2, j);
    G(12, 4 * j + 1) = 2.0 * tR;
    G(13, 4 * j) = tR;
    for (Index i = 0; i < 3; ++i) {
      const Index n = (i + 1) % 3, m = (i + 2) % 3;
      const double cross = t[n] * C.R(m, j) - t[m] * C.R(n, j);
      for (Index k = 0; k < 4; ++k) G(4 * i + k, 4 * j + k) = C.R(i, j);
      G(4 * i + 2, 4 * j) = cross;
      G(4 * i + 3, 4 * j + 2) = -2.0 * cross;
      G(4 * i + 3, 4 * j) = tt * C.R(i, j) - 2.0 * t[i] * tR;
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

// values at three equidistant angles -> coefficients of (1, c, s)
inline void to_trig(std::array<double, 14>& a, std::array<double, 14>& b, std::array<double, 14>& c) noexcept {
  for (Index i = 0; i < 14; ++i) {
    const double x = a[i], y = b[i], z = c[i];
    a[i] = (x + y + z) / 3.0;
    b[i] = (2.0 * x - y - z) / 3.0;
    c[i] = (y - z) * (2.0 * kS3[1] / 3.0);
  }
}

struct Equations {
  Mat<6, 15> E;      // times (invariants of R3 C3 R4 C4 R5 C5, 1)
  Mat<14, 9> left;   // invariants of C3 R4 C4 R5 C5 in (1, c4, s4) x (1, c5, s5)
  Mat<14, 3> right;  // invariants of C1^-1 R1^-1 C6^-1 in (1, c1, s1)
  Mat<14, 15> G;     // action of C2
  std::array<std::array<double, 6>, 2> reflector;  // Householder vectors of right(8..13, 1..2)
  double r00, r01, r11;                            // and the triangle left over
};

inline void reflect(const std::array<double, 6>& h, double* x, Index stride) noexcept {
  double dot = 0.0;
  for (Index i = 0; i < 6; ++i) dot += h[i] * x[i * stride];
  for (Index i = 0; i < 6; ++i) x[i * stride] -= 2.0 * dot * h[i];
}

inline std::array<double, 6> householder(const double* x, Index from) noexcept {
  std::array<double, 6> h{};
  double square = 0.0;
  for (Index i = from; i < 6; ++i) square += x[i] * x[i];
  for (Index i = from; i < 6; ++i) h[i] = x[i];
  h[from] += std::copysign(std::sqrt(square), x[from]);
  double norm = 0.0;
  for (Index i = from; i < 6; ++i) norm += h[i] * h[i];
  norm = std::sqrt(norm);
  if (norm > 0.0)
    for (double& a : h) a /= norm;
  return h;
}

inline void sample_left(const Loop& loop, Mat<14, 9>& left) noexcept {
  std::array<std::array<std::array<double, 14>, 3>, 3> v;
  for (Index j = 0; j < 3; ++j) {
    const Frame D = compose(turn(loop.C[3], kC3[j], kS3[j]), loop.C[4]);
    for (Index i = 0; i < 3; ++i) v[i][j] = invariants(compose(turn(loop.C[2], kC3[i], kS3[i]), D));
  }
  for (auto& row : v) to_trig(row[0], row[1], row[2]);
  for (Index j = 0; j < 3; ++j) to_trig(v[0][j], v[1][j], v[2][j]);
  for (Index r = 0; r < 14; ++r)
    for (Index k = 0; k < 9; ++k) left(r, k) = v[k / 3][k % 3][r];
}

inline void sample_right(const Loop& loop, Mat<14, 3>& right) noexcept {
  const Frame a = inverse(loop.C[0]), b = inverse(loop.C[5]);
  std::array<std::array<double, 14>, 3> u;
  for (Index i = 0; i < 3; ++i) u[i] = invariants(compose(turn(a, kC3[i], -kS3[i]), b));
  to_trig(u[0], u[1], u[2]);
  for (Index r = 0; r < 14; ++r)
    for (Index k = 0; k < 3; ++k) right(r, k) = u[k][r];
}

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
  double norm = 1e-300;
  for (Index r = 0; r < 4; ++r) {
    const Index i = r == 0 ? 1 : 0, j = r <= 1 ? 2 : 1, k = r <= 2 ? 3 : 2;
    n[r] = times(at(i, 0), minors[j][k]) - times(at(j, 0), minors[i][k]) + times(at(k, 0), minors[i][j]);
    if (r % 2 == 1) n[r] = -n[r];
    norm += std::norm(n[r]);
  }
  const double over = 1.0 / std::sqrt(norm);
  for (Complex& x : n) x *= over;
  return n;
}

inline void eliminate_pairs(Equations& out) noexcept {
  const std::array<Complex, 4> n = null_of_pairs(out.right);
  for (Index k = 0; k < 15; ++k) {
    double re = 0.0, im = 0.0;
    for (Index i = 0; i < 4; ++i) {
      re += n[i].real() * out.G(i, k) - n[i].imag() * out.G(4 + i, k);
      im += n[i].real() * out.G(4 + i, k) + n[i].imag() * out.G(i, k);
    }
    out.E(4, k) = re;
    out.E(5, k) = im;
  }
}

inline Equations eliminate(const Loop& loop) noexcept {
  Equations out;
  sample_left(loop, out.left);
  sample_right(loop, out.right);
  out.G = action(loop.C[1]);
  std::array<double, 6> c1, c2;
  Mat<6, 15> g;
  for (Index i = 0; i < 6; ++i) {
    c1[i] = out.right(8 + i, 1);
    c2[i] = out.right(8 + i, 2);
    for (Index k = 0; k < 15; ++k) g(i, k) = out.G(8 + i, k);
    g(i, 14) -= out.right(8 + i, 0);
  }
  out.reflector[0] = householder(c1.data(), 0);
  reflect(out.reflector[0], c1.data(), 1);
  reflect(out.reflector[0], c2.data(), 1);
  out.reflector[1] = householder(c2.data(), 1);
  out.r00 = c1[0];
  out.r01 = c2[0];
  reflect(out.reflector[1], c2.data(), 1);
  out.r11 = c2[1];
  for (const auto& h : out.reflector) {
    double dot[15] = {};
    for (Index i = 0; i < 6; ++i)
      for (Index k = 0; k < 15; ++k) dot[k] += 2.0 * h[i] * g(i, k);
    for (Index i = 0; i < 6; ++i)
      for (Index k = 0; k < 15; ++k) g(i, k) -= h[i] * dot[k];
  }
  for (Index k = 0; k < 15; ++k)
    for (Index i = 0; i < 4; ++i) out.E(i, k) = g(i + 2, k);
  eliminate_pairs(out);
  return out;
}

// c += factor * A[rows from ra] * B[rows from rb], inner dimension K taken at columns ca of A
template <Index K, Index R, Index C, Index AR, Index AC, Index BR>
inline void add_product(double factor, const Mat<AR, AC>& A, Index ra, Index ca, const Mat<BR, C>& B, Index rb,
                        Mat<R, C>& c) noexcept {
  for (Index i = 0; i < R; ++i)
    for (Index k = 0; k < K; ++k) {
      const double x = factor * A(ra + i, ca + k);
      for (Index j = 0; j < C; ++j) c(i, j) += x * B(rb + k, j);
    }
}

// The six equations in the nine monomials (1, c4, s4) x (1, c5, s5): f + cos(theta_3) c + sin(theta_3) s.
struct Pencil {
  Mat<6, 9> f, c, s;
};

inline Pencil make_pencil(const Mat<6, 15>& E, const Mat<14, 9>& left) noexcept {
  Pencil out{};
  for (Index i = 0; i < 6; ++i) out.f(i, 0) = E(i, 14);
  add_product<6>(1.0, E, 0, 8, left, 8, out.f);
  add_product<8>(1.0, E, 0, 0, left, 0, out.c);
  add_product<4>(1.0, E, 0, 4, left, 0, out.s);
  add_product<4>(-1.0, E, 0, 0, left, 4, out.s);
  return out;
}

}  // namespace g6
}  // namespace ikgen_runtime
