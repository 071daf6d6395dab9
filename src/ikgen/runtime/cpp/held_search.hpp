// The best row of each interval of the held joint's values.
#pragma once

#include "branch_curve.hpp"
#include "row_preference.hpp"
#include "self_motion.hpp"

namespace ikgen_runtime {

// Arm: as for BranchFollower and RowPreference.
template <class Arm> struct HeldSearch {
  using Sample = HeldSample<Arm>;
  static constexpr int kMost = 4;         // minima of an interval that are looked at
  static constexpr int kCells = 48;       // of the range, where intervals are known without looking
  // How near to a minimum is enough, of singular values, which have kinks: beside a fold joint values change as the root
  // of the held one's, up to 1e3 times as much. Of distances, what is to be gained, over the distance.
  static constexpr double kNear = 1e-9, kGain = 1e-16, kLevel = 1e-14;
  static constexpr int kSteps = 40, kHalve = 6;

  struct Point {
    double at, cost, q[Arm::kDof];
    int lane;
  };
  struct Minimum {
    double low, high, low_cost, high_cost;
    Point best;
  };
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

  const HeldSweep<Arm>& sweep;
  const RowPreference<Arm>& preference;
  typename Arm::Solutions& out;

  HeldSearch(const HeldSweep<Arm>& values, const RowPreference<Arm>& wanted, typename Arm::Solutions& rows) noexcept
      : sweep(values), preference(wanted), out(rows) {}
  Run runs[Sample::kLanes];

  void open(int lane, double at, const double* q, int) noexcept {
    runs[lane].points = runs[lane].count = 0;
    add(runs[lane], at, q, lane);
  }
  void pass(int lane, const Sample& s) noexcept {
    double q[Arm::kDof];
    s.row(lane, q);
    if (s.held > runs[lane].last[0].at) add(runs[lane], s.held, q, lane);
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
  void close(int lane, double at, const double* q) noexcept {
    Run& run = runs[lane];
    if (at > run.last[0].at) add(run, at, q, lane);
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
      out.singular.data()[k] = RankLoss<Arm>::below(SolutionRows<Arm>::row(out, k), Arm::Policy::kRankLoss);
  }

 private:
  Point point(double at, const double* q, int lane) const noexcept {
    Point p;
    p.at = at;
    p.lane = lane;
    std::copy_n(q, Arm::kDof, p.q);
    p.cost = preference.place(p.q) ? preference.cost(p.q) : kInfinity;
    return p;
  }

  void add(Run& run, double at, const double* q, int lane) noexcept {
    const Point p = point(at, q, lane);
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
    run.minima[at] = {low.at, high.at, low.cost, high.cost, best};
  }

  // The branch's row at a value next to a point; its cost is infinite where there is none inside the limits. Where lanes
  // tell branches apart it is that of the point's: near a fold two are as near to it.
  Point beside(double at, const Point& near) const noexcept {
    const Sample s = sweep.at(at);
    int best = Sample::kMarginsTell && s.inside(near.lane) ? near.lane : -1;
    double least = 0.5;
    for (int l = 0; l < s.lanes && !Sample::kMarginsTell; ++l) {
      double gap = s.inside(l) ? 0.0 : kInfinity, q[Arm::kDof];
      s.row(l, q);
      for (int j = 0; j < Arm::kDof && gap < least; ++j)
        if (!Arm::kHeld[j]) gap = std::max(gap, std::abs(SolutionRows<Arm>::change(j, near.q, q)));
      if (gap < least) {
        least = gap;
        best = l;
      }
    }
    Point p;
    p.at = at;
    p.cost = kInfinity;
    if (best < 0) return p;
    double q[Arm::kDof];
    s.row(best, q);
    return point(at, q, best);
  }

  // Whether a minimum cannot be among those that are returned: a parabola's is no deeper below its three points.
  bool hopeless(const Minimum& m) const noexcept {
    if (out.count < Arm::kMaxSolutions || !(m.low_cost < kInfinity) || !(m.high_cost < kInfinity)) return false;
    const double depth = 0.5 * (std::max(m.low_cost, m.high_cost) - m.best.cost);
    return m.best.cost - depth > costs[Arm::kMaxSolutions - 1];
  }

  void refine(Minimum& m) const noexcept {
    if (preference.prefer != Arm::Prefer::Dexterous) return descend(m);
    if (m.best.at == m.low || m.best.at == m.high) {  // an end, if it is better than what is next to it
      const double far = m.best.at == m.low ? m.high : m.low, least = kNear * (1.0 + std::abs(m.best.at));
      if (std::abs(far - m.best.at) <= 2.0 * least) return;
      const Point next = beside(m.best.at + std::copysign(least, far - m.best.at), m.best);
      if (next.cost >= m.best.cost && next.cost < kInfinity) return;
    }
    interpolate(m);
  }

  // The derivative of a distance along the branch.
  double slope(const Point& p) const noexcept {
    double q[Arm::kDof], flow[Arm::kDof], sum = 0.0;
    std::copy_n(p.q, Arm::kDof, q);
    BranchCurve<Arm>(sweep.pose, q, p.at).flow(flow);
    for (int j = 0; j < Arm::kDof; ++j) sum += 2.0 * preference.weight[j] * (p.q[j] - preference.wanted.data()[j]) * flow[j];
    return sum;
  }

  // To where the derivative is 0: by a parabola with the slope of the best point, then secants, guarded by halving.
  void descend(Minimum& m) const noexcept {
    double ends[2] = {m.low, m.high}, costs_there[2] = {m.low_cost, m.high_cost}, g = slope(m.best), last = 0.0, was = 0.0;
    bool known = false;  // the slope `was` at `last`
    for (int i = 0; i < kSteps; ++i) {
      const double x = m.best.at, level = 1.0 + m.best.cost;
      const int side = g > 0.0 ? 0 : 1;
      const double width = ends[side] - x, rise = costs_there[side] - m.best.cost;
      if (!(std::abs(width) > 1e-15 * (1.0 + std::abs(x)))) return;
      double step = 0.5 * width;
      if (i % kHalve != kHalve - 1 && (known || rise < kInfinity))
        step = known ? -g * (x - last) / (g - was) : -g * width * width / (2.0 * (rise - g * width));
      if (!(step * width > 0.0 && std::abs(step) < std::abs(width))) step = 0.5 * width;
      if (std::abs(g * step) <= kGain * level) return;
      const Point trial = beside(x + step, m.best);
      const double there = trial.cost < kInfinity ? slope(trial) : 0.0;
      const bool turns = there * g < 0.0, better = trial.cost <= m.best.cost + kLevel * level;
      known = turns || better;
      if (turns || !better) {
        ends[side] = trial.at;
        costs_there[side] = trial.cost;
      }
      last = better ? x : trial.at;
      was = better ? g : there;
      if (!better) continue;
      ends[1 - side] = x;
      costs_there[1 - side] = m.best.cost;
      m.best = trial;
      g = there;
    }
  }

  // Parabolic interpolation guarded by the golden section (Brent 1973).
  void interpolate(Minimum& m) const noexcept {
    constexpr double kGolden = 0.3819660112501051;
    double low = m.low, high = m.high, step = 0.5 * (high - low), before = high - low;
    double second = low, third = high, second_cost = m.low_cost, third_cost = m.high_cost;
    if (third_cost < second_cost) {
      std::swap(second, third);
      std::swap(second_cost, third_cost);
    }
    for (int i = 0; i < 60; ++i) {
      const double x = m.best.at, middle = 0.5 * (low + high), least = kNear * (1.0 + std::abs(x));
      if (std::abs(x - middle) <= 2.0 * least - 0.5 * (high - low)) return;
      double golden = x < middle ? high - x : low - x;
      bool parabolic = false;
      if (std::abs(before) > least && second_cost < kInfinity && third_cost < kInfinity) {
        const double r = (x - second) * (m.best.cost - third_cost);
        double t = (x - third) * (m.best.cost - second_cost), p = (x - third) * t - (x - second) * r;
        t = 2.0 * (t - r);
        p = t > 0.0 ? -p : p;
        t = std::abs(t);
        parabolic = std::abs(p) < std::abs(0.5 * t * before) && p > t * (low - x) && p < t * (high - x);
        if (parabolic) {
          before = step;
          step = p / t;
          if (i > 1 && std::abs(step) < least) return;
        }
      }
      if (!parabolic) {
        before = golden;
        step = kGolden * golden;
      }
      const double u = std::abs(step) >= least ? x + step : x + (step > 0.0 ? least : -least);
      const Point trial = beside(std::min(std::max(u, m.low), m.high), m.best);
      if (trial.cost < m.best.cost) {
        (trial.at >= x ? low : high) = x;
        third = second;
        third_cost = second_cost;
        second = x;
        second_cost = m.best.cost;
        m.best = trial;
      } else {
        (trial.at < x ? low : high) = trial.at;
        if (trial.cost <= second_cost || second == x) {
          third = second;
          third_cost = second_cost;
          second = trial.at;
          second_cost = trial.cost;
        } else if (trial.cost <= third_cost || third == x || third == second) {
          third = trial.at;
          third_cost = trial.cost;
        }
      }
    }
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
    for (int k = 0; k < waits; ++k) {
      if (hopeless(waiting[k].minimum)) continue;
      refine(waiting[k].minimum);
      insert(waiting[k].minimum.best, waiting[k].interval);
    }
  }

  // Takes a row, of an interval's the best.
  void insert(const Point& p, int interval) noexcept {
    int at = 0, last = 0;
    while (last < out.count && owner[last] != interval) ++last;
    if (last < out.count && costs[last] <= p.cost) return;
    while (at < out.count && costs[at] <= p.cost) ++at;
    if (at == Arm::kMaxSolutions) return;
    if (last == out.count && out.count < Arm::kMaxSolutions) ++out.count;
    for (int k = std::min(last, out.count - 1); k > at; --k) {
      SolutionRows<Arm>::move(out, k - 1, k);
      costs[k] = costs[k - 1];
      owner[k] = owner[k - 1];
    }
    std::copy_n(p.q, Arm::kDof, SolutionRows<Arm>::row(out, at));
    costs[at] = p.cost;
    owner[at] = interval;
  }

  double costs[Arm::kMaxSolutions];
  int owner[Arm::kMaxSolutions], waits = 0, intervals = 0;
  Waiting waiting[kWaiting];
};

}  // namespace ikgen_runtime
