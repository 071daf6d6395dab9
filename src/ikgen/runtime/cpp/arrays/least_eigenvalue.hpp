// The least eigenvalue of symmetric matrices that have none below 0, in lanes.
#pragma once

#include "arrays/lanes.hpp"
#include "arrays/small_matrix.hpp"

namespace ikgen_runtime {

// To tridiagonal form (Householder 1958): its diagonal, and the squares of what is beside that, from place 1 on.
template <class Pack, int N>
inline void tridiagonal(Pack (&S)[N][N], Pack (&diagonal)[N], Pack (&squares)[N]) noexcept {
  squares[0] = spread<kWidth<Pack>>(0.0);
  for (int k = 0; k < N; ++k) {
    diagonal[k] = S[k][k];
    if (k + 1 == N) return;
    Pack v[N], w[N], length = spread<kWidth<Pack>>(0.0), product = length;
    for (int i = k + 1; i < N; ++i) {
      v[i] = S[i][k];
      length = length + v[i] * v[i];
    }
    squares[k + 1] = length;
    if (k + 2 == N) continue;
    const Pack root = sqrt(length), turned = select(v[k + 1] > 0.0, root, -root);
    const Pack scale = 1.0 / max(length + abs(v[k + 1]) * root, 1e-300);
    v[k + 1] = v[k + 1] + turned;
    for (int i = k + 1; i < N; ++i) {
      w[i] = spread<kWidth<Pack>>(0.0);
      for (int j = k + 1; j < N; ++j) w[i] = w[i] + S[i][j] * v[j];
      w[i] = scale * w[i];
      product = product + w[i] * v[i];
    }
    product = 0.5 * scale * product;
    for (int i = k + 1; i < N; ++i) w[i] = w[i] - product * v[i];
    for (int i = k + 1; i < N; ++i)
      for (int j = k + 1; j <= i; ++j) {
        S[i][j] = S[i][j] - (v[i] * w[j] + w[i] * v[j]);
        S[j][i] = S[i][j];
      }
  }
}

// Laguerre's method from 0: where no root is below 0 its steps come to the least from the left, cubed where it is alone, and
// each by less of the one before.
template <class Pack, int N> inline Pack least_root(const Pack (&diagonal)[N], const Pack (&squares)[N]) noexcept {
  constexpr int kSteps = 40;
  constexpr double n = N;
  Pack x = spread<kWidth<Pack>>(0.0), last = x;
  for (int i = 0; i < kSteps; ++i) {
    Pack p = diagonal[0] - x, before = spread<kWidth<Pack>>(1.0), d = -before, d_before = before - 1.0, h = d_before, h_before = h;
    for (int k = 1; k < N; ++k) {
      const Pack at = diagonal[k] - x;
      const Pack next = at * p - squares[k] * before, d_next = at * d - p - squares[k] * d_before;
      const Pack h_next = at * h - 2.0 * d - squares[k] * h_before;
      before = p;
      d_before = d;
      h_before = h;
      p = next;
      d = d_next;
      h = h_next;
    }
    const auto left = (p > 0.0) & (0.0 > d);  // of all roots
    const Pack over = 1.0 / select(left, p, 1.0), g = -d * over;
    const Pack step = n / (g + sqrt((n - 1.0) * ((n - 1.0) * g * g - n * h * over)));
    x = x + select(left, step, 0.0);
    if (all(!(left & (step * step > 1e-15 * x * last)))) break;
    last = step;
  }
  return x;
}

// J J^T, or J^T J where S is of that order.
template <class Pack, int Rows, int Columns, int N>
inline void take_products(const Pack (&J)[Rows][Columns], Pack (&S)[N][N]) noexcept {
  if constexpr (N == Rows) {
    gram_of_rows(J, S);
  } else {
    gram_of_columns(J, S);
  }
  for (int a = 0; a < N; ++a)
    for (int b = 0; b < a; ++b) S[b][a] = S[a][b];
}

// Given whole; S is lost.
template <class Pack, int N> inline Pack least_eigenvalue(Pack (&S)[N][N]) noexcept {
  Pack diagonal[N], squares[N];
  tridiagonal(S, diagonal, squares);
  return least_root(diagonal, squares);
}

}  // namespace ikgen_runtime
