// Rows one by one, with care: on singularities, near them, of rounded geometry, and those of a seed alone.
#pragma once

#include <array>

#include "arm/joint_range.hpp"
#include "rows/lane_rows.hpp"
#include "singular/near_continuum.hpp"
#include "singular/near_surface.hpp"
#include "newton/newton_refinement.hpp"
#include "rows/rank_loss.hpp"
#include "rows/row_pair.hpp"
#include "rows/solution_rows.hpp"
#include "solving/lane_ends.hpp"

namespace ikgen_runtime {

// Arm: as for NewtonRefinement, RankLoss and SolutionRows; Seed, Rows<P> and branches<P>, the closed form, of kLanes
// rows; kLaneOfRow; kRefined, whether its rows are right already; kRounded, whether it is of another geometry than the
// file, and kBesides, kBeside, the motions of the tool to poses that are solved as well then: near folds those have
// rows that the pose has not. Where kNewton is set refine<P> and take_along, steps in lanes.
template <class Arm> struct CarefulRows {
  using Aim = HeldAim<Arm>;
  using Options = typename Arm::Options;
  using Pair = RowPair<Arm>;
  using Places = RowPlaces<Arm>;
  using Policy = typename Arm::Policy;
  using Refinement = NewtonRefinement<Arm>;
  using Row = SolutionRows<Arm>;
  using Rows = typename Arm::template Rows<1>;

  // Whether the closed form left a joint free, and found rows with the given value of it.
  struct Left {
    bool free = false, led = false;
  };

  static constexpr bool kBesideAnywhere = !(Policy::kBesideReach < Policy::kAnywhere);  // or only near singularities

  // The closed form's rows without limits; q0 gives the values of joints that the pose leaves free.
  static void find_lanes(const Eigen::Isometry3d& pose, const double* q0, const Options& options, Rows& out) noexcept {
    constexpr Range anywhere = {kUnbounded<Arm::kDof>.lower, kUnbounded<Arm::kDof>.upper};
    Arm::branches(gather<1>(&pose), typename Arm::Seed(q0), options.free, anywhere, out);
  }

  static bool any_singular(const Places& rows) noexcept {
    return std::any_of(rows.singular.begin(), rows.singular.begin() + rows.count, [](bool flag) { return flag; });
  }

  // Adds what Newton steps from given values lead to.
  static void add_from(const Aim& aim, const double* q0, Places& out) noexcept {
    double q[Arm::kDof];
    std::copy_n(q0, Arm::kDof, q);
    if (Refinement::refine(q, aim)) add(aim, out, q, true);
  }

  // Adds a right row, as singular where it is one of a continuum or next to it.
  static void add(const Aim& aim, Places& out, const double* q, bool marked) noexcept {
    const bool singular = RankLoss<Arm>::below(q, marked ? Policy::kContinuumRankLoss : Policy::kRankLoss);
    for (int k = 0; k < out.count && singular; ++k)
      if (Row::flag(out, k) && Pair::between(aim, q, Row::row(out, k))) return;
    Row::add(out, q, singular);
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
    if constexpr (Arm::kRefined) RankLoss<Arm>::regular(rows, Policy::kFoldReach, plain);
    for (const int lane : Arm::kLaneOfRow)
      if (plain[lane] && !rows.has(lane, kSingular))
        add_lane(rows, lane, out);
      else if (rows.has(lane, kReal) && (Arm::kRefined || rows.has(lane, kRough)))
        starts.take({rows, lane, starts.marked(rows, lane)}, ends.at(0, lane), false, aim, out);
    if constexpr (Arm::kRounded)
      if (turn == 0) starts.trace_broken(aim, out);
    if constexpr (Arm::kBesides > 0)
      if (turn == 0 && (kBesideAnywhere || left.free || starts.close())) take_beside(aim, q0, options, starts, out);
    if (starts.count == 0 && left.free && out.count == known) take_all(aim, only, options, starts, out);
    left.led = left.led || starts.any_traced();
    for (int k = 0; k < starts.count; ++k)
      if (starts.at(k).nearby && !starts.at(k).around) starts.at(k).add_nearby(aim, out);
    if constexpr (Arm::kRounded)
      if (turn == 0) starts.search_surfaces(aim, out);
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

  // What Newton steps from a lane led to. Rows that are right to round-off are added; of the others the nearest is kept.
  struct Nearest {
    bool marked = false, nearby = false, settled = false, exact = false;  // settled: a solution, whatever else there is
    bool alone = false;  // whether steps showed that it is the one solution near its start
    bool around = false;  // whether the solutions of the continuum that it lies on are known
    int lane = 0;
    double error = 0.0, start[Arm::kDof], q[Arm::kDof];

    Nearest() = default;
    Nearest(const Rows& rows, int from, bool singular) noexcept : marked(singular), lane(from) {
      for (int j = 0; j < Arm::kDof; ++j) start[j] = q[j] = rows.q[j][lane];
    }

    // From where steps in lanes led to, if they did.
    void refine([[maybe_unused]] const Aim& aim, [[maybe_unused]] const LaneEnd<Arm>& end) noexcept {
      if constexpr (Arm::kNewton) {
        for (int j = 0; j < Arm::kDof; ++j) q[j] = end.rows.q[j][lane];
        alone = end.alone;
        if (!alone) error = end.error;
      } else if constexpr (!Arm::kRefined) {
        error = Refinement::error_after(q, aim);
      }
    }

    void judge() noexcept {
      nearby = !marked && !alone && RankLoss<Arm>::below(q, Policy::kFoldReach);
      settled = error < (nearby ? Policy::kConverged : Policy::kArrived);
    }

    // Whether other solutions may start from no lane of this pose.
    bool close() const noexcept { return nearby && RankLoss<Arm>::below(q, Policy::kBesideReach); }

    // Adds what Newton steps lead to.
    void take(const Aim& aim, const double* from, Places& out) noexcept {
      double trial[Arm::kDof];
      std::copy_n(from, Arm::kDof, trial);
      const double left = Refinement::error_after(trial, aim);
      if (left < Policy::kExact) {
        exact = true;
        add(aim, out, trial, marked);
      } else if (left < error) {
        error = left;
        std::copy_n(trial, Arm::kDof, q);
      }
    }

    void take_rest(const Aim& aim, Places& out) noexcept {
      if (!exact && !settled && error < Policy::kArrived) add(aim, out, q, marked);
    }

    // Adds the solutions that meet near the one that a lane led to.
    void add_nearby(const Aim& aim, Places& out) noexcept {
      std::copy_n(q, Arm::kDof, start);
      using Fold = FoldPair<Arm>;
      const auto known = [&out](const double* row, double reach) noexcept { return Pair::any_within(reach, row, out); };
      for (const double side : {1.0, -1.0}) {
        double trial[Arm::kDof];
        std::copy_n(start, Arm::kDof, trial);
        const auto led = Fold(aim).approach(side, trial, known);
        if (led == Fold::Led::Between) break;  // nor on the other side
        if (led == Fold::Led::There) take(aim, trial, out);
      }
      take_rest(aim, out);
    }

    // Adds the solutions all around a continuum of the solved geometry that the file's arm may not have, or one of it if
    // the file's has it; whether there is one.
    bool add_around(const Aim& aim, typename NearContinuum<Arm>::Passed& passed, Places& out) noexcept {
      NearContinuum<Arm> curve(aim);
      const bool none = curve.trace(start, passed) == NearContinuum<Arm>::Kind::None;
      Nearest aside(*this);
      if (!none) error = kInfinity;
      for (int k = 0; k < curve.count; ++k) (none ? aside : *this).take(aim, curve.found[k], out);
      if (none) return false;
      take(aim, start, out);
      take_rest(aim, out);
      return true;
    }
  };

  // Starts of Newton steps, in the order of their lanes; those of poses beside that led to the same as an earlier one,
  // or stalled where that looks for two solutions, are left out, as are those on a continuum that is known.
  struct Starts {
    int count = 0;
    bool doubt = false, traced[Arm::kLanes] = {};  // doubt: whether rows of the pose itself may have others near them
    typename NearContinuum<Arm>::Passed passed;
    std::array<Nearest, std::size_t{Arm::kLanes} * (1 + Arm::kBesides)> all;

    Nearest& at(int k) noexcept { return all[static_cast<std::size_t>(k)]; }

    // Whether a lane is to be taken for one of a continuum.
    bool marked(const Rows& rows, int lane) const noexcept {
      return rows.has(lane, kSingular) || (doubt && rows.has(lane, kReal | kDoubt));
    }

    // Whether one is so near a singularity that other solutions may start from none of them.
    bool close() const noexcept {
      return std::any_of(all.begin(), all.begin() + count, [](const Nearest& one) { return one.close() && !one.around; });
    }

    // Adds the solutions all around the continua of the solved geometry that rows near singularities lie on.
    void trace_broken(const Aim& aim, Places& out) noexcept {
      for (int k = 0; k < count; ++k) {
        Nearest& one = at(k);
        if (one.around || !one.nearby || !RankLoss<Arm>::below(one.q, Policy::kBrokenReach)) continue;
        NearContinuum<Arm> curve(aim);
        const auto kind = curve.trace(one.q, passed);
        one.around = kind == NearContinuum<Arm>::Kind::Broken || kind == NearContinuum<Arm>::Kind::Known;
        for (int i = 0; i < curve.count; ++i) {
          Nearest(one).take(aim, curve.found[i], out);
          for (int other = k + 1; other < count && one.around; ++other)
            at(other).around = at(other).around || Pair::within(Policy::kMeeting, at(other).q, curve.found[i]);
        }
      }
    }

    // Adds the solutions on surfaces of the solved geometry that they lie on.
    [[gnu::cold, gnu::noinline]] void search_surfaces(const Aim& aim, Places& out) noexcept {
      NearSurface<Arm> surface(aim);
      for (int k = 0; k < count; ++k)
        if (at(k).nearby) surface.search(at(k).q);
      for (int k = 0; k < surface.count; ++k) {
        Nearest end;
        std::copy_n(surface.found[k], Arm::kDof, end.q);
        end.error = Refinement::error_after(end.q, aim);
        if (end.error < Policy::kConverged) add(aim, out, end.q, false);
        end.add_nearby(aim, out);
      }
    }

    bool any_traced() const noexcept { return std::find(std::begin(traced), std::end(traced), true) != std::end(traced); }

    // end: what steps in lanes led to.
    void take(Nearest start, const LaneEnd<Arm>& end, bool beside, const Aim& aim, Places& out) noexcept {
      if (!(Arm::kRounded && start.marked)) start.refine(aim, end);
      if (start.marked && (Arm::kRounded || !(start.error < Policy::kArrived))) {
        if (!traced[start.lane]) traced[start.lane] = start.add_around(aim, passed, out);
        if (traced[start.lane]) return;
        start.marked = false;
        start.refine(aim, end);
      }
      for (int k = 0; k < count; ++k)
        if ((beside || start.alone) && Row::same(start.q, at(k).q)) {
          if (beside) return;
          start.alone = false;
        }
      if (beside) start.alone = false;
      Nearest& one = at(count) = start;
      one.judge();
      for (int k = 0; k < count && beside && one.nearby && !one.settled; ++k)
        if (at(k).nearby && Pair::within(Policy::kAlike, one.q, at(k).q)) return;
      ++count;
      if (!one.settled) return;
      if (one.nearby || one.marked)
        add(aim, out, one.q, one.marked);
      else
        Row::add(out, one.q, false);
    }
  };

  // Lanes that are not real where a divisor nearly vanishes: less than the file, or round-off, is off may be missing.
  static void take_all(const Aim& aim, const std::array<Rows, 1>& only, const Options& options, Starts& starts,
                       Places& out) noexcept {
    const LaneEnds<Arm, 1> ends(only, aim, options, kSingular);
    for (const int lane : Arm::kLaneOfRow)
      if (only[0].has(lane, kSingular)) starts.take({only[0], lane, true}, ends.at(0, lane), false, aim, out);
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
