// Rows that what the file is off moves far, by the closed form itself: it solves a pose displaced by as much as the file is
// off at the row ("compensation": Veitschegger and Wu 1988).
#pragma once

#include "arm/joint_range.hpp"
#include "arm/motion_chain.hpp"
#include "newton/newton_refinement.hpp"
#include "rows/lane_rows.hpp"
#include "rows/row_pair.hpp"
#include "rows/singular_value.hpp"
#include "singular/fold_pair.hpp"

namespace ikgen_runtime {

// Arm: as for CarefulRows; Solved: kDof, kMotions and kFrames of the chain that the closed form is of.
template <class Arm> class CompensatedRows {
  using Aim = HeldAim<Arm>;
  using Fold = FoldPair<Arm>;
  using Options = typename Arm::Options;
  using Pair = RowPair<Arm>;
  using Places = RowPlaces<Arm>;
  using Row = SolutionRows<Arm>;
  using Rows = typename Arm::template Rows<1>;

 public:
  CompensatedRows(const Aim& to, const Options& given) noexcept : aim(to), options(given) {}

  // Adds rows, without limits; whether they are all, far from others.
  bool find(Places& out) noexcept {
    start();
    for (int round = 0; round < kRounds && (round == 0 || any_rough()); ++round) compensate(round == 0);
    all = all && (!any_rough() || (!beside && add_pairs(out)));
    for (const int lane : Arm::kLaneOfRow) {
      if (!real[lane] || rough[lane]) continue;
      double q[Arm::kDof];
      take(rows, lane, q);
      const int known = out.count;
      if (!SingularValue<Arm>::below(q, Arm::Policy::kSingularBelow)) Row::add(out, q, false);
      all = all && out.count > known;  // else another may lie there, or others along a continuum
    }
    return all && out.count > 0;
  }

 private:
  static constexpr int kRounds = 2;
  static constexpr double kShare = 0.2;  // of the least product of two singular values, as `refine` takes it
  static constexpr double kAside = 0.1;  // rad or m: what moves them farther there may lead to others as well
  static constexpr double kRemote = 2.0;  // singular value over the way from there: a second singularity is farther
  static constexpr int kHalts = 3;  // on the way to a fold, its ends included
  static constexpr double kTogether = 0.3;  // rad or m: nearer rows may be of one fold

  const Aim& aim;
  const Options& options;
  Rows rows, closed;  // as they are, and at first
  bool all = true, beside = false;  // whether there are no others that are not found, and a divisor nearly vanishes
  bool real[Arm::kLanes] = {}, rough[Arm::kLanes] = {};

  static void take(const Rows& from, int lane, double* q) noexcept {
    for (int j = 0; j < Arm::kDof; ++j) q[j] = from.q[j][lane];
  }

  bool any_rough() const noexcept {
    return std::any_of(rough, rough + Arm::kLanes, [](bool flag) { return flag; });
  }

  void solve_closed_form(const Eigen::Isometry3d& pose, Rows& to) const noexcept {
    constexpr Range anywhere = {kUnbounded<Arm::kDof>.lower, kUnbounded<Arm::kDof>.upper};
    Arm::branches(gather<1>(&pose), typename Arm::Seed(), options.free, anywhere, to);
  }

  void refine(Rows& from, double share = 0.0) const noexcept {
    constexpr Range anywhere = {kUnbounded<Arm::kDof>.lower, kUnbounded<Arm::kDof>.upper};
    Arm::refine(gather<1>(&aim.pose), options.free, anywhere, from, share);
  }

  // The pose at which the closed form has q, if it nearly has it at the aim.
  Eigen::Isometry3d compensated(const double* q) const noexcept {
    Eigen::Isometry3d file, solved;
    by_columns(MotionChain<Arm>::forward(q), file.matrix().data());
    by_columns(MotionChain<typename Arm::Solved>::forward(q), solved.matrix().data());
    const Eigen::Matrix3d turn = solved.linear() * file.linear().transpose();
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    out.linear() = turn * aim.pose.linear();
    out.translation() = solved.translation() + turn * (aim.pose.translation() - file.translation());
    return out;
  }

  // The closed form's rows, refined: those are rough that do not stand alone, or that it does not have behind a direction
  // that has lost digits. Others may be anywhere where it has lost them all, or nothing is left.
  void start() noexcept {
    solve_closed_form(aim.pose, closed);
    rows = closed;
    refine(rows);
    bool any = false;
    for (const int lane : Arm::kLaneOfRow) {
      const bool hidden = has_hidden(closed, lane);
      real[lane] = rows.has(lane, kReal) || hidden;
      rough[lane] = rows.has(lane, kReal | kRough) || hidden;
      beside = beside || closed.has(lane, kReal | kHit);
      any = any || real[lane];
      all = all && !((closed.has(lane, kReal) || hidden) && closed.has(lane, kDoubt));
    }
    all = all && any;
  }

  static bool has_hidden(const Rows& from, int lane) noexcept { return (from.bits(lane) & (kReal | kHit)) == kHit; }

  // Takes rough rows from compensated poses; those that stand alone then are rough no more. Beside a divisor that nearly
  // vanishes the others have to, at first, and none may be lost.
  void compensate(bool first) noexcept {
    bool asked[Arm::kLanes] = {};
    for (const int lane : Arm::kLaneOfRow) {
      if (rough[lane]) displace(lane);
      asked[lane] = real[lane] && (rough[lane] || (beside && first));
      rows.flags[lane] = asked[lane] ? double{kReal} : 0.0;
    }
    refine(rows, kShare);
    for (const int lane : Arm::kLaneOfRow) {
      if (!asked[lane]) continue;
      if (!rows.has(lane, kReal)) {
        lose(lane);
      } else if (!rough[lane]) {
        all = all && !rows.has(lane, kRough);
      } else {
        rough[lane] = rows.has(lane, kRough);
      }
    }
  }

  // Takes a row from its compensated pose, unless that leads too far.
  void displace(int lane) noexcept {
    double q[Arm::kDof], to[Arm::kDof];
    Rows there;
    take(rows, lane, q);
    solve_closed_form(compensated(q), there);
    take(there, lane, to);
    if (!Pair::within(kAside, q, to)) {
      all = false;
      return;
    }
    for (int j = 0; j < Arm::kDof; ++j) rows.q[j][lane] = to[j];
    if (!there.has(lane, kReal) && !has_hidden(there, lane)) lose(lane);
  }

  // Beside a divisor that nearly vanishes its direction may be what is lost.
  void lose(int lane) noexcept {
    real[lane] = rough[lane] = false;
    all = all && !beside;
  }

  // Adds the solutions that meet where two rough rows do, far from others: two of them, or none.
  bool add_pairs(Places& out) noexcept {
    bool done[Arm::kLanes] = {};
    for (const int lane : Arm::kLaneOfRow) {
      if (!rough[lane] || done[lane]) continue;
      double q[Arm::kDof], start[Arm::kDof];
      take(rows, lane, q);
      take(closed, lane, start);
      int other = lane, nearby = 0;
      for (const int k : Arm::kLaneOfRow) {
        double row[Arm::kDof];
        take(rows, k, row);
        if (k == lane || !real[k] || !Pair::within(kTogether, q, row)) continue;
        other = k;
        ++nearby;
      }
      if (nearby != 1 || !rough[other] || !add_pair(q, start, out)) return false;
      done[other] = true;
    }
    return true;
  }

  // From a rough row, where the closed form had it at first.
  bool add_pair(const double* start, const double* first, Places& out) const noexcept {
    double ends[2][Arm::kDof];
    Fold fold(aim);
    const auto begin = fold.begin(start);
    for (const int side : {0, 1}) {
      double* q = ends[side];
      std::copy_n(start, Arm::kDof, q);
      const auto known = [](const double*, double) noexcept { return false; };
      const auto led = fold.approach(begin, side == 0 ? 1.0 : -1.0, q, known);
      const double moved = Pair::farthest(first, q);
      if (!(moved < kTogether) || !alone_on(fold, q, first, moved)) return false;
      if (led == Fold::Led::Between) return side == 0;
      if (!NewtonRefinement<Arm>::refine(q, aim) || !Pair::within(kTogether, start, q)) return false;
    }
    if (Row::same(ends[0], ends[1])) return false;
    for (const double* q : ends) {
      if (SingularValue<Arm>::below(q, Arm::Policy::kSingularBelow)) return false;
      Row::add(out, q, false);
    }
    return true;
  }

  // Whether there is no second singularity from a fold to where the closed form has its row, which is so far away.
  static bool alone_on(const Fold& fold, const double* q, const double* first, double moved) noexcept {
    for (int i = 0; i < kHalts; ++i) {
      double halt[Arm::kDof];
      for (int j = 0; j < Arm::kDof; ++j) halt[j] = q[j] + i * (Row::change(j, q, first) / (kHalts - 1));
      if (!fold.others_above(kRemote * moved / (2 * (kHalts - 1)), halt)) return false;
    }
    return true;
  }
};

}  // namespace ikgen_runtime
