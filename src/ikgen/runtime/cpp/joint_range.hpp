// Joint values in lanes, put where they must lie.
#pragma once

#include "constants.hpp"
#include "lanes.hpp"

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

// A value inside the range, and how far `off` that it was: not above 0 where it lay there.
template <int N> struct Placed {
  Lanes<N> q, off;
};

template <class Policy, int N, bool H>
[[gnu::always_inline]] inline Placed<N> clamp(int j, const LanesOf<N, H>& q, const Range& range) noexcept {
  return {max(min(q, range.upper[j]), range.lower[j]), max(range.lower[j] - q, q - range.upper[j])};
}

// Whether rows lie inside that were so far off.
template <class Policy, int N, bool H> [[gnu::always_inline]] inline Mask<N> inside(const LanesOf<N, H>& off) noexcept {
  return !(off > Policy::kLimitTolerance);
}

// Whether they are hardly outside: near singularities the pose does not tell that.
template <class Policy, int N, bool H>
[[gnu::always_inline]] inline Mask<N> hardly_outside(const LanesOf<N, H>& off) noexcept {
  return (off > Policy::kLimitTolerance) & (Policy::kLimitReach > off);
}

// Value of joint j, given in (-pi, pi], on the whole turn that lies in the range.
template <class Policy, int N, bool H>
[[gnu::always_inline]] inline Placed<N> place(int j, const LanesOf<N, H>& q, const Range& range) noexcept {
  const auto up = select(range.lower[j] - Policy::kLimitReach > q, kTurn, 0.0);
  const auto down = select(q > range.upper[j] + Policy::kLimitReach, kTurn, 0.0);
  return clamp<Policy>(j, q + (up - down), range);
}

}  // namespace ikgen_runtime
