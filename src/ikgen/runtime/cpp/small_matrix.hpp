// Kernels on small dense arrays of fixed size. Plain loops: see the figures in runtime/cpp/README.md.
#pragma once

#include <algorithm>
#include <cmath>

#include "constants.hpp"

namespace ikgen_runtime {

inline void cross(const double* a, const double* b, double* out) noexcept {
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

template <int N> inline double dot(const double (&a)[N], const double (&b)[N]) noexcept {
  double sum = 0.0;
  for (int i = 0; i < N; ++i) sum += a[i] * b[i];
  return sum;
}

// x = A^-1 x by Cholesky's factor, which takes the place of A, symmetric and given below its diagonal.
template <int N> inline void solve_symmetric(double (&A)[N][N], double (&x)[N]) noexcept {
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = A[i][j];
      for (int k = 0; k < j; ++k) sum -= A[i][k] * A[j][k];
      A[i][j] = i == j ? std::sqrt(std::max(sum, 1e-300)) : sum / A[j][j];
    }
    for (int k = 0; k < i; ++k) x[i] -= A[i][k] * x[k];
    x[i] /= A[i][i];
  }
  for (int i = N - 1; i >= 0; --i) {
    for (int k = i + 1; k < N; ++k) x[i] -= A[k][i] * x[k];
    x[i] /= A[i][i];
  }
}

// Whether the smallest singular value of V, R <= C, is above `bound` for sure: it is at least the root of the
// determinant of V V^T over what the others can be at most, by the inequality of the means.
template <int R, int C> inline bool clearly_regular(const double (&V)[R][C], double bound) noexcept {
  double L[R][R], determinant = 1.0, trace = 0.0;
  for (int i = 0; i < R; ++i) {
    for (int j = 0; j <= i; ++j) {
      double sum = dot(V[i], V[j]);
      if (i == j) trace += sum;
      for (int k = 0; k < j; ++k) sum -= L[i][k] * L[j][k];
      if (i == j && !(sum > 1e-12)) return false;
      if (i == j) determinant *= sum;
      L[i][j] = i == j ? std::sqrt(sum) : sum / L[j][j];
    }
  }
  for (int i = 1; i < R; ++i) determinant *= (R - 1) / trace;
  return determinant > 4.0 * bound * bound;
}

// Smallest singular value of V, R <= C, squared: one-sided Jacobi rotations, in place.
template <int R, int C> inline double least_singular_square(double (&V)[R][C]) noexcept {
  for (int sweep = 0, turned = 1; sweep < 30 && turned; ++sweep) {
    turned = 0;
    for (int a = 0; a < R; ++a)
      for (int b = a + 1; b < R; ++b) {
        const double aa = dot(V[a], V[a]), bb = dot(V[b], V[b]), ab = dot(V[a], V[b]);
        if (!(ab * ab > 1e-30 * aa * bb)) continue;
        turned = 1;
        const double z = (bb - aa) / (2.0 * ab);
        const double t = std::copysign(1.0, z) / (std::abs(z) + std::sqrt(1.0 + z * z));
        const double c = 1.0 / std::sqrt(1.0 + t * t), s = c * t;
        for (int i = 0; i < C; ++i) {
          const double x = V[a][i], y = V[b][i];
          V[a][i] = c * x - s * y;
          V[b][i] = s * x + c * y;
        }
      }
  }
  double smallest = kInfinity;
  for (const auto& v : V) smallest = std::min(smallest, dot(v, v));
  return smallest;
}

}  // namespace ikgen_runtime
