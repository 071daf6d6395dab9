#pragma once

#include <cstddef>

#include "arrays/lanes.hpp"

namespace ikgen_runtime {

// The roots that a routine finds in each lane: K numbers for each of B roots. In `open` lanes it can't tell whether
// there are any, and says so by a count of -1.
template <int B, int K, int N> struct Roots {
  Lanes<B * N> value[K];
  Mask<B * N> found, open;
};

template <int B, int K, int N, class F, class... X>
inline Roots<B, K, N> roots_of(const F& routine, const X&... arguments) noexcept {
  constexpr int n = sizeof...(X);
  constexpr std::size_t width = N, lanes = B * N;
  alignas(64) double in[n][width], value[K][lanes] = {}, found[lanes] = {};
  int row = 0;
  (store(spread<N>(arguments), in[row++]), ...);
  for (int lane = 0; lane < N; ++lane) {
    double x[n], roots[B][K];
    for (int i = 0; i < n; ++i) x[i] = in[i][lane];
    const int count = routine(x, roots);
    if (count < 0) found[lane] = -1.0;
    for (int b = 0; b < count; ++b) {
      for (int k = 0; k < K; ++k) value[k][b * N + lane] = roots[b][k];
      found[b * N + lane] = 1.0;
    }
  }
  Roots<B, K, N> out;
  for (int k = 0; k < K; ++k) out.value[k] = load<B * N>(value[k]);
  out.found = load<B * N>(found) > 0.5;
  out.open = -0.5 > load<B * N>(found);
  return out;
}

}  // namespace ikgen_runtime
