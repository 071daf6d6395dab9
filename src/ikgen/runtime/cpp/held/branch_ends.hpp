#pragma once

#include "held/branch_arc.hpp"

namespace ikgen_runtime {

// The sample at which the last end was found, or those between which it was: other rows may end there as well.
template <class Arm> struct LastEnd {
  HeldSample<Arm> inside, outside;
  bool known = false, settled = false;
};

// Between a value of the held joint at which a branch's row is inside and one at which it is not, the last at which
// it is. Where margins tell that: by inverse interpolation (Brent 1973, section 4.2, of up to four values) of what is
// just inside, and by halving where that leads out of the bracket or is slow. Else on the curve to the branch's row
// beyond, or to the row that it meets; by halving where there is none. Arm: as for HeldSweep.
template <class Arm> struct BranchEnd {
  using Sample = HeldSample<Arm>;
  static constexpr double kEnough = 1e-10, kShare = 0.05;  // of it, how far inside an end is looked for
  static constexpr int kSteps = 60, kHalve = 6, kKnown = 4;

  double inner, outer, q[Arm::kDof];
  int lane;
  bool at_fold;

  BranchEnd() = default;
  // a: the sample inside, b: the next one, `links`: the row of b that each of a is; ahead and behind: the samples beyond
  // them, null without one. Of each the row of the branch, -1 without one.
  BranchEnd(const Sample& a, int lane_a, const Sample& b, int lane_b, const int* links, const Sample* ahead,
            int lane_ahead, const Sample* behind, int lane_behind) noexcept
      : inner(a.held), outer(b.held), lane(lane_a), at_fold(lane_b < 0) {
    stays = Sample::kMarginsTell && (at_fold || lane_b == lane_a);
    if (Sample::kMarginsTell && at_fold && !b.real[lane]) reach = kInfinity;
    a.row(lane_a, q);
    if (!Sample::kMarginsTell) {
      go_to(at_fold ? a : b, at_fold ? met(a, links) : lane_b);
      return;
    }
    if (ahead) take(*ahead, lane_ahead);
    if (behind) take(*behind, lane_behind);
    take(b, lane_b);
    take(a, lane_a);
  }

  // Its row may have lost digits.
  void find(const HeldSweep<Arm>& sweep, LastEnd<Arm>& last) noexcept {
    if constexpr (!Sample::kMarginsTell)
      if (goes && follow(sweep)) return;
    if (last.settled && ends_at(last.inside)) return;
    if (last.known && (found(last.inside, last.outside) || found(last.outside, last.inside))) return;
    const BranchEnd before = *this;
    narrow_down(sweep, last);
    if (!Sample::kMarginsTell || !at_fold || takes(sweep.pose)) return;
    *this = before;
    halves = true;
    narrow_down(sweep, last);
    last.known = last.settled = false;
  }

 private:
  static constexpr double kClose = 1e-8;  // error of a row that has lost digits by a fold alone
  bool stays;           // in its lane, however near others come
  double reach = 1.0;   // from where the row was last seen; any where its lane ends: beside folds rows move far
  bool halves = false;  // steps are halves, and rows tell, not margins
  bool goes = false;    // to the row `there` at the value `then`
  double there[Arm::kDof], then;
  int count = 0;
  double at[kKnown + 1], value[kKnown + 1];  // the nearest last

  // Looks for it, at a fold by margins, where rows may be left as the closed form has them.
  void narrow_down(const HeldSweep<Arm>& sweep, LastEnd<Arm>& last) noexcept {
    last.inside.held = last.outside.held = kInfinity;
    last.settled = false;
    for (int step = 0; step < kSteps && std::abs(outer - inner) > kEnough; ++step) {
      const Sample s = sweep.at(trial(step), at_fold && !halves);
      const int row = row_in(s);
      const bool seen = row >= 0 && s.real[row] && s.distance(row, q) < reach, good = seen && s.off[row] <= 0.0;
      const double remote = good ? outer : inner;
      (good ? inner : outer) = s.held;
      if (at_fold && seen && !good) {  // a limit comes before the fold
        at_fold = false;
        count = 0;
      }
      if (good && settles(s, row)) {
        settle(s, row);
        last.inside = s;
        last.settled = true;
        last.known = false;
        return;
      }
      narrow(s, seen ? row : at_fold && Sample::kMarginsTell ? lane : -1, remote);
      (good ? last.inside : last.outside) = s;
      if (good) {
        take_row(s, row);
      }
    }
    last.known = last.inside.held == inner && last.outside.held == outer;
  }

  // Whether the row at the end takes the pose. Where a divisor of the closed form is 0 at each value it may be that margins
  // tell nothing.
  bool takes(const Eigen::Isometry3d& pose) const noexcept {
    const HeldAim<Arm> aim(pose, {inner});
    if (PoseError<Arm>(q, aim).largest() < kClose) return true;
    double row[Arm::kDof];
    std::copy_n(q, Arm::kDof, row);
    return NewtonRefinement<Arm>::refine(row, aim);
  }

  void take_row(const Sample& s, int row) noexcept {
    s.row(row, q);
    lane = row;
  }

  // The nearest of the rows that end beside the branch's, of a rounded arm of all: it may be found farther; -1 without one.
  int met(const Sample& a, const int* links) const noexcept {
    int best = -1;
    double least = kInfinity;
    for (int l = 0; l < a.lanes; ++l) {
      const double gap = a.real[l] && l != lane && (Arm::kRounded || links[l] < 0) ? a.distance(l, q) : kInfinity;
      if (gap < least) {
        least = gap;
        best = l;
      }
    }
    return best;
  }

  void go_to(const Sample& s, int row) noexcept {
    goes = row >= 0;
    then = s.held;
    if (goes) s.row(row, there);
  }

  // Along the curve; whether that has an end in the bracket, of a rounded arm, whose rows may be missed beside a fold, also
  // as far again beyond.
  bool follow(const HeldSweep<Arm>& sweep) noexcept {
    const BranchArc<Arm> arc(sweep, q, inner, there, then);
    const double sense = outer > inner ? 1.0 : -1.0;
    typename BranchArc<Arm>::Point end = arc.to;
    const double beyond = Arm::kRounded ? std::abs(outer - inner) : kEnough;
    if (at_fold && !(arc.fold(sense, end) && sense * (outer - end.held) > -beyond)) return false;
    if (end.off > 0.0) {
      if (!arc.limit(arc.from, end, end)) return false;
      at_fold = false;
    }
    inner = end.held;
    outer = inner + sense * kEnough;
    std::copy_n(end.q, Arm::kDof, q);
    return true;
  }

  // Whether the end lies between two samples that are close enough.
  bool found(const Sample& a, const Sample& b) noexcept {
    if (!(std::abs(a.held - b.held) <= kEnough) || (a.held - inner) * (a.held - outer) > 0.0) return false;
    const int row = row_in(a), other = row_in(b);
    if (row < 0 || !a.inside(row) || !tells(a, row) || a.distance(row, q) > 1.0) return false;
    if (other >= 0 && b.inside(other) && b.distance(other, q) < 1.0) return false;
    inner = a.held;
    outer = b.held;
    take_row(a, row);
    return true;
  }

  // Whether a row that is inside is so near to its end, by the least slope to what is known, that nothing is to be gained.
  bool settles(const Sample& s, int row, double part = 2.0 * kShare) const noexcept {
    const double here = value_of(s, row);
    double slope = kInfinity;
    for (int k = 0; k < count; ++k)
      if (at[k] != s.held) slope = std::min(slope, std::abs((value[k] - here) / (at[k] - s.held)));
    return slope < kInfinity && here <= 0.0 && here > -part * kEnough * slope;
  }
  void settle(const Sample& s, int row) noexcept {
    outer = s.held + std::copysign(kEnough, outer - inner);
    inner = s.held;
    take_row(s, row);
  }

  // Whether the end lies where the last one does.
  bool ends_at(const Sample& s) noexcept {
    if ((s.held - inner) * (s.held - outer) > 0.0) return false;
    const int row = row_in(s);
    if (row < 0 || !s.inside(row) || !tells(s, row) || s.distance(row, q) > 1.0 || !settles(s, row, 1.0)) return false;
    settle(s, row);
    return true;
  }

  // Whether a sample has the digits of a row that matter at this end.
  bool tells(const Sample& s, int row) const noexcept { return at_fold || !s.rough[row]; }

  // The branch's row; -1 without one.
  int row_in(const Sample& s) const noexcept { return stays || (at_fold && Arm::kGuarded) ? lane : s.nearest(q); }

  // What is negative inside, positive outside and smooth between: how far the row is out of the limits, or its lane from
  // real rows.
  double value_of(const Sample& s, int row) const noexcept {
    if (!at_fold) return row < 0 ? kInfinity : s.off[row];
    double least = kInfinity;
    for (int k = 0; k < Arm::kFolds && lane < Arm::kLanes; ++k) least = std::min(least, s.fold[k][lane]);
    return -least;
  }

  void take(const Sample& s, int row) noexcept {
    const double here = value_of(s, row);
    if (!(std::abs(here) < kInfinity)) return;
    at[count] = s.held;
    value[count++] = here;
  }

  // Takes what was found; what is known of the other side of the bracket, at `remote`, goes last.
  void narrow(const Sample& s, int row, double remote) noexcept {
    int other = -1;
    const double here = value_of(s, row);
    if (!(std::abs(here) < kInfinity)) return;
    for (int k = 0; k < count; ++k)
      if (at[k] == remote) other = k;
    const double kept = other >= 0 ? value[other] : 0.0;
    if (other >= 0) drop(other);
    push(s.held, here);
    if (other >= 0) push(remote, kept);
  }
  void drop(int k) noexcept {
    --count;
    for (; k < count; ++k) {
      at[k] = at[k + 1];
      value[k] = value[k + 1];
    }
  }
  void push(double held, double here) noexcept {
    if (count == kKnown) drop(0);
    at[count] = held;
    value[count++] = here;
  }

  // Where to look next.
  double trial(int step) const noexcept {
    const double width = outer - inner, least = 0.4 * kEnough / std::abs(width);
    double share = 0.5;
    for (int first = 0; first < count - 1 && step % kHalve != kHalve - 1 && !halves; ++first) {
      const double end = interpolated(first), part = (end - inner) / width;
      if (!(part > 0.0 && part < 1.0)) continue;
      share = part - kShare * kEnough / std::abs(width);
      break;
    }
    return inner + std::min(std::max(share, least), 1.0 - least) * width;
  }

  // The value of the held joint at which the polynomial through all from `first` on is 0 (Neville).
  double interpolated(int first) const noexcept {
    double x[kKnown];
    const int n = count - first;
    for (int k = 0; k < n; ++k) x[k] = at[first + k];
    for (int level = 1; level < n; ++level)
      for (int k = 0; k < n - level; ++k) {
        const double a = value[first + k], b = value[first + k + level];
        if (a == b) return kInfinity;
        x[k] = (x[k] * b - x[k + 1] * a) / (b - a);
      }
    return x[0];
  }
};

}  // namespace ikgen_runtime
