// Starts of Newton steps for one pose, and what these lead to, near singularities too.
#pragma once

#include <algorithm>
#include <array>

#include "newton/newton_refinement.hpp"
#include "rows/lane_rows.hpp"
#include "singular/right_rows.hpp"
#include "singular/near_continuum.hpp"
#include "singular/near_surface.hpp"
#include "solving/lane_ends.hpp"

namespace ikgen_runtime {

// What Newton steps from a lane led to. Rows that are right to round-off are added; of the others the nearest is kept.
template <class Arm> struct RowStart {
  using Aim = HeldAim<Arm>;
  using Fold = FoldPair<Arm>;
  using Pair = RowPair<Arm>;
  using Places = RowPlaces<Arm>;
  using Policy = typename Arm::Policy;
  using Refinement = NewtonRefinement<Arm>;
  using Rows = typename Arm::template Rows<1>;

  bool marked = false, nearby = false, settled = false;  // settled: a solution, whatever else there is
  bool exact = false;  // whether what it leads to is known to round-off
  bool alone = false;  // whether steps showed that it is the one solution near its start
  bool around = false;  // whether the solutions of the continuum that it lies on are known
  int lane = 0;
  double error = 0.0, start[Arm::kDof], q[Arm::kDof];

  static constexpr double kSkew = 2.0;    // of the way to the other solution: farther there may be more than two
  static constexpr double kBeside = 0.1;  // rad or m: farther apart closed forms have them all

  RowStart() = default;
  RowStart(const Rows& rows, int from, bool singular) noexcept : marked(singular), lane(from) {
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
    nearby = !marked && !alone && SingularValue<Arm>::below(q, Policy::kFoldReach);
    settled = error < (nearby ? Policy::kConverged : Policy::kArrived);
  }

  // Whether other solutions may start from no lane of this pose.
  bool close() const noexcept { return nearby && SingularValue<Arm>::below(q, Policy::kBesideReach); }

  // Adds what Newton steps lead to.
  void take(const Aim& aim, const double* from, Places& out) noexcept {
    double trial[Arm::kDof];
    std::copy_n(from, Arm::kDof, trial);
    const double left = Refinement::error_after(trial, aim);
    if (left < Policy::kExact) {
      exact = true;
      RightRows<Arm>::add(aim, out, trial, marked);
    } else if (left < error) {
      error = left;
      std::copy_n(trial, Arm::kDof, q);
    }
  }

  void take_rest(const Aim& aim, Places& out) noexcept {
    if (!exact && !settled && error < Policy::kArrived) RightRows<Arm>::add(aim, out, q, marked);
  }

  // Adds the solutions that meet near the one that a lane led to; where an approach goes much farther than the second order
  // says, others that it may have passed.
  void add_nearby(const Aim& aim, Places& out) noexcept {
    std::copy_n(q, Arm::kDof, start);
    const bool right = error < Policy::kArrived;
    const auto known = [&out](const double* row, double reach) noexcept { return Pair::any_within(reach, row, out); };
    Fold fold(aim);
    const auto begin = fold.begin(start);
    for (const double side : {1.0, -1.0}) {
      double trial[Arm::kDof];
      std::copy_n(start, Arm::kDof, trial);
      const auto led = fold.approach(begin, side, trial, known);
      if (led == Fold::Led::Between) break;  // nor on the other side
      if (led == Fold::Led::There) take(aim, trial, out);
      exact = exact || led == Fold::Led::Known;
      const double way = Pair::farthest(start, trial);
      if (!right || !(way < kBeside) || way < kSkew * begin.lead(side) + Policy::kCoincident) continue;
      CurveParts<Arm> curve(aim);
      curve.look_between(start, trial);
      for (int k = 0; k < curve.count; ++k) take(aim, curve.found[k], out);
    }
    take_rest(aim, out);
  }

  // Adds the solutions all around a continuum of the solved geometry that the file's arm may not have, or one of it if
  // the file's has it; whether there is one.
  bool add_around(const Aim& aim, typename NearContinuum<Arm>::Passed& passed, Places& out) noexcept {
    NearContinuum<Arm> curve(aim);
    const bool none = curve.trace(start, passed) == NearContinuum<Arm>::Kind::None;
    if constexpr (Arm::kRounded)
      if (none) curve.trace_aside(start, passed);
    RowStart aside(*this);
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
template <class Arm> struct RowStarts {
  using Aim = HeldAim<Arm>;
  using Pair = RowPair<Arm>;
  using Places = RowPlaces<Arm>;
  using Policy = typename Arm::Policy;
  using Refinement = NewtonRefinement<Arm>;
  using Row = SolutionRows<Arm>;
  using Rows = typename Arm::template Rows<1>;
  using Start = RowStart<Arm>;

  static constexpr double kContinuum = 1e-10;  // smallest singular value that what takes a pose to 1e-9 all along leaves at most

  int count = 0;
  bool doubt = false, traced[Arm::kLanes] = {};  // doubt: whether rows of the pose itself may have others near them
  typename NearContinuum<Arm>::Passed passed;
  std::array<Start, std::size_t{Arm::kLanes} * (1 + Arm::kBesides)> all;

  Start& at(int k) noexcept { return all[static_cast<std::size_t>(k)]; }

  // Whether a lane is to be taken for one of a continuum.
  bool marked(const Rows& rows, int lane) const noexcept {
    return rows.has(lane, kSingular) || (doubt && rows.has(lane, kReal | kDoubt));
  }

  // Whether one is so near a singularity that other solutions may start from none of them.
  bool close() const noexcept {
    return std::any_of(all.begin(), all.begin() + count, [](const Start& one) { return one.close() && !one.around; });
  }

  // Adds the solutions all around the continua of the solved geometry that rows near singularities lie on.
  void trace_broken(const Aim& aim, Places& out) noexcept {
    for (int k = 0; k < count; ++k) {
      Start& one = at(k);
      if (one.around || !one.nearby || !SingularValue<Arm>::below(one.q, Policy::kBrokenReach)) continue;
      NearContinuum<Arm> curve(aim);
      const auto kind = curve.trace(one.q, passed);
      one.around = kind == NearContinuum<Arm>::Kind::Broken || kind == NearContinuum<Arm>::Kind::Known;
      for (int i = 0; i < curve.count; ++i) {
        Start(one).take(aim, curve.found[i], out);
        for (int other = k + 1; other < count && one.around; ++other)
          at(other).around = at(other).around || Pair::within(Policy::kMeeting, at(other).q, curve.found[i]);
      }
    }
  }

  // The same of rows that were found from a place on, where solutions meet: continua of two joints cross there.
  void trace_found(const Aim& aim, int first, Places& out) noexcept {
    for (int k = first, last = out.count; k < last; ++k) {
      Start end;
      std::copy_n(Row::row(out, k), Arm::kDof, end.q);
      if (!SingularValue<Arm>::below(end.q, Policy::kBrokenReach)) continue;
      NearContinuum<Arm> curve(aim);
      curve.trace(end.q, passed);
      for (int i = 0; i < curve.count; ++i) end.take(aim, curve.found[i], out);
    }
  }

  // Adds the solutions on surfaces of the solved geometry that they lie on.
  [[gnu::cold, gnu::noinline]] void search_surfaces(const Aim& aim, Places& out) noexcept {
    NearSurface<Arm> surface(aim);
    for (int k = 0; k < count; ++k)
      if (at(k).nearby) surface.search(at(k).q);
    for (int k = 0; k < surface.count; ++k) {
      Start end;
      std::copy_n(surface.found[k], Arm::kDof, end.q);
      end.error = Refinement::error_after(end.q, aim);
      if (end.error < Policy::kConverged) RightRows<Arm>::add(aim, out, end.q, false);
      end.add_nearby(aim, out);
    }
  }

  // Whether steps from a marked lane led to where those from another did, to a solution that is alone there: the direction
  // that they began with is lost, and the solution that one of them was near may lie far away.
  bool collapsed(const Start& one) const noexcept {
    if (SingularValue<Arm>::below(one.q, kContinuum)) return false;
    const auto beside = [](const Start& s) noexcept { return Pair::within(Policy::kNeighbouring, s.start, s.q); };
    return std::any_of(all.begin(), all.begin() + count, [&](const Start& other) noexcept {
      return other.marked && Pair::within(Policy::kNeighbouring, one.q, other.q) && !(beside(one) && beside(other));
    });
  }

  bool any_traced() const noexcept { return std::find(std::begin(traced), std::end(traced), true) != std::end(traced); }

  // end: what steps in lanes led to.
  void take(Start start, const LaneEnd<Arm>& end, bool beside, const Aim& aim, Places& out) noexcept {
    if (!(Arm::kRounded && start.marked)) start.refine(aim, end);
    if (start.marked && (Arm::kRounded || !(start.error < Policy::kExact) || collapsed(start))) {
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
    Start& one = at(count) = start;
    one.judge();
    for (int k = 0; k < count && beside && one.nearby && !one.settled; ++k)
      if (at(k).nearby && Pair::within(Policy::kNeighbouring, one.q, at(k).q)) return;
    ++count;
    if (!one.settled) return;
    if (one.nearby || one.marked)
      RightRows<Arm>::add(aim, out, one.q, one.marked);
    else
      Row::add(out, one.q, false);
  }
};

}  // namespace ikgen_runtime
