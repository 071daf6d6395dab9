// Poses one by one with care, by whatever starts it takes.
#pragma once

#include "newton/flat_steps.hpp"
#include "solving/careful_rows.hpp"
#include "singular/limit_curve.hpp"
#include "singular/limit_rows.hpp"
#include "solving/nearest_row.hpp"

namespace ikgen_runtime {

// Arm: as for CarefulRows and NearestRow.
template <class Arm> struct CarefulSolve {
  using Careful = CarefulRows<Arm>;
  using Aim = HeldAim<Arm>;
  using Options = typename Arm::Options;
  using Places = typename Careful::Places;
  using Policy = typename Arm::Policy;
  using Refinement = NewtonRefinement<Arm>;
  using Row = SolutionRows<Arm>;
  using Solutions = typename Arm::Solutions;

  // All solutions. Where the pose leaves a joint free and the seed's value of it leads nowhere, others are tried, and in
  // the end what is nearest to the pose; so too where limits leave none, but a continuum may go on inside, and where all
  // that the closed form has is singular and leads to none. Where no row fits, or one is of a continuum, the seed is taken
  // as a Newton start. found: some of them, without limits.
  [[gnu::always_inline]] static void solve(const Eigen::Isometry3d& pose, const Options& options, Places& found,
                                           Solutions& out) noexcept {
    const Aim aim(pose, options.free);
    bool real = false, free = true, led = false;
    Places loose;  // with rows of a continuum, without limits
    for (int turn = 0; turn < kTurns && free; ++turn) {
      double start[Arm::kDof];
      take_start(options, turn, start);
      auto left = Careful::find_rows(aim, start, options, turn, found);
      if (options.seed && !left.free && Careful::any_singular(found)) {
        found.count = std::min(found.count, static_cast<int>(Places::kRoom) - 1);  // of a continuum there may be any number
        Careful::add_from(aim, start, found, true);
      }
      real = real || found.count > 0;
      led = led || left.led;
      if (Careful::any_singular(found)) loose = found;
      LimitRows<Arm>::place_all(aim, options, found);
      if (found.count == 0 && options.seed && Refinement::refine(start, aim)) {
        RightRows<Arm>::add(aim, found, start, true);
        LimitRows<Arm>::place_all(aim, options, found);
      }
      if (!Arm::kRounded) left.led = Careful::any_singular(found);
      free = left.free && !(left.led && found.count > 0);
    }
    if (free && !Arm::kRounded && !Arm::kRefined) real = add_hidden(aim, options, found) || real;
    if ((free || loose.count > 0 || (led && !real)) && found.count == 0) real = add_nearest(aim, options, found) || real;
    add_along(aim, options, loose, found);
    answer(options, real, found, out);
  }

  // The rows found inside the limits, in order; real: whether there are any without these.
  static void answer(const Options& options, bool real, Places& found, Solutions& out) noexcept {
    if (options.seed) Row::sort_by_distance(found, options.seed->data());
    take_in_order(found, out);
    out.status = out.count > 0 ? Arm::Status::Ok : real ? Arm::Status::Limits : Arm::Status::Unreachable;
  }

 private:
  static constexpr int kTurns = Arm::kRefined ? 1 : Policy::kTries;  // an elimination leaves no joint a value of its own

  // Of a continuum at most kCrowd rows that are alike, and where there are more than places those of none.
  static void take_in_order(Places& found, Solutions& out) noexcept {
    bool kept[Places::kRoom] = {};
    int room = Arm::kMaxSolutions;
    for (int k = 0; k < found.count; ++k) {
      int nearby = 0;
      const double* q = Row::row(found, k);
      for (int i = 0; i < k && Row::flag(found, k); ++i)
        if (kept[i] && Row::flag(found, i) && RowPair<Arm>::within(Policy::kNeighbouring, q, Row::row(found, i))) ++nearby;
      kept[k] = nearby < Policy::kCrowd;
      room -= Row::flag(found, k) ? 0 : 1;
    }
    out.count = 0;
    for (int k = 0; k < found.count && out.count < Arm::kMaxSolutions; ++k) {
      if (!kept[k] || (Row::flag(found, k) && room-- <= 0)) continue;
      std::copy_n(Row::row(found, k), Arm::kDof, Row::row(out, out.count));
      Row::flag(out, out.count++) = Row::flag(found, k);
    }
  }

  // Values for joints that the pose leaves free: the seed's, those of revolute ones turned; held ones as they are.
  static void take_start(const Options& options, int turn, double* q) noexcept {
    for (int j = 0; j < Arm::kDof; ++j)
      q[j] = (options.seed ? options.seed->data()[j] : 0.0) + (Arm::kPeriod[j] > 0.0 ? turn * Policy::kTryStep : 0.0);
    NearestRow<Arm>::hold(options, q);
  }

  // Adds what Newton steps from a row lead to, or else the solutions on a curve through it that is a continuum of the arm's
  // but for a little that is left, or what undamped steps lead to; whether there are any.
  static bool add_led_to(const Aim& aim, const double* start, typename NearContinuum<Arm>::Passed& passed,
                         Places& out) noexcept {
    RowStart<Arm> end;
    end.marked = true;
    std::copy_n(start, Arm::kDof, end.q);
    bool led = Refinement::refine(end.q, aim);
    if constexpr (Arm::kRefined) led = led || FlatSteps<Arm>::refine_from(start, end.q, aim);
    if (led) {
      RightRows<Arm>::add(aim, out, end.q, true);
      return true;
    }
    NearContinuum<Arm> curve(aim);
    curve.trace(start, passed);
    for (int k = 0; k < curve.met; ++k) end.take(aim, curve.found[k], out);
    if constexpr (!Arm::kRefined)
      if (!end.exact && FlatSteps<Arm>::refine_from(start, end.q, aim)) {
        RightRows<Arm>::add(aim, out, end.q, true);
        return true;
      }
    return end.exact;
  }

  // Adds rows that take the pose, next to rows of the closed form that do not behind a joint that it left free: where it
  // left two and the pose leaves one, their values have to go together. Whether there are any.
  [[gnu::cold, gnu::noinline]] static bool add_hidden(const Aim& aim, const Options& options, Places& out) noexcept {
    const double* t = aim.pose.matrix().data();
    double best[Arm::kLanes][Arm::kDof], least[Arm::kLanes];
    std::fill_n(least, Arm::kLanes, kInfinity);
    for (int turn = 0; turn < Policy::kTries; ++turn) {
      double q[Arm::kDof];
      take_start(options, turn, q);
      typename Careful::Rows rows;
      Careful::find_lanes(aim.pose, q, options, rows);
      for (const int lane : Arm::kLaneOfRow) {
        if ((rows.bits(lane) & (kReal | kSingular)) != kSingular) continue;
        for (int j = 0; j < Arm::kDof; ++j) q[j] = rows.q[j][lane];
        const double cost = Row::finite(q) ? PoseChords<Arm>(q, t).cost : kInfinity;
        if (!(cost < least[lane])) continue;
        least[lane] = cost;
        std::copy_n(q, Arm::kDof, best[lane]);
      }
    }
    bool real = false;
    typename NearContinuum<Arm>::Passed passed;
    for (const int lane : Arm::kLaneOfRow) {
      if (!(least[lane] < kInfinity)) continue;
      NearestRow<Arm>::descend(t, options.limits, NearestRow<Arm>::kStanding, best[lane]);
      real = add_led_to(aim, best[lane], passed, out) || real;
    }
    LimitRows<Arm>::place_all(aim, options, out);
    return real;
  }

  // Adds rows inside the limits of the continua that rows outside are of: on a curve through these, or else, as a surface has
  // many, where steps from them lead.
  [[gnu::cold, gnu::noinline]] static void add_along(const Aim& aim, const Options& options, Places& rows, Places& out) noexcept {
    const double bound = out.count > 0 ? Policy::kSingularBelow : kInfinity;  // others may lead inside, but seldom do
    const auto outside = [&](int k) noexcept {
      double q[Arm::kDof];
      std::copy_n(Row::row(rows, k), Arm::kDof, q);
      return Row::flag(rows, k) && !Row::place(q, options) && SingularValue<Arm>::below(Row::row(rows, k), bound);
    };
    for (int k = 0; k < rows.count; ++k)
      if (outside(k)) LimitCurve<Arm>::add(aim, options, Row::row(rows, k), out);
    typename NearContinuum<Arm>::Passed passed;
    for (int k = 0; k < rows.count && !Careful::any_singular(out); ++k) {
      if (!outside(k)) continue;
      double q[Arm::kDof];
      std::copy_n(Row::row(rows, k), Arm::kDof, q);
      NearestRow<Arm>::put_inside(q);
      NearestRow<Arm>::descend(aim.pose.matrix().data(), true, NearestRow<Arm>::kStanding, q);
      if (add_led_to(aim, q, passed, out)) LimitRows<Arm>::place_all(aim, options, out);
    }
  }

  // Adds a row that takes the pose, inside the limits if one of these was found; whether there is any.
  [[gnu::cold, gnu::noinline]] static bool add_nearest(const Aim& aim, const Options& options, Places& out) noexcept {
    using Nearest = NearestRow<Arm>;
    bool real = false;
    typename NearContinuum<Arm>::Passed passed;
    for (bool inside = options.limits;; inside = false) {
      for (const bool flat : {false, true}) {
        double q[Arm::kDof];
        Nearest::find(aim.pose.matrix().data(), options, inside, Nearest::kStanding, Nearest::kFewSteps, q, flat);
        if (!add_led_to(aim, q, passed, out)) continue;
        real = true;
        break;
      }
      LimitRows<Arm>::place_all(aim, options, out);
      if (out.count > 0 || !inside) return real;
    }
  }
};

}  // namespace ikgen_runtime
