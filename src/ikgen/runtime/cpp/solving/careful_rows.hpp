// Rows one by one, with care: on singularities, near them, of rounded geometry, and those of a seed alone.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "arm/joint_range.hpp"
#include "solving/row_starts.hpp"

namespace ikgen_runtime {

// Arm: as for NewtonRefinement, SingularValue and SolutionRows; Seed, Rows<P> and branches<P>, the closed form, of kLanes
// rows; kLaneOfRow; kRefined, whether its rows are right already; kRounded, whether it is of another geometry than the
// file, and kBesides, kBeside, the motions of the tool to poses that are solved as well then: near folds those have
// rows that the pose has not. Where kNewton is set refine<P> and take_along, steps in lanes.
template <class Arm> struct CarefulRows {
  using Aim = HeldAim<Arm>;
  using Options = typename Arm::Options;
  using Places = RowPlaces<Arm>;
  using Policy = typename Arm::Policy;
  using Refinement = NewtonRefinement<Arm>;
  using Row = SolutionRows<Arm>;
  using Rows = typename Arm::template Rows<1>;
  using Starts = RowStarts<Arm>;

  // Whether the closed form left a joint free, and found rows with the given value of it.
  struct Left {
    bool free = false, led = false;
  };

  static constexpr bool kBesideAnywhere = !(Policy::kBesideReach < Policy::kAnywhere);  // or only near singularities

  // The closed form's rows without limits; q0 gives the values of joints that the pose leaves free, and, where a row is none
  // but steps may begin, of those whose direction has no digits left.
  static void find_lanes(const Eigen::Isometry3d& pose, const double* q0, const Options& options, Rows& out) noexcept {
    constexpr Range anywhere = {kUnbounded<Arm::kDof>.lower, kUnbounded<Arm::kDof>.upper};
    Arm::branches(gather<1>(&pose), typename Arm::Seed(q0), options.free, anywhere, out);
    for (int lane = 0; lane < Arm::kLanes; ++lane)
      for (int j = 0; j < Arm::kDof && out.has(lane, kSingular) && !out.has(lane, kReal); ++j)
        if (!std::isfinite(out.q[j][lane])) out.q[j][lane] = q0[j];
  }

  static bool any_singular(const Places& rows) noexcept {
    return std::any_of(rows.singular.begin(), rows.singular.begin() + rows.count, [](bool flag) { return flag; });
  }

  // Adds what Newton steps from given values lead to, in place of other rows of a continuum next to it if so asked.
  static void add_from(const Aim& aim, const double* q0, Places& out, bool instead = false) noexcept {
    double q[Arm::kDof];
    std::copy_n(q0, Arm::kDof, q);
    if (!Refinement::refine(q, aim)) return;
    if (instead) return RightRows<Arm>::add_instead(aim, out, q);
    RightRows<Arm>::add(aim, out, q, true);
  }

  // Adds the distinct solutions of a pose, refined where the closed form lost digits.
  [[gnu::always_inline]] static Left find_rows(const Aim& aim, const double* q0, const Options& options,
                                               [[maybe_unused]] int turn, Places& out) noexcept {
    std::array<Rows, 1> only;
    Rows& rows = only[0];
    Left left{turns_away(turn), false};
    Starts starts;
    find_lanes(start_of(aim.pose, turn), q0, options, rows);
    for (const int lane : Arm::kLaneOfRow) {
      left.free = left.free || rows.has(lane, kHit);
      left.led = left.led || rows.has(lane, kSingular | kReal);
      starts.doubt = starts.doubt || rows.has(lane, kReal | kDoubt);
    }
    const int known = out.count;
    if (left.free) add_from(aim, q0, out);
    const LaneEnds<Arm, 1> ends(only, aim, options, kReal);
    bool plain[Arm::kLanes] = {};  // right, and far from singularities
    if constexpr (Arm::kRefined) SingularValue<Arm>::regular(rows, Policy::kFoldReach, plain);
    for (const int lane : Arm::kLaneOfRow)
      if (plain[lane] && !rows.has(lane, kSingular))
        add_lane(rows, lane, out);
      else if (rows.has(lane, kReal) && (Arm::kRefined || rows.has(lane, kRough)))
        starts.take({rows, lane, starts.marked(rows, lane)}, ends.at(0, lane), false, aim, out);
    if constexpr (Arm::kRounded)
      if (turn == 0) starts.trace_broken(aim, out);
    if constexpr (Arm::kBesides > 0)
      if (turn == 0 && (kBesideAnywhere || left.free || starts.close())) take_beside(aim, q0, options, starts, out);
    const bool none = starts.count == 0 && out.count == known;
    if (left.free && (none || (Arm::kRounded && turn == 0))) take_unreal(aim, only, options, starts, out);
    left.led = left.led || starts.any_traced();
    [[maybe_unused]] const int early = out.count;
    for (int k = 0; k < starts.count; ++k)
      if (starts.at(k).nearby && !starts.at(k).around) starts.at(k).add_nearby(aim, out);
    if constexpr (Arm::kRounded)
      if (turn == 0) {
        starts.trace_found(aim, early, out);
        starts.search_surfaces(aim, out);
      }
    if constexpr (!Arm::kRefined)
      for (const int lane : Arm::kLaneOfRow)
        if ((rows.bits(lane) & (kReal | kRough)) == kReal) add_lane(rows, lane, out);
    return left;
  }

 private:
  static void add_lane(const Rows& rows, int lane, Places& out) noexcept {
    double q[Arm::kDof];
    for (int j = 0; j < Arm::kDof; ++j) q[j] = rows.q[j][lane];
    Row::add(out, q, false);
  }

  // A divisor that nearly vanishes has a direction of little to do with the file's arm: poses beside have others.
  static constexpr bool turns_away(int turn) noexcept { return turn > 0 && turn <= Arm::kBesides; }
  static Eigen::Isometry3d start_of(const Eigen::Isometry3d& pose, [[maybe_unused]] int turn) noexcept {
    if constexpr (Arm::kBesides > 0)
      if (turns_away(turn)) return displaced(pose, Arm::kBeside[turn - 1]);
    return pose;
  }

  // Lanes that are not real where a divisor nearly vanishes: less than the file, or round-off, is off may be missing, or
  // the value of a joint that hardly matters may lie beyond what other joints reach.
  static void take_unreal(const Aim& aim, const std::array<Rows, 1>& only, const Options& options, Starts& starts,
                          Places& out) noexcept {
    const auto unreal = [&](int lane) noexcept { return (only[0].bits(lane) & (kReal | kSingular)) == kSingular; };
    if (!std::any_of(std::begin(Arm::kLaneOfRow), std::end(Arm::kLaneOfRow), unreal)) return;
    const LaneEnds<Arm, 1> ends(only, aim, options, kSingular);
    for (const int lane : Arm::kLaneOfRow)
      if (unreal(lane)) starts.take({only[0], lane, true}, ends.at(0, lane), false, aim, out);
  }

  // The rows of poses beside this one.
  static void take_beside(const Aim& aim, const double* q0, const Options& options, Starts& starts,
                          Places& out) noexcept {
    constexpr std::size_t count = Arm::kBesides;
    std::array<Rows, count> rows;
    for (std::size_t k = 0; k < count; ++k) find_lanes(displaced(aim.pose, Arm::kBeside[k]), q0, options, rows[k]);
    const LaneEnds<Arm, count> ends(rows, aim, options, kReal);
    for (std::size_t k = 0; k < count; ++k)
      for (const int lane : Arm::kLaneOfRow)
        if (rows[k].has(lane, kReal))
          starts.take({rows[k], lane, starts.marked(rows[k], lane)}, ends.at(k, lane), true, aim, out);
  }
};

}  // namespace ikgen_runtime
