// Rows in lanes on the whole turns that the seed or the limits ask for: SolutionRows::place of all at once.
#pragma once

#include <algorithm>
#include <cstddef>

#include "arm/joint_range.hpp"
#include "rows/lane_rows.hpp"
#include "arrays/lane_sines.hpp"

namespace ikgen_runtime {

// Arm: kDof, kLower, kUpper; kPeriod and kHeld, as of SolutionRows; Options, Policy, Rows<P>.
template <class Arm> struct LanePlacement {
  using Policy = typename Arm::Policy;

  // Rows that cannot be placed are found no more; those in doubt take Newton steps. Values are given within a turn of the one around 0.
  template <class Rows> static void apply(const typename Arm::Options& options, Rows& rows) noexcept {
    constexpr int N = Rows::kLanes < kNative ? Rows::kLanes : kNative;
    for (int at = 0; at < Rows::kLanes; at += N) {
      Lanes<N> off = spread<N>(0.0);
      for (int j = 0; j < Arm::kDof; ++j) {
        Lanes<N> q = load<N>(rows.q[j] + at);
        if (Arm::kPeriod[j] > 0.0 && !Arm::kHeld[j]) q = turned(j, q, options);
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
  // On the turn nearest to the seed, or if that is outside the limits, on the one inside that is nearest to them: it is
  // the one nearest to what of the limits is nearest to the seed, or next to it.
  template <int N, bool H>
  [[gnu::always_inline]] static Lanes<N> turned(int j, const LanesOf<N, H>& given, const typename Arm::Options& options) noexcept {
    const double low = Arm::kLower.data()[j] - Policy::kLimitReach, high = Arm::kUpper.data()[j] + Policy::kLimitReach;
    const double turn = Arm::kPeriod[j], half = 0.5 * turn;
    const Lanes<N> q = given + select(given > -half, select(given > half, -turn, 0.0), turn);
    const bool one = low > -half && high < half;  // the turn inside the limits
    if (options.limits && one) return q;
    const double seed = options.seed ? options.seed->data()[j] : 0.0;
    const double aim = options.limits ? std::min(std::max(seed, low), high) : seed;
    const Lanes<N> nearby = q + turn * nearest((aim - q) / turn);
    if (!options.limits) return nearby;
    const Lanes<N> above = select(low > nearby, nearby + turn, nearby);
    return select(above > high, above - turn, above);
  }
};

}  // namespace ikgen_runtime
