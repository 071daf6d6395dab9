// Where steps lead from the rows of a closed form that is of another geometry than the file.
#pragma once

#include <array>

#include "arm/held_aim.hpp"
#include "arm/joint_range.hpp"
#include "rows/lane_rows.hpp"

namespace ikgen_runtime {

// What a lane led to: its place in these rows, and whether it is the one solution near the start; else the error there.
template <class Arm> struct LaneEnd {
  const typename Arm::template Rows<1>& rows;
  bool alone;
  double error;
};

// Of the rows of K poses those that lanes of a flag lead to at the aim, all at once, and the error that is left where they
// don't show the one solution near their start. Arm: as for CarefulRows.
template <class Arm, std::size_t K> struct LaneEnds {
  using Rows = typename Arm::template Rows<1>;
  static constexpr int kLanes = Rows::kLanes;

  std::array<Rows, K> rows;
  double error[K * std::size_t{kLanes}] = {};

  LaneEnds(const std::array<Rows, K>& from, [[maybe_unused]] const HeldAim<Arm>& aim,
           [[maybe_unused]] const typename Arm::Options& options, [[maybe_unused]] Bit flag) noexcept
      : rows(from) {
    if constexpr (Arm::kNewton) {
      constexpr Range anywhere = {kUnbounded<Arm::kDof>.lower, kUnbounded<Arm::kDof>.upper};
      const Pose<1> pose = gather<1>(&aim.pose);
      int lanes[K * std::size_t{kLanes}], count = 0;
      for (std::size_t k = 0; k < K; ++k) {
        Arm::refine(pose, options.free, anywhere, rows[k]);
        for (const int lane : Arm::kLaneOfRow)
          if (from[k].has(lane, flag) && !rows[k].has(lane, kFound))
            lanes[count++] = static_cast<int>(k) * kLanes + lane;
      }
      Arm::take_along(pose, options.free, lanes, count, rows.data(), error);
    }
  }

  // Of rows k.
  LaneEnd<Arm> at(std::size_t k, int lane) const noexcept {
    return {rows[k], rows[k].has(lane, kFound), error[k * std::size_t{kLanes} + static_cast<std::size_t>(lane)]};
  }
};

}  // namespace ikgen_runtime
