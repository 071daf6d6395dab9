// The best row of each interval of the held joint's values.
#pragma once

#include "held/held_descent.hpp"
#include "held/sample_costs.hpp"
#include "held/self_motion.hpp"

namespace ikgen_runtime {

// Arm: as for BranchFollower and RowPreference.
template <class Arm> struct HeldSearch {
  using Sample = HeldSample<Arm>;
  static constexpr int kMost = 4;    // minima of an interval that are looked at
  static constexpr int kCells = 48;  // of the range, where intervals are known without looking

  using Point = HeldPoint<Arm>;
  using Minimum = HeldMinimum<Arm>;
  struct Run {
    int points = 0, count = 0;
    Point last[2];
    Minimum minima[kMost];
  };
  // A minimum of an interval that is to be refined, if it can be among the best.
  struct Waiting {
    Minimum minimum;
    int interval;
  };
  static constexpr int kWaiting = 64;

  const RowPreference<Arm>& preference;
  typename Arm::Solutions& out;

  HeldSearch(const HeldSweep<Arm>& values, const RowPreference<Arm>& wanted, typename Arm::Solutions& rows) noexcept
      : preference(wanted), out(rows), descent{values, wanted} {}
  Run runs[Sample::kLanes];

  void open(int lane, double at, const double* q, int, bool fold) noexcept {
    runs[lane].points = runs[lane].count = 0;
    add(runs[lane], descent.end_point(at, q, lane, fold));
  }
  void pass(int lane, const Sample& s) noexcept {
    if (!(s.held > runs[lane].last[0].at)) return;
    Point p;
    p.at = s.held;
    p.lane = lane;
    s.row(lane, p.q);
    p.cost = preference.place(p.q) ? costs.of(s, lane, p.q) : kInfinity;
    add(runs[lane], p);
  }
  void move(const int* next) noexcept {
    bool plain = true;
    for (int l = 0; l < Sample::kLanes; ++l) plain = plain && (next[l] < 0 || next[l] == l);
    if (plain) return;
    Run old[Sample::kLanes];
    std::copy_n(runs, Sample::kLanes, old);
    for (int l = 0; l < Sample::kLanes; ++l)
      if (next[l] >= 0) runs[next[l]] = old[l];
  }
  void close(int lane, double at, const double* q, bool fold) noexcept {
    Run& run = runs[lane];
    if (at > run.last[0].at) add(run, descent.end_point(at, q, lane, fold));
    const Point& end = run.last[0];
    if (run.points < 2 || end.cost <= run.last[1].cost) keep(run, run.points < 2 ? end : run.last[1], end, end);
    for (int k = 0; k < run.count; ++k) wait(run.minima[k]);
    ++intervals;
  }

  static void solve(const Eigen::Isometry3d& pose, const RowPreference<Arm>& preference, bool limits,
                    typename Arm::Solutions& out) noexcept {
    out.count = 0;
    const HeldSweep<Arm> sweep(pose, limits);
    HeldSearch search{sweep, preference, out};
    const bool any = BranchMotion<Arm>::follow(sweep, search);
    search.finish();
    out.status = out.count > 0 ? Arm::Status::Ok : any ? Arm::Status::Limits : Arm::Status::Unreachable;
    for (int k = 0; k < out.count; ++k)
      out.singular.data()[k] = SingularValue<Arm>::below(SolutionRows<Arm>::row(out, k), Arm::Policy::kSingularBelow);
  }

 private:
  void add(Run& run, const Point& p) noexcept {
    const Point &b = run.last[0], &a = run.last[1];
    if (run.points == 1 && b.cost <= p.cost) keep(run, b, p, b);
    if (run.points > 1 && b.cost <= a.cost && b.cost <= p.cost) keep(run, a, p, b);
    run.last[1] = run.last[0];
    run.last[0] = p;
    ++run.points;
  }

  // Keeps a minimum, of too many the lowest.
  static void keep(Run& run, const Point& low, const Point& high, const Point& best) noexcept {
    int at = run.count < kMost ? run.count++ : 0;
    if (run.count == kMost && at == 0) {
      for (int k = 1; k < kMost; ++k)
        if (run.minima[k].best.cost > run.minima[at].best.cost) at = k;
      if (run.minima[at].best.cost < best.cost) return;
    }
    run.minima[at] = Minimum(low, high, best);
  }

  // Whether a minimum cannot be among those that are returned: a parabola's is no deeper below its three points.
  bool hopeless(const Minimum& m) const noexcept {
    if (out.count < Arm::kMaxSolutions || !(m.low_cost < kInfinity) || !(m.high_cost < kInfinity)) return false;
    const double depth = 0.5 * (std::max(m.low_cost, m.high_cost) - m.best.cost);
    return m.best.cost - depth > best[Arm::kMaxSolutions - 1];
  }

  // Keeps a minimum of the current interval, of too many the lowest, the lowest first.
  void wait(const Minimum& m) noexcept {
    int at = waits;
    while (at > 0 && waiting[at - 1].minimum.best.cost > m.best.cost) --at;
    if (at == kWaiting) return;
    if (waits < kWaiting) ++waits;
    for (int k = waits - 1; k > at; --k) waiting[k] = waiting[k - 1];
    waiting[at] = {m, intervals};
  }

  void finish() noexcept {
    const int together = preference.prefer == Arm::Prefer::Dexterous ? HeldDescent<Arm>::kTogether : 1;
    for (int k = 0; k < waits;) {
      Minimum* some[HeldDescent<Arm>::kTogether];
      int interval[HeldDescent<Arm>::kTogether], count = 0;
      for (; k < waits && count < together; ++k) {
        if (hopeless(waiting[k].minimum)) continue;
        interval[count] = waiting[k].interval;
        some[count++] = &waiting[k].minimum;
      }
      descent.refine(some, count);
      for (int i = 0; i < count; ++i) insert(some[i]->best, interval[i]);
    }
  }

  // Whether a row takes the pose: an end's may not, where margins tell nothing. Joints that are outside the limits by a
  // hair have been put on them.
  bool takes(const Point& p) const noexcept {
    constexpr double enough = BranchArc<Arm>::kArrived + 2.0 * Arm::Policy::kLimitTolerance;
    return PoseError<Arm>(p.q, HeldAim<Arm>(descent.sweep.pose, {p.at})).largest() <= enough;
  }

  // Takes a row that is inside, of an interval's the best.
  void insert(const Point& p, int interval) noexcept {
    int at = 0, last = 0;
    if (!(p.cost < kInfinity) || !takes(p)) return;
    while (last < out.count && owner[last] != interval) ++last;
    if (last < out.count && best[last] <= p.cost) return;
    while (at < out.count && best[at] <= p.cost) ++at;
    if (at == Arm::kMaxSolutions) return;
    if (last == out.count && out.count < Arm::kMaxSolutions) ++out.count;
    for (int k = std::min(last, out.count - 1); k > at; --k) {
      SolutionRows<Arm>::move(out, k - 1, k);
      best[k] = best[k - 1];
      owner[k] = owner[k - 1];
    }
    std::copy_n(p.q, Arm::kDof, SolutionRows<Arm>::row(out, at));
    best[at] = p.cost;
    owner[at] = interval;
  }

  HeldDescent<Arm> descent;
  SampleCosts<Arm> costs{preference};
  double best[Arm::kMaxSolutions];
  int owner[Arm::kMaxSolutions], waits = 0, intervals = 0;
  Waiting waiting[kWaiting];
};

}  // namespace ikgen_runtime
