// Rows in lanes on the whole turns that the seed or the limits ask for: SolutionRows::place of all at once.
#pragma once

#include <cstddef>

#include "arm/joint_range.hpp"
#include "rows/lane_rows.hpp"
#include "arrays/lane_sines.hpp"

namespace ikgen_runtime {

// Arm: kDof, kLower, kUpper; kRevolute and kHeld, a flag a joint; Options, Policy, Rows<P>.
template <class Arm> struct LanePlacement {
  using Policy = typename Arm::Policy;

  // Rows that cannot be placed are found no more; those in doubt take Newton steps. Angles are given within a turn of (-pi, pi].
  template <class Rows> static void apply(const typename Arm::Options& options, Rows& rows) noexcept {
    constexpr int N = Rows::kLanes < kNative ? Rows::kLanes : kNative;
    for (int at = 0; at < Rows::kLanes; at += N) {
      Lanes<N> off = spread<N>(0.0);
      for (int j = 0; j < Arm::kDof; ++j) {
        Lanes<N> q = load<N>(rows.q[j] + at);
        if (Arm::kRevolute[j] && !Arm::kHeld[j]) q = turned(j, q, options);
        if (options.limits) {
          const Placed<N> placed = clamp(j, q, {Arm::kLower.data(), Arm::kUpper.data()});
          off = max(off, placed.off);
          q = placed.q;
        }
        store(q, rows.q[j] + at);
      }
      alignas(64) double kept[std::size_t{N}], close[std::size_t{N}];
      store(is_inside<Policy>(off), kept);
      store(hardly_outside<Policy>(off), close);
      for (int i = 0; i < N; ++i) {
        const int bits = rows.bits(at + i);
        const int doubt = (bits & kReal) != 0 && close[i] > 0.5 ? kRough : 0;
        rows.flags[at + i] = kept[i] > 0.5 ? bits : (bits & ~kFound) | doubt;
      }
    }
  }

 private:
  // On the turn nearest to the seed, or if that is outside the limits, on the one inside that is nearest to them.
  template <int N, bool H>
  [[gnu::always_inline]] static Lanes<N> turned(int j, const LanesOf<N, H>& given, const typename Arm::Options& options) noexcept {
    const double low = Arm::kLower.data()[j] - Policy::kLimitReach, high = Arm::kUpper.data()[j] + Policy::kLimitReach;
    const Lanes<N> q = given + select(given > -kPi, select(given > kPi, -kTurn, 0.0), kTurn);
    Lanes<N> shift = spread<N>(0.0);
    if (options.seed) shift = kTurn * nearest((options.seed->data()[j] - q) / kTurn);
    if (options.limits) {
      shift = select(low > q + shift, kTurn * -below((q - low) / kTurn), shift);
      shift = select(q + shift > high, kTurn * below((high - q) / kTurn), shift);
    }
    return q + shift;
  }

  // The largest whole number that is not above x, for |x| < 2^51.
  template <int N, bool H> [[gnu::always_inline]] static Lanes<N> below(const LanesOf<N, H>& x) noexcept {
    const Lanes<N> n = nearest(x);
    return n - select(n > x, 1.0, 0.0);
  }
};

}  // namespace ikgen_runtime
