#pragma once

#include <cstddef>

#include "arrays/lanes.hpp"

namespace ikgen_runtime {

// The roots that a routine finds in each lane: K numbers for each of B roots. Where it can't tell whether there are more
// than n it says so by a count of -1 - n, and the lane behind the last of them is `open`.
template <int B, int K, int N> struct Roots {
  Lanes<B * N> value[K];
  Mask<B * N> found, open;
};

template <int B, int K, int N, class F, class... X>
inline Roots<B, K, N> roots_of(const F& routine, const X&... arguments) noexcept {
  constexpr int n = sizeof...(X);
  constexpr std::size_t width = N, lanes = B * N;
  alignas(64) double in[n][width], value[K][lanes] = {}, found[lanes] = {}, open[lanes] = {};
  int row = 0;
  (store(spread<N>(arguments), in[row++]), ...);
  for (int lane = 0; lane < N; ++lane) {
    double x[n], roots[B][K];
    for (int i = 0; i < n; ++i) x[i] = in[i][lane];
    const int told = routine(x, roots), count = told < 0 ? -1 - told : told;
    if (told < 0 && count < B) open[count * N + lane] = 1.0;
    for (int b = 0; b < count; ++b) {
      for (int k = 0; k < K; ++k) value[k][b * N + lane] = roots[b][k];
      found[b * N + lane] = 1.0;
    }
  }
  Roots<B, K, N> out;
  for (int k = 0; k < K; ++k) out.value[k] = load<B * N>(value[k]);
  out.found = load<B * N>(found) > 0.5;
  out.open = load<B * N>(open) > 0.5;
  return out;
}

}  // namespace ikgen_runtime
