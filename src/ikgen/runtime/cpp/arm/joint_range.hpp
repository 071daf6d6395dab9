// Joint values in lanes, put where they must lie.
#pragma once

#include "arrays/constants.hpp"
#include "arrays/lanes.hpp"

namespace ikgen_runtime {

struct Range {
  const double* lower;
  const double* upper;
};

template <int N> struct Unbounded {
  double lower[N], upper[N];
  constexpr Unbounded() noexcept : lower(), upper() {
    for (int i = 0; i < N; ++i) {
      lower[i] = -kInfinity;
      upper[i] = kInfinity;
    }
  }
};
template <int N> inline constexpr Unbounded<N> kUnbounded{};

// near: whether it is no farther outside than what tells nothing of a closed form's row.
template <int N> struct Placed {
  Lanes<N> q;
  Mask<N> inside, nearby;
};

template <class Policy, int N, bool H>
[[gnu::always_inline]] inline Placed<N> clamp(int j, const LanesOf<N, H>& q, const Range& range) noexcept {
  const auto outside =
      (range.lower[j] - Policy::kLimitTolerance > q) | (q > range.upper[j] + Policy::kLimitTolerance);
  const auto remote = (range.lower[j] - Policy::kLimitDoubt > q) | (q > range.upper[j] + Policy::kLimitDoubt);
  return {max(min(q, range.upper[j]), range.lower[j]), !outside, !remote};
}

// Value of joint j, given in (-pi, pi], on the whole turn that lies in the range.
template <class Policy, int N, bool H>
[[gnu::always_inline]] inline Placed<N> place(int j, const LanesOf<N, H>& q, const Range& range) noexcept {
  const auto up = select(range.lower[j] - Policy::kLimitDoubt > q, kTurn, 0.0);
  const auto down = select(q > range.upper[j] + Policy::kLimitDoubt, kTurn, 0.0);
  return clamp<Policy>(j, q + (up - down), range);
}

}  // namespace ikgen_runtime
