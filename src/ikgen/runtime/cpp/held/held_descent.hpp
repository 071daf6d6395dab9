// From the best of some values of the held joint to the best between them, along a branch.
#pragma once

#include "held/branch_curve.hpp"
#include "held/held_sweep.hpp"
#include "held/parabolic_descent.hpp"
#include "rows/row_preference.hpp"

namespace ikgen_runtime {

// Arm: as for HeldSweep and RowPreference.
template <class Arm> struct HeldDescent {
  using Sample = HeldSample<Arm>;
  using Point = HeldPoint<Arm>;
  using Minimum = HeldMinimum<Arm>;
  // Of distances, what is to be gained, over the distance.
  static constexpr double kGain = 1e-16, kLevel = 1e-14;
  static constexpr double kInside = 4e-10;  // of an end, where that is outside the limits by a hair, or a fold
  static constexpr double kSteep = 1e3;     // slopes that tell of a fold, and not which way is down
  static constexpr int kSteps = 40, kHalve = 6;
  static constexpr int kBeside = 3, kBesideFold = 6;  // values that are looked at beside an end
  static constexpr int kTogether = kNative;  // minima that are refined at once

  const HeldSweep<Arm>& sweep;
  const RowPreference<Arm>& preference;

  Point end_point(double at, const double* q, int lane, bool fold) const noexcept {
    Point p = judged(placed(at, q, lane));
    p.fold = fold;
    return p;
  }

  // Some minima, no more than kTogether. Ends, whose rows may have lost digits, first get them back.
  void refine(Minimum* const (&minima)[kTogether], int count) const noexcept {
    for (int k = 0; k < count; ++k) {
      const Minimum& m = *minima[k];
      if (m.best.at == m.low || m.best.at == m.high) refine_end(*minima[k]);
    }
    const bool dexterous = preference.prefer == Arm::Prefer::Dexterous;
    for (int k = 0; k < count; ++k)
      if (dexterous || minima[k]->best.fold) look_beside(*minima[k]);
    if (dexterous) return interpolate(minima, count);
    for (int k = 0; k < count; ++k) descend(*minima[k]);
  }

 private:
  // Digits that come back may take it over the limit that it is on.
  void refine_end(Minimum& m) const noexcept {
    double q[Arm::kDof];
    std::copy_n(m.best.q, Arm::kDof, q);
    Sample::refine(sweep.pose, m.best.at, q);
    Point again = end_point(m.best.at, q, m.best.lane, m.best.fold);
    if (!(again.cost < kInfinity)) again = inside(m);
    if (again.cost < kInfinity) m.best = again;
  }

  // The branch's row a little inside the end that is the best.
  Point inside(const Minimum& m) const noexcept {
    const double other = m.best.at == m.low ? m.high : m.low;
    return judged(beside(m.best.at + std::copysign(kInside, other - m.best.at), m));
  }

  // Off an end that is the best, to the best of a few values beside it: singular values may fall from there, and rise, and
  // beside a fold joint values go as the root of the held one's, of which the end itself tells no slope.
  void look_beside(Minimum& m) const noexcept {
    if (m.best.at != m.low && m.best.at != m.high) return;
    const double from = m.best.at, way = (from == m.low ? m.high : m.low) - from;
    Point least = m.best;
    double share = 1.0;
    for (int i = 0; i < (m.best.fold ? kBesideFold : kBeside); ++i) {
      share *= 0.25;
      const Point p = judged(beside(from + share * way, m));
      if (p.cost < least.cost) least = p;
    }
    m.best = least;
  }

  // Off a fold that is the best, if it is lower beside; the slope there.
  double leave_fold(Minimum& m, double g) const noexcept {
    if (std::abs(g) < kSteep || (m.best.at != m.low && m.best.at != m.high)) return g;
    const Point inner = inside(m);
    if (!(inner.cost < m.best.cost)) return g;
    m.best = inner;
    return slope(inner);
  }

  // A row on the turns that are preferred; its cost is infinite where it is outside the limits, and not known elsewhere.
  Point placed(double at, const double* q, int lane) const noexcept {
    Point p;
    p.at = at;
    p.lane = lane;
    std::copy_n(q, Arm::kDof, p.q);
    p.cost = preference.place(p.q) ? 0.0 : kInfinity;
    return p;
  }

  Point judged(Point p) const noexcept {
    if (p.cost < kInfinity) p.cost = preference.cost(p.q);
    return p;
  }

  // The branch's row at a value in a minimum's reach, as `placed`, if there is one. Where lanes tell branches apart it is that
  // of the best's; else the nearest to where the branch goes: near a fold two are as near to the best.
  Point beside(double at, const Minimum& m) const noexcept {
    const Point& nearby = m.best;
    const Sample s = sweep.at(at, true);
    int best = Sample::kMarginsTell && (s.inside(nearby.lane) || (s.real[nearby.lane] && s.rough[nearby.lane])) ? nearby.lane : -1;
    double least = 0.5, there[Arm::kDof];
    if (!Sample::kMarginsTell) m.between(at, there);
    for (int l = 0; l < s.lanes && !Sample::kMarginsTell; ++l) {
      double gap = s.inside(l) ? 0.0 : kInfinity, q[Arm::kDof];
      s.row(l, q);
      for (int j = 0; j < Arm::kDof && gap < least; ++j)
        if (!Arm::kHeld[j]) gap = std::max(gap, std::abs(SolutionRows<Arm>::change(j, there, q)));
      if (gap < least) {
        least = gap;
        best = l;
      }
    }
    Point none = nearby;
    none.at = at;
    none.cost = kInfinity;
    if (best < 0) return none;
    double q[Arm::kDof];
    s.row(best, q);
    if (s.rough[best]) Sample::refine(sweep.pose, at, q);
    return placed(at, q, best);
  }

  // By singular values, those of all minima at once.
  void interpolate(Minimum* const (&minima)[kTogether], int count) const noexcept {
    ParabolicDescent<Arm> courses[kTogether];
    for (int k = 0; k < count; ++k) courses[k].begin(*minima[k]);
    for (;;) {
      Point trials[kTogether];
      int course[kTogether], trying = 0;
      for (int k = 0; k < count; ++k)
        if (courses[k].next()) course[trying++] = k;
      if (trying == 0) return;
      for (int i = 0; i < trying; ++i) trials[i] = beside(courses[course[i]].trial, *minima[course[i]]);
      double values[kTogether];
      LeastSingularValue<Arm, kTogether>::of_rows(trying, [&](int i) noexcept { return trials[i].q; }, values);
      for (int i = 0; i < trying; ++i) {
        if (trials[i].cost < kInfinity) trials[i].cost = -values[i];
        courses[course[i]].take(trials[i]);
      }
    }
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
    double ends[2] = {m.low, m.high}, costs_there[2] = {m.low_cost, m.high_cost}, last = 0.0, was = 0.0;
    double g = leave_fold(m, slope(m.best));
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
      const Point trial = judged(beside(x + step, m));
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
};

}  // namespace ikgen_runtime
