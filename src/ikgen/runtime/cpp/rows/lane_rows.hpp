// What goes into the lanes and comes out of them: P poses at once. The lanes of a level are the branches of all
// levels up to it: branch b of lane l is lane b * width + l. Guards are masks, so no lane waits for another.
#pragma once

#include <cstddef>

#include <Eigen/Geometry>

#include "arrays/lanes.hpp"

namespace ikgen_runtime {

template <int P> struct Pose {
  Lanes<P> t[3][4];
};

// P poses, entry by entry.
template <int P> [[gnu::always_inline]] inline Pose<P> gather(const Eigen::Isometry3d* poses) noexcept {
  Pose<P> out;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 4; ++j) {
      double entries[std::size_t{P}];
      for (int p = 0; p < P; ++p) entries[p] = poses[p].matrix().data()[4 * j + i];
      out.t[i][j] = load<P>(entries);
    }
  return out;
}

// What is known of a row: found inside the range, real, one of a continuum, in want of Newton steps, perhaps
// equal to another; a joint was left free on the way to it; the file's geometry may have others near it. Kept as sums of
// these in doubles.
enum Bit { kFound = 1, kReal = 2, kSingular = 4, kRough = 8, kMeeting = 16, kHit = 32, kDoubt = 64 };

template <int N, bool H> [[gnu::always_inline]] inline Lanes<N> bit(const MaskOf<N, H>& mask, Bit value) noexcept {
  return select(mask, static_cast<double>(value), 0.0);
}

template <int Dof, int Most, int P> struct LaneRows {
  static constexpr int kLanes = Most * P;
  alignas(64) double q[Dof][std::size_t{kLanes}];
  alignas(64) double flags[std::size_t{kLanes}];

  int bits(int lane) const noexcept { return static_cast<int>(flags[lane]); }
  bool has(int lane, int all) const noexcept { return (bits(lane) & all) == all; }
};

// Distance between the two halves of a level's lanes, which are its branches.
template <int N, bool H> [[gnu::always_inline]] inline Lanes<N / 2> gap(const LanesOf<N, H>& x) noexcept {
  if constexpr (H) {
    return abs(x.lo - x.hi);
  } else {
    Lanes<N / 2> lo, hi;
    std::memcpy(&lo.v, &x.v, sizeof(lo.v));
    std::memcpy(&hi.v, reinterpret_cast<const char*>(&x.v) + sizeof(lo.v), sizeof(hi.v));
    return abs(lo - hi);
  }
}
// Whether the branches of a level of N lanes are almost equal in all of these.
template <class Policy, int N, class... X> [[gnu::always_inline]] inline auto meeting(const X&... x) noexcept {
  return Policy::kMeeting > (gap(spread<N>(x)) + ...);
}

}  // namespace ikgen_runtime
