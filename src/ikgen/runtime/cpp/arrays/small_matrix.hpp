// Kernels on small dense arrays of fixed size. Eigen's LLT of the same 6x6 normal equations takes 285 ns where these
// take 93 (g++ 12 -O3; 240 and 56 with AVX-512), and the source that includes it 4 s to compile instead of 1.2.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace ikgen_runtime {

// The larger of two errors' sizes; what is no number is as large as can be.
inline double worse(double worst, double error) noexcept {
  return std::isfinite(error) ? std::max(worst, std::abs(error)) : std::numeric_limits<double>::infinity();
}

// X: double, or lanes.
template <class X> inline void cross(const X* a, const X* b, X* out) noexcept {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

// Rows I and on of what follows, the factors of a matrix and products of columns. A function a row: loops over rows that
// grow are left rolled, and 6x6 doubles take two to three times as long to factor.
template <int I, class X, int N> [[gnu::always_inline]] inline void factor_rows(X (&A)[N][N], double least) noexcept {
  using std::max;
  X rest = A[I][I], row[N];
  for (int j = 0; j < I; ++j) {
    row[j] = A[I][j];
    for (int k = 0; k < j; ++k) row[j] = row[j] - A[j][k] * row[k];
  }
  for (int j = 0; j < I; ++j) {
    A[I][j] = row[j] * A[j][j];
    rest = rest - A[I][j] * row[j];
  }
  A[I][I] = 1.0 / max(rest, least);
  if constexpr (I + 1 < N) factor_rows<I + 1>(A, least);
}
template <int I, class X, int Rows, int Columns>
[[gnu::always_inline]] inline void column_products(const X (&V)[Rows][Columns], X (&G)[Columns][Columns]) noexcept {
  for (int k = 0; k <= I; ++k) {
    X sum = V[0][I] * V[0][k];
    for (int r = 1; r < Rows; ++r) sum = sum + V[r][I] * V[r][k];
    G[I][k] = sum;
  }
  if constexpr (I + 1 < Columns) column_products<I + 1>(V, G);
}

// Products of a matrix's columns, V^T V, or of its rows, V V^T, up to the diagonal (Gram 1883). X: double, or lanes.
template <class X, int Rows, int Columns>
inline void gram_of_columns(const X (&V)[Rows][Columns], X (&G)[Columns][Columns]) noexcept {
  column_products<0>(V, G);
}
template <class X, int Rows, int Columns>
inline void gram_of_rows(const X (&V)[Rows][Columns], X (&G)[Rows][Rows]) noexcept {
  for (int a = 0; a < Rows; ++a)
    for (int b = 0; b <= a; ++b) {
      G[a][b] = V[a][0] * V[b][0];
      for (int k = 1; k < Columns; ++k) G[a][b] = G[a][b] + V[a][k] * V[b][k];
    }
}

// Adds x to the diagonal.
template <class X, class Y, int N> inline void shift_diagonal(const Y& x, X (&A)[N][N]) noexcept {
  for (int i = 0; i < N; ++i) A[i][i] = A[i][i] + x;
}

// The factors of A = L D L^T, symmetric and given up to its diagonal, in its place: L below the diagonal, the inverse of D
// on it, no less than `least` taken for D. X is double, or a pack of them.
template <class X, int N> inline void factor(X (&A)[N][N], double least = 1e-300) noexcept { factor_rows<0>(A, least); }

// Whether the matrix was positive definite whose factors these are.
template <class X, int N> inline auto definite(const X (&A)[N][N]) noexcept {
  auto yes = 1e299 > A[0][0];
  for (int i = 1; i < N; ++i) yes = yes & (1e299 > A[i][i]);
  return yes;
}

// The eigenvalue of a symmetric matrix that has K below it, by rotations that leave its diagonal (Jacobi 1846; Golub & Van
// Loan 2013, 8.5). In lanes.
template <int K, class X, int N> inline X eigenvalue(X (&A)[N][N]) noexcept {
  constexpr int kSweeps = 10;
  constexpr double kNone = 1e-300;
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (int p = 0; p < N; ++p)
      for (int q = p + 1; q < N; ++q) {
        const X apart = A[q][q] - A[p][p], beside = 2.0 * A[p][q];
        const X length = sqrt(apart * apart + beside * beside) + kNone;
        const X t = beside / (apart + select(apart > 0.0, length, -length));
        const X c = 1.0 / sqrt(1.0 + t * t), s = t * c;
        for (int i = 0; i < N; ++i) {
          const X x = A[i][p], y = A[i][q];
          A[i][p] = c * x - s * y;
          A[i][q] = s * x + c * y;
        }
        for (int i = 0; i < N; ++i) {
          const X x = A[p][i], y = A[q][i];
          A[p][i] = c * x - s * y;
          A[q][i] = s * x + c * y;
        }
      }
  for (int end = N - 1; end > 0; --end)
    for (int i = 0; i < end; ++i) {
      const X x = A[i][i], y = A[i + 1][i + 1];
      A[i][i] = min(x, y);
      A[i + 1][i + 1] = max(x, y);
    }
  return A[K][K];
}

// Whether the determinant of A is not below 0; eliminates in its place, with partial pivoting.
template <int N> inline bool keeps_orientation(double (&A)[N][N]) noexcept {
  bool keeps = true;
  for (int k = 0; k < N; ++k) {
    int pivot = k;
    for (int i = k + 1; i < N; ++i)
      if (std::abs(A[i][k]) > std::abs(A[pivot][k])) pivot = i;
    if (pivot != k) std::swap_ranges(A[k], A[k] + N, A[pivot]);
    keeps = keeps == ((pivot == k) == (A[k][k] >= 0.0));
    for (int i = k + 1; i < N && A[k][k] != 0.0; ++i) {
      const double share = A[i][k] / A[k][k];
      for (int j = k + 1; j < N; ++j) A[i][j] -= share * A[k][j];
    }
  }
  return keeps;
}

// x = A^-1 x by the factors of A. X may be a pack where Factor is double: each lane is a right side then.
template <class Factor, class X, int N> inline void substitute(const Factor (&A)[N][N], X (&x)[N]) noexcept {
  for (int i = 1; i < N; ++i)
    for (int k = 0; k < i; ++k) x[i] = x[i] - A[i][k] * x[k];
  for (int i = 0; i < N; ++i) x[i] = x[i] * A[i][i];
  for (int i = N - 2; i >= 0; --i)
    for (int k = N - 1; k > i; --k) x[i] = x[i] - A[k][i] * x[k];
}

// V^T e; X may be a pack where V is of doubles.
template <class Entry, class X, int Rows, int Columns>
inline void transposed_times(const Entry (&V)[Rows][Columns], const X (&e)[Rows], X (&out)[Columns]) noexcept {
  for (int k = 0; k < Columns; ++k) {
    out[k] = V[0][k] * e[0];
    for (int r = 1; r < Rows; ++r) out[k] = out[k] + V[r][k] * e[r];
  }
}

// The least squares solution of V x = e by normal equations, to whose diagonal `damping` is added. X: double, or lanes.
template <class X, class Y, int Rows, int Columns>
inline void least_squares(const X (&V)[Rows][Columns], const X (&e)[Rows], const Y& damping, X (&x)[Columns]) noexcept {
  X A[Columns][Columns];
  gram_of_columns(V, A);
  shift_diagonal(damping, A);
  transposed_times(V, e, x);
  factor(A);
  substitute(A, x);
}

// Makes a vector a unit; the inverse of how long it was.
template <int N> inline double make_unit(double (&v)[N]) noexcept {
  double square = 0.0;
  for (const double x : v) square += x * x;
  const double inverse = 1.0 / std::sqrt(square);
  for (double& x : v) x *= inverse;
  return inverse;
}

// The unit direction that a matrix shrinks most, from its factors: four steps from x.
template <int N> inline void inverse_iteration(const double (&A)[N][N], double (&x)[N]) noexcept {
  for (int i = 0; i < 2; ++i) {
    substitute(A, x);
    substitute(A, x);
    make_unit(x);
  }
}

}  // namespace ikgen_runtime
