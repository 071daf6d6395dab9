#pragma once

#include "held_sweep.hpp"

namespace ikgen_runtime {

// The samples between which the last end was found: other rows may end there as well.
template <class Arm> struct LastEnd {
  HeldSample<Arm> inside, outside;
  bool known = false;
};

// Between a value of the held joint at which a branch's row is inside and one at which it is not, the last at which
// it is: by inverse interpolation (Brent 1973, section 4.2, of up to four values), and by halving where that leads out
// of the bracket or is slow. Arm: as for HeldSweep.
template <class Arm> struct BranchEnd {
  using Sample = HeldSample<Arm>;
  static constexpr double kEnough = 1e-10;
  static constexpr int kSteps = 60, kHalve = 6, kKnown = 4;

  double inner, outer, q[Arm::kDof];
  int lane;

  BranchEnd() = default;
  // a: the sample inside, b: the next one; ahead and behind: those beyond them, null without one. Of each the row of
  // the branch, -1 without one.
  BranchEnd(const Sample& a, int lane_a, const Sample& b, int lane_b, const Sample* ahead, int lane_ahead,
            const Sample* behind, int lane_behind) noexcept
      : inner(a.held), outer(b.held), lane(lane_a), at_fold(lane_b < 0), guess(a.held) {
    one_sided = at_fold && !Sample::kMarginsTell;
    stays = Sample::kMarginsTell && (at_fold || lane_b == lane_a);
    a.row(lane_a, q);
    if (ahead) take(*ahead, lane_ahead);
    if (behind) take(*behind, lane_behind);
    take(b, lane_b);
    take(a, lane_a);
  }

  void find(const HeldSweep<Arm>& sweep, LastEnd<Arm>& last) noexcept {
    if (last.known && (found(last.inside, last.outside) || found(last.outside, last.inside))) return;
    last.inside.held = last.outside.held = kInfinity;
    for (int step = 0; step < kSteps && std::abs(outer - inner) > kEnough; ++step) {
      const Sample s = sweep.at(trial(step));
      const int row = row_in(s);
      const bool seen = row >= 0 && s.real[row] && s.distance(row, q) < 1.0, good = seen && s.off[row] <= 0.0;
      const double far = good ? outer : inner;
      (good ? inner : outer) = s.held;
      if (at_fold && seen && !good) {  // a limit comes before the fold
        at_fold = one_sided = false;
        count = 0;
      }
      narrow(s, seen ? row : at_fold && !one_sided ? lane : -1, far);
      (good ? last.inside : last.outside) = s;
      if (good) {
        s.row(row, q);
        lane = row;
      }
    }
    last.known = last.inside.held == inner && last.outside.held == outer;
  }

 private:
  bool at_fold, one_sided = false;
  bool stays;  // in its lane, however near others come
  double guess;  // where the end was expected before
  int count = 0;
  double at[kKnown + 1], value[kKnown + 1];  // the nearest last

  // Whether the end lies between two samples that are close enough.
  bool found(const Sample& a, const Sample& b) noexcept {
    if (!(std::abs(a.held - b.held) <= kEnough) || (a.held - inner) * (a.held - outer) > 0.0) return false;
    const int row = row_in(a), other = row_in(b);
    if (row < 0 || !a.inside(row) || a.distance(row, q) > 1.0) return false;
    if (other >= 0 && b.inside(other) && b.distance(other, q) < 1.0) return false;
    inner = a.held;
    outer = b.held;
    a.row(row, q);
    lane = row;
    return true;
  }

  // The branch's row; -1 without one.
  int row_in(const Sample& s) const noexcept { return stays || (at_fold && Arm::kGuarded) ? lane : s.nearest(q); }

  // What is negative inside, positive outside and smooth between: how far the row is out of the limits, its lane from
  // real rows, or, known inside alone, the squared distance from the row that it meets.
  double value_of(const Sample& s, int row) const noexcept {
    if (one_sided) return row < 0 ? kInfinity : -s.separation(row);
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

  // Takes what was found; what is known of the other side of the bracket, at `far`, goes last.
  void narrow(const Sample& s, int row, double far) noexcept {
    int other = -1;
    const double here = value_of(s, row);
    if (!(std::abs(here) < kInfinity)) return;
    for (int k = 0; k < count; ++k)
      if (at[k] == far) other = k;
    const double kept = other >= 0 ? value[other] : 0.0;
    if (other >= 0) drop(other);
    push(s.held, here);
    if (other >= 0) push(far, kept);
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
  double trial(int step) noexcept {
    const double width = outer - inner, least = 0.4 * kEnough / std::abs(width);
    double share = 0.5;
    for (int first = 0; first < count - 1 && step % kHalve != kHalve - 1; ++first) {
      const double end = interpolated(first), part = (end - inner) / width;
      if (!(part > 0.0 && part < 1.0)) continue;
      share = one_sided ? shifted(end, part, step) : part;
      break;
    }
    return inner + std::min(std::max(share, least), 1.0 - least) * width;
  }

  // To one side and the other of an end that is expected from inside alone, by how much that has changed.
  double shifted(double end, double part, int step) noexcept {
    const double width = std::abs(outer - inner), change = std::max(std::abs(end - guess), 0.4 * kEnough) / width;
    guess = end;
    return step % 2 == 1 ? part - std::min(change, 0.5 * part) : part + std::min(change, 0.5 * (1.0 - part));
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
