#pragma once

#include <algorithm>
#include <cmath>

#include "elimination/general_6r_null_space.hpp"

namespace ikgen_runtime {

// --- general_6r: values of the resultant, and how far off they may be --------------------------------

namespace elimination {

// One over what the rows of A are off in proportion to, squared: the largest that they can be, or a share of the largest of
// all, from which a smaller one is what is left. Where an elimination has no rank a row is nothing but round-off.
struct RowSizes {
  double over[6];
};

inline constexpr double kOfLargest = 1.0 / 1600.0;  // squared

inline RowSizes row_sizes(const Pencil& p) noexcept {
  double square[6], largest = 0.0;
  for (Index i = 0; i < 6; ++i) {
    square[i] = 1e-300;
    for (Index j = 0; j < 9; ++j) {
      const double size = std::abs(p.f(i, j)) + std::abs(p.c(i, j)) + std::abs(p.s(i, j));
      square[i] += size * size;
    }
    largest = std::max(largest, square[i]);
  }
  RowSizes out;
  for (Index i = 0; i < 6; ++i) out.over[i] = 1.0 / std::max(square[i], kOfLargest * largest);
  return out;
}

// Relative error of the pencil's rows. An error of a row moves A's null space by at most the largest ratio of a row
// to what its reflection leaves of it, and the determinant of half angles by the adjugate's norm times that. The
// squares of that matrix's entries sum to 6, so its adjugate's norm is at most (6/5)^(5/2) a direction; it is far
// smaller where two solutions share the angle. At 68,000 known solutions of 34 arms f was off by at most 0.03 times
// the largest of the nodes' bounds, and 0.8 times the bound at its own angle.
inline constexpr double kBlur = 8e-15, kMostAdjugate = 1.6;

struct Spread {
  Wide squares, ratio;  // det(A A^T); largest ratio of a row to what is left of it
};

inline Spread spread_of(const WideReflected (&h)[6], const RowSizes& sizes) noexcept {
  Wide least = sizes.over[0] * h[0].square;
  for (int k = 1; k < 6; ++k) least = min(least, sizes.over[k] * h[k].square);
  const Wide squares = ((h[0].square * h[1].square) * (h[2].square * h[3].square)) * (h[4].square * h[5].square);
  return {squares, 1.0 / sqrt(least + 1e-300)};
}

// Frobenius norm of the adjugate of a matrix [[L, 0], [M, C]] Q, L 4x4 with the product of its diagonal, C 2x2 with
// its determinant: det L (det C L^-1; -adj C M L^-1, adj C).
inline Wide adjugate_size(const Wide (&A)[6][6], const WideReflected (&h)[6], const Wide& product,
                          const Wide& corner) noexcept {
  Wide X[4][4], inner = spread<kWide>(0.0), outer = inner;
  for (int i = 0; i < 4; ++i) {
    X[i][i] = 1.0 / select(abs(h[i].alpha) > 1e-150, h[i].alpha, spread<kWide>(1e-150));
    for (int j = 0; j < i; ++j) {
      Wide sum = A[i][j] * X[j][j];
      for (int k = j + 1; k < i; ++k) sum = sum + A[i][k] * X[k][j];
      X[i][j] = -X[i][i] * sum;
    }
    for (int j = 0; j <= i; ++j) inner = inner + X[i][j] * X[i][j];
  }
  for (int j = 0; j < 4; ++j) {
    Wide u = A[4][j] * X[j][j], v = A[5][j] * X[j][j];
    for (int k = j + 1; k < 4; ++k) {
      u = u + A[4][k] * X[k][j];
      v = v + A[5][k] * X[k][j];
    }
    const Wide x = A[5][5] * u - A[4][5] * v, y = A[4][4] * v - A[5][4] * u;
    outer = outer + x * x + y * y;
  }
  for (int i = 4; i < 6; ++i)
    for (int j = 4; j < 6; ++j) outer = outer + A[i][j] * A[i][j];
  return abs(product) * sqrt(corner * corner * inner + outer);
}

// As many groups of nodes are worked on at once as do not wait for each other's registers.
inline constexpr int kGroups = kNative >= 8 ? 3 : 1;

// `groups` groups of angles, at which fill(p, cosine, sine, A) gives A. Their number is an argument lest loops over it
// are written out: the code is to stay in the cache.
template <class Source>
[[gnu::noinline]] inline void resultants_of(int groups, const Source& p, const RowSizes& sizes, bool close,
                                            const double* c, const double* s, double* f, double* blur) noexcept {
  Wide A[kGroups][6][9], basis[kGroups][3][9], K[kGroups][6][6];
  WideReflected h[kGroups][6], k[kGroups][6];
  for (int g = 0; g < groups; ++g) fill(p, load<kWide>(c + g * kWide), load<kWide>(s + g * kWide), A[g]);
  null_bases(groups, A, basis, h);
  for (int g = 0; g < groups; ++g) half_angles(basis[g], K[g]);
  triangulate<0, 2>(groups, K, k);
  for (int g = 0; g < groups; ++g) {
    const Wide corner = K[g][4][4] * K[g][5][5] - K[g][4][5] * K[g][5][4];
    const Wide product = (k[g][0].alpha * k[g][1].alpha) * (k[g][2].alpha * k[g][3].alpha);
    const Spread rows = spread_of(h[g], sizes);
    store(rows.squares * (product * corner), f + g * kWide);
    const Wide adjugate = close ? adjugate_size(K[g], k[g], product, corner) : spread<kWide>(kMostAdjugate);
    store(rows.squares * rows.ratio * (adjugate + kBlur * rows.ratio), blur + g * kWide);
  }
}

// f at N angles, and the most that it may be off by the rounding in the pencil; close: tight where f is small.
template <int N, class Source>
inline void resultants(const Source& p, bool close, const double (&c)[N], const double (&s)[N], double (&f)[N],
                       double (&blur)[N]) noexcept {
  static_assert(N % kWide == 0);
  const RowSizes sizes = row_sizes(p);
  for (int n = 0; n < N; n += kGroups * kWide) {
    const int groups = std::min(kGroups, (N - n) / kWide);
    resultants_of(groups, p, sizes, close, c + n, s + n, f + n, blur + n);
    for (int i = n; i < n + groups * kWide; ++i) blur[i] *= kBlur;
  }
}

}  // namespace elimination
}  // namespace ikgen_runtime
