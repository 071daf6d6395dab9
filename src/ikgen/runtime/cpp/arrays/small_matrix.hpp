// Kernels on small dense arrays of fixed size. Eigen's LLT of the same 6x6 normal equations takes 184 ns where these
// take 168 (g++ 12 -O3; 166 and 93 with AVX-512), and the source that includes it 4 s to compile instead of 1.2.
#pragma once

#include <algorithm>
#include <cmath>

namespace ikgen_runtime {

// X: double, or lanes.
template <class X> inline void cross(const X* a, const X* b, X* out) noexcept {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

// Cholesky's factor of A, symmetric and given up to its diagonal, in its place, but for inverses on its diagonal. X is
// double, or a pack of them.
template <class X, int N> inline void factor(X (&A)[N][N]) noexcept {
  using std::max;
  using std::sqrt;
  for (int i = 0; i < N; ++i)
    for (int j = 0; j <= i; ++j) {
      X sum = A[i][j];
      for (int k = 0; k < j; ++k) sum = sum - A[i][k] * A[j][k];
      A[i][j] = i == j ? 1.0 / sqrt(max(sum, 1e-300)) : sum * A[j][j];
    }
}

// Whether the matrix was positive definite whose factor this is.
template <class X, int N> inline auto definite(const X (&L)[N][N]) noexcept {
  auto yes = 1e149 > L[0][0];
  for (int i = 1; i < N; ++i) yes = yes & (1e149 > L[i][i]);
  return yes;
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
    for (int i = k + 1; i < N && A[k][k] != 0.0; ++i)
      for (int j = N - 1; j >= k; --j) A[i][j] -= A[i][k] / A[k][k] * A[k][j];
  }
  return keeps;
}

// x = A^-1 x by the factor of A.
template <class X, int N> inline void substitute(const X (&L)[N][N], X (&x)[N]) noexcept {
  for (int i = 0; i < N; ++i) {
    for (int k = 0; k < i; ++k) x[i] = x[i] - L[i][k] * x[k];
    x[i] = x[i] * L[i][i];
  }
  for (int i = N - 1; i >= 0; --i) {
    for (int k = i + 1; k < N; ++k) x[i] = x[i] - L[k][i] * x[k];
    x[i] = x[i] * L[i][i];
  }
}

}  // namespace ikgen_runtime
