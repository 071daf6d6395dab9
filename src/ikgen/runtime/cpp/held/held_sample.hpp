// Rows of a pose at one value of the held joint, lane by lane.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>

#include "solving/careful_rows.hpp"
#include "held/displacement.hpp"
#include "singular/fold_rows.hpp"
#include "arm/joint_bounds.hpp"
#include "arm/joint_range.hpp"
#include "newton/newton_refinement.hpp"
#include "rows/solution_rows.hpp"

namespace ikgen_runtime {

// Arm: as for CarefulRows; kFolds, how many margins its closed form has.
template <class Arm> struct HeldSample {
  static constexpr int kBesides = CarefulRows<Arm>::kBesideAnywhere ? Arm::kBesides : 0;
  static constexpr int kLanes = Arm::kLanes * (1 + kBesides), kMargins = Arm::kFolds > 0 ? Arm::kFolds : 1;
  static constexpr int kPack = Arm::kLanes < kNative ? Arm::kLanes : kNative;
  static constexpr bool kMarginsTell = Arm::kGuarded && !Arm::kRounded;  // where branches end: a rounded arm's do not
  double held = 0.0;
  int lanes = Arm::kLanes;  // which may be real
  double q[Arm::kDof][kLanes], off[kLanes], fold[kMargins][Arm::kLanes];
  bool real[kLanes] = {};
  bool rough[kLanes] = {};  // rows that lost digits and are as the closed form gives them

  // Whether a row is real and inside the limits.
  bool inside(int lane) const noexcept { return real[lane] && off[lane] <= 0.0; }

  // The rows at a value; T: the pose as it is read. Where margins tell which are real they may be left coarse.
  HeldSample(const Eigen::Isometry3d& T, double value, const JointBounds<Arm>& bounds, bool margins_only = false) noexcept
      : held(value) {
    bool certain = false;
    if constexpr (Arm::kNewton) certain = take_certain(T);
    if (!certain) take_carefully(T, kMarginsTell && margins_only);
    for (int at = 0; at < lanes; at += kPack) {
      Lanes<kPack> most = spread<kPack>(-kInfinity);
      for (int i = 0; i < bounds.count; ++i)
        most = max(most, abs(bounds.offset(i, load<kPack>(q[bounds.joint[i]] + at))) - (bounds.half[i] + Arm::Policy::kLimitTolerance));
      store(most, off + at);
    }
  }

  HeldSample() = default;

  void row(int lane, double* out) const noexcept {
    for (int j = 0; j < Arm::kDof; ++j) out[j] = q[j][lane];
  }

  // Takes a row to the pose with the held value; whether it comes there.
  static bool refine(const Eigen::Isometry3d& T, double value, double* row) noexcept {
    const bool there = NewtonRefinement<Arm>::refine(row, HeldAim<Arm>(T, {value}));
    for (int j = 0; j < Arm::kDof; ++j) row[j] = turned(j, row[j]);
    return there;
  }

  // The change of a joint from one row to another.
  static double change(int j, const HeldSample& a, int i, const HeldSample& b, int k) noexcept {
    return between(j, a.q[j][i], b.q[j][k]);
  }

  // The largest change of a joint that moves, from one row to another.
  static double gap(const HeldSample& a, int i, const HeldSample& b, int k) noexcept {
    double most = 0.0;
    for (int j = 0; j < Arm::kDof; ++j)
      if (!Arm::kHeld[j]) most = std::max(most, std::abs(change(j, a, i, b, k)));
    return most;
  }
  double distance(int lane, const double* other) const noexcept {
    double most = 0.0;
    for (int j = 0; j < Arm::kDof; ++j)
      if (!Arm::kHeld[j]) most = std::max(most, std::abs(between(j, other[j], q[j][lane])));
    return most;
  }

  // The lane of the real row that is nearest to another; -1 without one.
  int nearest(const double* other) const noexcept {
    int best = -1;
    double least = kInfinity, gaps[kPack];
    for (int at = 0; at < lanes; at += kPack) {
      Lanes<kPack> most = spread<kPack>(0.0);
      for (int j = 0; j < Arm::kDof; ++j)
        if (!Arm::kHeld[j]) most = max(most, abs(between(j, spread<kPack>(other[j]), load<kPack>(q[j] + at))));
      store(most, gaps);
      for (int i = 0; i < kPack; ++i)
        if (real[at + i] && gaps[i] < least) {
          least = gaps[i];
          best = at + i;
        }
    }
    return best;
  }

  // The change of joint j, and its value, on the shortest way; of numbers or packs.
  template <class X> [[gnu::always_inline]] static X between(int j, const X& from, const X& to) noexcept {
    return within(j, to - from);
  }
  template <class X> [[gnu::always_inline]] static X within(int j, const X& x) noexcept {
    return Arm::kPeriod[j] > 0.0 ? shortest(x, Arm::kPeriod[j]) : x;
  }

 private:
  static constexpr Range kAnywhere = {kUnbounded<Arm::kDof>.lower, kUnbounded<Arm::kDof>.upper};
  using Rows = FoldRows<Arm::kDof, Arm::kLanes, Arm::kFolds>;

  // Takes the rows of a rounded arm refined all at once, if that leaves no doubt.
  bool take_certain(const Eigen::Isometry3d& T) noexcept {
    Rows rows;
    typename Arm::template Rows<1> fine;
    const Pose<1> pose = gather<1>(&T);
    Arm::branches(pose, typename Arm::Seed(), std::array<double, 1>{held}, kAnywhere, rows);
    refine_together(pose, rows, fine);
    int seen = 0;
    for (int r = 0; r < Arm::kLanes; ++r) seen |= keep(rows, fine, r);
    return (seen & kReal) != 0 && (seen & (kRough | kHit)) == 0 && !remove_repetitions();
  }

  // Takes the rows of the pose and those beside it, each refined for as long as that takes; no more than solve gives.
  void take_carefully(const Eigen::Isometry3d& T, bool coarse) noexcept {
    bool again = take(T, T, 0, coarse);
    if constexpr (kBesides > 0)
      for (int i = 0; i < kBesides; ++i) again = take(T, displaced(T, Arm::kBeside[i]), i + 1, false) || again;
    lanes = kLanes;
    if (again && !coarse) remove_repetitions();
    int count = 0, used = Arm::kLanes;
    for (int l = 0; l < kLanes; ++l) {
      count += real[l] ? 1 : 0;
      real[l] = real[l] && count <= Arm::kMaxSolutions;
      if (real[l]) used = std::max(used, l + 1);
    }
    lanes = used;
  }

  // Copies a row of the pose itself and its margins; its bits.
  template <class Found> int keep(const Rows& rows, const Found& fine, int r) noexcept {
    const int lane = Arm::kLaneOfRow[r], bits = fine.bits(lane);
    real[r] = (bits & kReal) != 0;
    for (int j = 0; j < Arm::kDof; ++j) q[j][r] = Arm::kHeld[j] ? held : fine.q[j][lane];
    for (int k = 0; k < Arm::kFolds; ++k) fold[k][r] = rows.margin[k][lane];
    return bits;
  }

  // A joint's value, no more than half a period from 0.
  static double turned(int j, double x) noexcept {
    return Arm::kHeld[j] ? x : SolutionRows<Arm>::within_period(j, x);
  }

  // Takes the rows of the pose, or of one beside it, refined where that is needed: in lanes where all are, and not at all if
  // they may be coarse; whether some may be equal.
  bool take(const Eigen::Isometry3d& T, const Eigen::Isometry3d& nearby, int part, bool coarse) noexcept {
    Rows rows;
    Arm::branches(gather<1>(&nearby), typename Arm::Seed(), std::array<double, 1>{held}, kAnywhere, rows);
    [[maybe_unused]] typename Arm::template Rows<1> fine;
    [[maybe_unused]] double error[Arm::kLanes] = {};
    if constexpr (Arm::kNewton && !Arm::kRefined) refine_lanes(T, rows, fine, error);
    bool again = part > 0;
    for (int r = 0; r < Arm::kLanes; ++r) {
      const int lane = Arm::kLaneOfRow[r], l = part * Arm::kLanes + r, bits = rows.bits(lane);
      if (part == 0) keep(rows, rows, r);
      real[l] = (bits & kReal) != 0;
      for (int j = 0; j < Arm::kDof && part > 0; ++j) q[j][l] = Arm::kHeld[j] ? held : rows.q[j][lane];
      again = again || (real[l] && (bits & (kRough | kMeeting)) != 0);
      if (!real[l] || (bits & kRough) == 0 || Arm::kRefined) continue;
      rough[l] = coarse;
      if (coarse) continue;
      double refined[Arm::kDof];
      if constexpr (Arm::kNewton && !Arm::kRefined) {
        real[l] = fine.has(lane, kReal) && error[lane] < Arm::Policy::kArrived;
        for (int j = 0; j < Arm::kDof; ++j) refined[j] = Arm::kHeld[j] ? held : turned(j, fine.q[j][lane]);
      } else {
        row(l, refined);
        real[l] = refine(T, held, refined);
      }
      for (int j = 0; j < Arm::kDof; ++j) q[j][l] = refined[j];
    }
    return again;
  }

  // Where steps lead from all lanes at once.
  template <class Fine> void refine_together(const Pose<1>& pose, const Rows& rows, Fine& fine) const noexcept {
    std::memcpy(fine.q, rows.q, sizeof(fine.q));
    std::memcpy(fine.flags, rows.flags, sizeof(fine.flags));
    Arm::refine(pose, {held}, kAnywhere, fine);
  }

  // Where these lead, and the error that is left of those that need more than a few.
  template <class Fine> void refine_lanes(const Eigen::Isometry3d& T, const Rows& rows, Fine& fine, double* error) const noexcept {
    const Pose<1> pose = gather<1>(&T);
    refine_together(pose, rows, fine);
    int some[Arm::kLanes], count = 0;
    for (const int lane : Arm::kLaneOfRow)
      if (fine.has(lane, kRough)) some[count++] = lane;
    Arm::take_along(pose, {held}, some, count, &fine, error);
  }

  // Whether there were any.
  bool remove_repetitions() noexcept {
    bool any = false;
    for (int l = 1; l < lanes; ++l)
      for (int k = 0; k < l; ++k)
        if (real[l] && real[k] && gap(*this, l, *this, k) <= Arm::Policy::kCoincident) {
          real[l] = false;
          any = true;
        }
    return any;
  }
};

}  // namespace ikgen_runtime
