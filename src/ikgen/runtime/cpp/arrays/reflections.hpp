#pragma once

#include <cmath>

#include "arrays/lanes.hpp"

namespace ikgen_runtime {

// Reflections (Householder 1958), of one row (X: double) or of those in lanes.
template <class X> struct Reflected {  // a row x -> (alpha, 0, ...): x - beta (x . v) v
  X beta, alpha, square;
};

// Makes v of entries K.. of the row, in place.
template <int K, class X, int N> inline Reflected<X> reflector(X (&row)[N]) noexcept {
  using std::sqrt;
  X square = row[K] * row[K], other = constant<X>(1e-300);
  for (int j = K + 1; j < N; ++j) {
    if (j % 2 == 0)
      square = square + row[j] * row[j];
    else
      other = other + row[j] * row[j];
  }
  square = square + other;
  const X norm = sqrt(square);
  const X alpha = select(row[K] > 0.0, -norm, norm);
  row[K] = row[K] - alpha;
  return {-1.0 / (alpha * row[K]), alpha, square};
}

// Of the row, or of one in each lane by the same v.
template <int K, class V, class X, int N> inline void reflect(const V (&v)[N], const V& beta, X (&row)[N]) noexcept {
  X even = row[K] * v[K], odd = constant<X>(0.0);
  for (int j = K + 1; j < N; ++j) {
    if (j % 2 == 0)
      even = even + row[j] * v[j];
    else
      odd = odd + row[j] * v[j];
  }
  const X dot = beta * (even + odd);
  for (int j = K; j < N; ++j) row[j] = row[j] - dot * v[j];
}

}  // namespace ikgen_runtime
