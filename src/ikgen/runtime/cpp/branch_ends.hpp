#pragma once

#include "held_sweep.hpp"

namespace ikgen_runtime {

// The samples between which the last end was found: other rows may end there as well.
template <class Arm> struct LastEnd {
  HeldSample<Arm> inside, outside;
  bool known = false;
};

// Between a value of the held joint at which a branch's row is inside and one at which it is not, the last at which
// it is: false position with halved values (Dowell, Jarratt 1971: the Illinois method), and halving where no value is
// known or it is slow. Arm: as for HeldSweep.
template <class Arm> struct BranchEnd {
  using Sample = HeldSample<Arm>;
  static constexpr double kEnough = 1e-12;
  static constexpr int kSteps = 60;

  double inner, outer, values[2];
  bool known[2], at_fold;
  int lane, moved = -1;
  double q[Arm::kDof];

  // a: the sample inside; lane_b: the row's in b, -1 for none.
  BranchEnd(const Sample& a, int lane_a, const Sample& b, int lane_b) noexcept
      : inner(a.held), outer(b.held), at_fold(lane_b < 0), lane(lane_a) {
    a.row(lane_a, q);
    set(0, a, lane_a, true);
    set(1, b, at_fold ? lane_a : lane_b, !at_fold);
  }

  void find(const HeldSweep<Arm>& sweep, LastEnd<Arm>& last) noexcept {
    if (last.known && (found(last.inside, last.outside) || found(last.outside, last.inside))) return;
    last.inside.held = last.outside.held = kInfinity;
    for (int step = 0; step < kSteps && std::abs(outer - inner) > kEnough; ++step) {
      const Sample s = sweep.at(trial(step));
      int row = lane;
      if (!at_fold || !Arm::kGuarded) row = s.nearest(q);
      const bool seen = row >= 0 && s.real[row] && s.distance(row, q) < 1.0, good = seen && s.off[row] <= 0.0;
      (good ? inner : outer) = s.held;
      if (at_fold && seen && !good) {
        at_fold = false;
        known[0] = known[1] = false;
      }
      const int side = good ? 0 : 1;
      set(side, s, seen ? row : lane, seen);
      if (moved == side) values[1 - side] *= 0.5;
      moved = side;
      (good ? last.inside : last.outside) = s;
      if (good) {
        s.row(row, q);
        lane = row;
      }
    }
    last.known = last.inside.held == inner && last.outside.held == outer;
  }

 private:
  // Whether the end lies between two samples that are close enough.
  bool found(const Sample& a, const Sample& b) noexcept {
    if (!(std::abs(a.held - b.held) <= kEnough) || (a.held - inner) * (a.held - outer) > 0.0) return false;
    const bool kept = at_fold && Arm::kGuarded;
    const int row = kept ? lane : a.nearest(q), other = kept ? lane : b.nearest(q);
    if (row < 0 || !a.inside(row) || a.distance(row, q) > 1.0) return false;
    if (other >= 0 && b.inside(other) && b.distance(other, q) < 1.0) return false;
    inner = a.held;
    outer = b.held;
    a.row(row, q);
    lane = row;
    return true;
  }

  double trial(int step) const noexcept {
    if (!known[0] || !known[1] || !(values[0] <= 0.0 && values[1] > 0.0) || step % 4 == 3) return 0.5 * (inner + outer);
    const double least = 0.4 * kEnough / std::abs(outer - inner);
    const double share = values[0] / (values[0] - values[1]);
    return inner + std::min(std::max(share, least), 1.0 - least) * (outer - inner);
  }

  // What is negative inside and positive outside: how far the row is out of the limits, or its lane from real rows.
  void set(int side, const Sample& s, int row, bool seen) noexcept {
    values[side] = at_fold ? kInfinity : s.off[row];
    known[side] = at_fold ? Arm::kFolds > 0 && row < Arm::kMaxSolutions : seen;
    for (int k = 0; k < Arm::kFolds && known[side] && at_fold; ++k) values[side] = std::min(values[side], s.fold[k][row]);
    if (at_fold) values[side] = -values[side];
    known[side] = known[side] && std::abs(values[side]) < kInfinity;
  }
};

}  // namespace ikgen_runtime
