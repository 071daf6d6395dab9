#pragma once

#include "general_6r_equations.hpp"
#include "lanes.hpp"

namespace ikgen_runtime {

// --- general_6r: the resultant at many angles side by side ------------------------------------------
// A(theta_3) is the 6x9 matrix of the equations. Its null space has an orthonormal basis (N0; Nc; Ns), 3x3 each;
// a solution is a vector y with Nc y = c4 N0 y and Ns y = s4 N0 y, which by half angles is
//   [[Nc - N0, Ns], [Ns, -(Nc + N0)]] (cos(theta_4/2) y; sin(theta_4/2) y) = 0.
// f = det(A A^T) det [...] depends on the basis not even in sign: a trigonometric polynomial of degree 8 whose
// roots are all solutions' theta_3. Householder's reflections instead of pivoting: no lane waits for another.

namespace g6 {

inline constexpr int kWide = kNative > 1 ? kNative : 2;
using Wide = Lanes<kWide>;
using WideMask = Mask<kWide>;

inline bool any(const WideMask& mask) noexcept {
  double flags[kWide];
  store(mask, flags);
  double sum = 0.0;
  for (const double x : flags) sum += x;
  return sum > 0.0;
}

struct Reflected {  // a row x -> (alpha, 0, ...): x - beta (x . v) v
  Wide beta, alpha, square;
};

// Makes v of entries K.. of the row, in place.
template <int K, int N>
inline Reflected reflector(Wide (&row)[N]) noexcept {
  Wide square = row[K] * row[K], other = spread<kWide>(1e-300);
  for (int j = K + 1; j < N; ++j) {
    if (j % 2 == 0)
      square = square + row[j] * row[j];
    else
      other = other + row[j] * row[j];
  }
  square = square + other;
  const Wide norm = sqrt(square);
  const Wide alpha = select(row[K] > 0.0, -norm, norm);
  row[K] = row[K] - alpha;
  return {-1.0 / (alpha * row[K]), alpha, square};
}

template <int K, int N>
inline void reflect(const Wide (&v)[N], const Wide& beta, Wide (&row)[N]) noexcept {
  Wide even = row[K] * v[K], odd = spread<kWide>(0.0);
  for (int j = K + 1; j < N; ++j) {
    if (j % 2 == 0)
      even = even + row[j] * v[j];
    else
      odd = odd + row[j] * v[j];
  }
  const Wide dot = beta * (even + odd);
  for (int j = K; j < N; ++j) row[j] = row[j] - dot * v[j];
}

// Rows K.. of A to lower triangular form; det(A A^T) is the product of the squares.
template <int K, int R, int N>
inline void triangulate(Wide (&A)[R][N], Wide (&beta)[R], Wide& squares) noexcept {
  if constexpr (K < R) {
    const Reflected h = reflector<K>(A[K]);
    beta[K] = h.beta;
    squares = squares * h.square;
    for (int i = K + 1; i < R; ++i) reflect<K>(A[K], h.beta, A[i]);
    triangulate<K + 1>(A, beta, squares);
  }
}

template <int K>
inline void carry_back(const Wide (&A)[6][9], const Wide (&beta)[6], Wide (&basis)[3][9]) noexcept {
  for (auto& n : basis) reflect<K>(A[K], beta[K], n);
  if constexpr (K > 0) carry_back<K - 1>(A, beta, basis);
}

inline void fill(const Pencil& p, const Wide& c, const Wide& s, Wide (&A)[6][9]) noexcept {
  for (Index i = 0; i < 6; ++i)
    for (Index j = 0; j < 9; ++j) A[i][j] = p.f(i, j) + c * p.c(i, j) + s * p.s(i, j);
}

// Orthonormal null vectors, and det(A A^T).
inline Wide null_basis(const Pencil& p, const Wide& c, const Wide& s, Wide (&basis)[3][9]) noexcept {
  Wide A[6][9], beta[6], squares = spread<kWide>(1.0);
  fill(p, c, s, A);
  triangulate<0>(A, beta, squares);
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 9; ++j) basis[k][j] = spread<kWide>(j == 6 + k ? 1.0 : 0.0);
  carry_back<5>(A, beta, basis);
  return squares;
}

// The 6x6 matrix of half angles, by rows.
template <int N>
inline void half_angles(const Wide (&basis)[3][9], Wide (&K)[6][N]) noexcept {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      K[i][j] = basis[j][3 + i] - basis[j][i];
      K[i][3 + j] = K[3 + i][j] = basis[j][6 + i];
      K[3 + i][3 + j] = -(basis[j][3 + i] + basis[j][i]);
    }
}

template <int K>
inline Wide determinant(Wide (&A)[6][6]) noexcept {
  if constexpr (K == 4) {
    return A[4][4] * A[5][5] - A[4][5] * A[5][4];
  } else {
    const Reflected h = reflector<K>(A[K]);
    for (int i = K + 1; i < 6; ++i) reflect<K>(A[K], h.beta, A[i]);
    return h.alpha * determinant<K + 1>(A);
  }
}

// f at N angles, N a multiple of the lanes.
template <int N>
inline void resultants(const Pencil& p, const double (&c)[N], const double (&s)[N], double (&f)[N]) noexcept {
  for (int n = 0; n < N; n += kWide) {
    Wide basis[3][9], K[6][6];
    const Wide squares = null_basis(p, load<kWide>(c + n), load<kWide>(s + n), basis);
    half_angles(basis, K);
    store(squares * determinant<0>(K), f + n);
  }
}

}  // namespace g6
}  // namespace ikgen_runtime
