#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "elimination/general_6r_eigenvalues.hpp"
#include "elimination/general_6r_equations.hpp"

namespace ikgen_runtime {

// --- general_6r: the hidden angle as an eigenvalue ---------------------------------------------------
// The resultant M(theta_3) is kept real by half angles and, because theta_3 turns four vectors of the left side, its
// sixteen roots are the eigenvalues of a real 16x16 matrix with nothing extraneous, where Manocha & Canny (1994) have
// 24x24 and (1 + x^2)^4.

namespace elimination {

// Rows in (1, c, s) x (1, c', s') times cos h and sin h, h half the first angle.
template <Index R, Index C>
inline Mat<2 * R, 12> lift(const Mat<R, C>& A) noexcept {
  Mat<2 * R, 12> out;
  for (Index i = 0; i < R; ++i)
    for (Index k = 0; k < 3; ++k) {
      const double a0 = A(i, k), a1 = 0.5 * A(i, 3 + k), a2 = 0.5 * A(i, 6 + k);
      out(i, k) = a0 + a1;
      out(i, 3 + k) = out(i, 9 + k) = out(R + i, k) = out(R + i, 9 + k) = a2;
      out(i, 6 + k) = a1;
      out(R + i, 3 + k) = a0 - a1;
      out(R + i, 6 + k) = -a2;
      out(R + i, 9 + k) = a1;
    }
  return out;
}

using Square = Mat<12, 12>;

struct Resultant {  // singular at the solutions' theta_3
  Square M0, Mc, Ms;
  Square at(double c, double s) const noexcept {
    Square out;
    for (Index i = 0; i < 144; ++i) out.v[i] = M0.v[i] + c * Mc.v[i] + s * Ms.v[i];
    return out;
  }
};

inline Resultant lift(const Pencil& p) noexcept { return {lift(p.f), lift(p.c), lift(p.s)}; }

// LU with partial pivoting in place; returns |determinant|.
template <Index N>
inline double factor_by_rows(Mat<N, N>& A, std::array<Index, N>& pivot) noexcept {
  double det = 1.0;
  for (Index k = 0; k < N; ++k) {
    Index best = k;
    for (Index i = k + 1; i < N; ++i)
      if (std::abs(A(i, k)) > std::abs(A(best, k))) best = i;
    pivot[k] = best;
    if (best != k)
      for (Index j = 0; j < N; ++j) std::swap(A(k, j), A(best, j));
    const double d = A(k, k);
    if (d == 0.0) return 0.0;
    det *= std::abs(d);
    for (Index i = k + 1; i < N; ++i) {
      const double x = A(i, k) /= d;
      for (Index j = k + 1; j < N; ++j) A(i, j) -= x * A(k, j);
    }
  }
  return det;
}

inline void solve(const Square& A, const std::array<Index, 12>& pivot, Mat<12, 16>& b) noexcept {
  for (Index k = 0; k < 12; ++k)
    if (pivot[k] != k)
      for (Index j = 0; j < 16; ++j) std::swap(b(k, j), b(pivot[k], j));
  for (Index i = 1; i < 12; ++i)
    for (Index k = 0; k < i; ++k)
      for (Index j = 0; j < 16; ++j) b(i, j) -= A(i, k) * b(k, j);
  for (Index i = 12; i-- > 0;) {
    for (Index k = i + 1; k < 12; ++k)
      for (Index j = 0; j < 16; ++j) b(i, j) -= A(i, k) * b(k, j);
    for (Index j = 0; j < 16; ++j) b(i, j) /= A(i, i);
  }
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

// -J (1 + K) of the upper and lower half of K, J a quarter turn of the halves.
template <Index N>
inline Mat<2 * N, 2 * N> quarter_turned(const Mat<N, 2 * N>& top, const Mat<N, 2 * N>& bottom) noexcept {
  Mat<2 * N, 2 * N> out;
  for (Index i = 0; i < N; ++i)
    for (Index j = 0; j < 2 * N; ++j) {
      out(i, j) = bottom(i, j) + (j == N + i ? 1.0 : 0.0);
      out(N + i, j) = -(top(i, j) + (j == i ? 1.0 : 0.0));
    }
  return out;
}

// -J (1 + 2 W P N) of `solved`, P N, with W the left side's terms in the cosine of theta_3, then in its sine, as `lifted`
// has them.
template <Index K, Index C, class Lift>
inline Mat<C, C> about_node(const Mat<14, 12>& left, const Mat<K, C>& solved, const Lift& lifted) noexcept {
  Mat<4, 12> x, y;
  std::copy_n(left.v.begin(), 48, x.v.begin());
  std::copy_n(left.v.begin() + 48, 48, y.v.begin());
  Mat<C / 2, C> top{}, bottom{};
  add_product<K>(2.0, lifted(x), 0, 0, solved, 0, top);
  add_product<K>(2.0, lifted(y), 0, 0, solved, 0, bottom);
  return quarter_turned(top, bottom);
}

// Of the eigenproblem's entries: rounding, grown by their square, hides whether a root is real, or half of its digits are
// rounding; of the largest pivot of M_pi over its least: nearly all are.
inline constexpr double kBlurred = 1e6;
inline constexpr double kNoRank = 1e9;
inline constexpr double kNoPivot = 1e11;

template <class M>
inline double largest_entry(const M& A) noexcept {
  double largest = 0.0;
  for (const double entry : A.v) largest = std::max(largest, std::abs(entry));
  return largest;
}

// rad: imaginary part below which a root is real, or may be half of a double one, and one of four a quarter of a fourfold
// one.
inline constexpr double kReal = 1e-8, kHalf = 1e-3, kQuarter = 4e-3;

struct Spectrum {
  int count = 0;  // roots theta_3 with imaginary parts below `accept`
  int real = 0;   // those that are clearly real; -1 where the elimination does not tell
  int perhaps = 0;  // those that are, or may be halves of double ones
  bool simple = false;  // all of them are
  bool doubtful = false;  // there are others that may be, of which rounding has made complex ones
  bool stalled = false;  // steps from one of them come near a solution, and no closer
  std::array<double, 16> theta;
};

struct Node {  // where M_pi, M at the opposite angle, is far from singular
  double angle = 0.0, c = 1.0, s = 0.0, determinant = 0.0;
  Square lu;
  std::array<Index, 12> pivot;

  bool has_rank() const noexcept {
    double least = kInfinity, most = 0.0;
    for (Index i = 0; i < 12; ++i) {
      least = std::min(least, std::abs(lu(i, i)));
      most = std::max(most, std::abs(lu(i, i)));
    }
    return most < kNoPivot * least;
  }
};

inline void best_node(const Resultant& M, Node& out) noexcept {
  for (int k = 0; k < 7; ++k) {
    Square lu;
    std::array<Index, 12> pivot;
    const double t = 2.0 * kPi / 7.0 * k, c = std::cos(t), s = std::sin(t);
    lu = M.at(-c, -s);
    const double determinant = factor_by_rows(lu, pivot);
    if (determinant > out.determinant) out = {t, c, s, determinant, lu, pivot};
  }
}

struct Root {
  double angle, off;  // the real part, and how large the imaginary one is
};

// node + 2 atan(t): modulus and angle of (1 + i t) / (1 - i t).
inline Root root_of(const Complex& t, double node) noexcept {
  const double a = t.real(), b = t.imag();
  const double off = std::abs(0.5 * std::log(((1.0 - b) * (1.0 - b) + a * a + 1e-300) /
                                             ((1.0 + b) * (1.0 + b) + a * a + 1e-300)));
  return {node + std::atan2(a, 1.0 - b) + std::atan2(a, 1.0 + b), off};
}

// The roots theta_3 of eigenvalues t.
template <Index N>
inline void add_angles(const std::array<Complex, N>& t, double node, double accept, Spectrum& out) noexcept {
  int quarters = 0;
  for (const Complex& e : t) {
    const Root root = root_of(e, node);
    if (!(root.off < accept)) continue;
    out.theta[static_cast<Index>(out.count++)] = root.angle;
    out.real += root.off < kReal ? 1 : 0;
    out.perhaps += root.off < kHalf ? 1 : 0;
    quarters += root.off < kQuarter ? 1 : 0;
  }
  out.simple = out.count == out.real;
  out.doubtful = out.perhaps > out.real || quarters >= out.real + 4;
}

// With M(theta) = M0 + N Rot(theta) W, Rot = c + s J on R^16, about a node where M_pi = M0 - N W is far from
// singular: tan(theta/2) are the eigenvalues of -J (1 + 2 W M_pi^-1 N). Where M is singular at every angle these mean
// nothing.
inline Spectrum find_roots(const Mat<6, 16>& E, const Mat<14, 12>& left, const Resultant& M, double accept) noexcept {
  Node node;
  Spectrum out;
  out.real = -1;
  best_node(M, node);
  if (!(node.determinant > 0.0)) return out;
  Mat<12, 16> N{};
  for (Index i = 0; i < 6; ++i)
    for (Index k = 0; k < 4; ++k) {
      N(i, k) = N(6 + i, 4 + k) = node.c * E(i, k) + node.s * E(i, 4 + k);
      N(i, 8 + k) = N(6 + i, 12 + k) = node.c * E(i, 4 + k) - node.s * E(i, k);
    }
  solve(node.lu, node.pivot, N);
  Mat<16, 16> A = about_node(left, N, [](const Mat<4, 12>& side) noexcept { return lift(side); });
  const double largest = largest_entry(A);
  std::array<Complex, 16> t;
  if (!eigenvalues(A, t)) return out;
  out.real = 0;
  add_angles(t, node.angle, accept, out);
  if (!(largest < kBlurred)) out.doubtful = true;
  if (!(largest < kNoRank && node.has_rank())) out.real = -1;
  return out;
}

}  // namespace elimination
}  // namespace ikgen_runtime
