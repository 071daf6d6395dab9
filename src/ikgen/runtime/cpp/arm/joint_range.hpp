// Joint values in lanes, put where they must lie.
#pragma once

#include "arrays/constants.hpp"
#include "arrays/lanes.hpp"

namespace ikgen_runtime {

// The difference of two angles within a turn of each other, on the shortest way.
inline double shortest(double gap, double turn = kTurn) noexcept {
  return gap > 0.5 * turn ? gap - turn : gap < -0.5 * turn ? gap + turn : gap;
}
template <int N, bool H>
[[gnu::always_inline]] inline Lanes<N> shortest(const LanesOf<N, H>& gap, double turn = kTurn) noexcept {
  return gap + select(gap > 0.5 * turn, -turn, select(-0.5 * turn > gap, turn, 0.0));
}

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

// A joint's value inside the range, and how far outside it was.
template <int N> struct Placed {
  Lanes<N> q, off;
};

template <int N, bool H>
[[gnu::always_inline]] inline Placed<N> clamp(int j, const LanesOf<N, H>& q, const Range& range) noexcept {
  const Lanes<N> inside = max(min(q, range.upper[j]), range.lower[j]);
  return {inside, abs(q - inside)};
}

// Value of joint j, given in (-turn / 2, turn / 2], on the turn that lies in the range, or hardly outside.
template <class Policy, int N, bool H>
[[gnu::always_inline]] inline Placed<N> place(int j, const LanesOf<N, H>& q, const Range& range, double turn) noexcept {
  const auto up = select(range.lower[j] - Policy::kLimitReach > q, turn, 0.0);
  const auto down = select(q > range.upper[j] + Policy::kLimitReach, turn, 0.0);
  return clamp(j, q + (up - down), range);
}

// Whether rows whose joints are `off` that far at most are inside; whether hardly outside, which a closed form's row may be
// by round-off: Newton steps tell.
template <class Policy, int N, bool H> [[gnu::always_inline]] inline Mask<N> is_inside(const LanesOf<N, H>& off) noexcept {
  return !(off > Policy::kLimitTolerance);
}
template <class Policy, int N, bool H> [[gnu::always_inline]] inline Mask<N> hardly_outside(const LanesOf<N, H>& off) noexcept {
  return (off > Policy::kLimitTolerance) & (Policy::kLimitReach > off);
}

}  // namespace ikgen_runtime
