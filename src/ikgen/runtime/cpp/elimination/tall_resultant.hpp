#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "elimination/general_6r_spectrum.hpp"
#include "elimination/pivoted_qr.hpp"

namespace ikgen_runtime {

// --- three angles of a loop from six equations that one of them by half angles leaves without rank --------
// Six equations in (1, c4, s4) x (1, c5, s5), times cosine and sine of half of theta_4, are twelve in twelve products.
// Right angles beside a slide may leave these with rank ten at every theta_3: no solution makes it less. Times cosine and
// sine of half of theta_5 as well they are 24 in sixteen products (Sylvester's dialytic elimination), which lose rank
// where there is a solution.

namespace elimination {

using Tall = Mat<24, 16>;

// Rows in (1, c, s) x (1, c', s') times the half angles of both.
template <Index R, Index C>
inline Mat<4 * R, 16> lift_both(const Mat<R, C>& A) noexcept {
  constexpr double half[2][3][4] = {{{1.0, 0.0, 0.0, 0.0}, {0.5, 0.0, 0.5, 0.0}, {0.0, 0.5, 0.0, 0.5}},
                                    {{0.0, 1.0, 0.0, 0.0}, {0.0, -0.5, 0.0, 0.5}, {0.5, 0.0, -0.5, 0.0}}};
  Mat<4 * R, 16> out{};
  for (Index a = 0; a < 2; ++a)
    for (Index b = 0; b < 2; ++b)
      for (Index r = 0; r < R; ++r)
        for (Index i = 0; i < 3; ++i)
          for (Index j = 0; j < 3; ++j)
            for (Index k = 0; k < 16; ++k)
              out((2 * a + b) * R + r, k) += A(r, 3 * i + j) * half[a][i][k / 4] * half[b][j][k % 4];
  return out;
}

struct TallResultant {  // loses rank at the solutions' theta_3
  Tall M0, Mc, Ms;
  double size;  // a bound of its norm at any angle
  Tall at(double c, double s) const noexcept {
    Tall out;
    for (Index i = 0; i < 384; ++i) out.v[i] = M0.v[i] + c * Mc.v[i] + s * Ms.v[i];
    return out;
  }
};

template <class M>
inline double frobenius(const M& A) noexcept {
  double square = 0.0;
  for (const double e : A.v) square += e * e;
  return std::sqrt(square);
}

inline TallResultant lift_both(const Pencil& p) noexcept {
  TallResultant out{lift_both(p.f), lift_both(p.c), lift_both(p.s), 0.0};
  out.size = frobenius(out.M0) + frobenius(out.Mc) + frobenius(out.Ms);
  return out;
}

using TallQr = PivotedQr<24, 16>;

// A diagonal entry of the triangle, zero behind its rank.
inline double pivot_of(const TallQr& qr, Index k) noexcept { return k < qr.rank ? std::abs(qr.a(k, k)) : 0.0; }

struct TallRoots {
  bool ranked = false;  // M has full rank elsewhere
  bool sharp = false;   // rounding leaves told which are real
  double node = 0.0;
  std::array<Complex, 32> t;  // tangents of half the angle about the node
};

// Roots of P M, P the pseudo-inverse of M where that is far from singular, at the angle opposite a node: M's, and others
// that lie anywhere. With M = M0 + N Rot(theta) W the eigenvalues of -J (1 + 2 W P N) are tan(theta/2) about the node,
// as those of square ones are. False where they cannot be had.
inline bool find_tall_roots(const Mat<6, 16>& E, const Mat<14, 12>& left, const TallResultant& M,
                            TallRoots& out) noexcept {
  constexpr int nodes = 7;
  constexpr double enough = 5e-3;  // the least pivot over the first one: so far from singular
  TallQr qr;
  double most = -1.0;
  for (int k = 0; k < nodes && most < enough; ++k) {
    const double t = 2.0 * kPi / nodes * k;
    const TallQr there(M.at(-std::cos(t), -std::sin(t)));
    const double least = pivot_of(there, 15) / (pivot_of(there, 0) + 1e-300);
    if (!(least > most)) continue;
    most = least;
    out.node = t;
    qr = there;
  }
  out.ranked = most * kNoPivot > 1.0;
  const double c = std::cos(out.node), s = std::sin(out.node);
  Mat<24, 32> N{};  // columns: the equations' cosines, then their sines, times one half angle each
  for (Index h = 0; h < 4; ++h)
    for (Index i = 0; i < 6; ++i)
      for (Index k = 0; k < 4; ++k) {
        N(6 * h + i, 4 * h + k) = c * E(i, k) + s * E(i, 4 + k);
        N(6 * h + i, 16 + 4 * h + k) = c * E(i, 4 + k) - s * E(i, k);
      }
  Mat<32, 32> A = about_node(left, qr.solve_all(N), [](const Mat<4, 12>& side) noexcept { return lift_both(side); });
  out.sharp = largest_entry(A) < kBlurred;
  return eigenvalues(A, out.t);
}

}  // namespace elimination
}  // namespace ikgen_runtime
