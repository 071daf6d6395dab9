// From the best of some values of the held joint to the best between them, along a branch.
#pragma once

#include "held/branch_curve.hpp"
#include "held/held_sweep.hpp"
#include "held/row_preference.hpp"

namespace ikgen_runtime {

// A row, and what it costs.
template <class Arm> struct HeldPoint {
  double at, cost, q[Arm::kDof];
  int lane;
};

// Three values, of which that between, or an end, is the best.
template <class Arm> struct HeldMinimum {
  double low, high, low_cost, high_cost;
  HeldPoint<Arm> best;
};

// Arm: as for HeldSweep and RowPreference.
template <class Arm> struct HeldDescent {
  using Sample = HeldSample<Arm>;
  using Point = HeldPoint<Arm>;
  using Minimum = HeldMinimum<Arm>;
  // How near to a minimum is enough, of singular values, which have kinks: beside a fold joint values change as the root
  // of the held one's, up to 1e3 times as much. Of distances, what is to be gained, over the distance.
  static constexpr double kNear = 1e-9, kGain = 1e-16, kLevel = 1e-14;
  static constexpr int kSteps = 40, kHalve = 6;

  const HeldSweep<Arm>& sweep;
  const RowPreference<Arm>& preference;

  Point point(double at, const double* q, int lane) const noexcept {
    Point p;
    p.at = at;
    p.lane = lane;
    std::copy_n(q, Arm::kDof, p.q);
    p.cost = preference.place(p.q) ? preference.cost(p.q) : kInfinity;
    return p;
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

 private:
  // The branch's row at a value next to a point; its cost is infinite where there is none inside the limits. Where lanes
  // tell branches apart it is that of the point's: near a fold two are as near to it.
  Point beside(double at, const Point& near) const noexcept {
    const Sample s = sweep.at(at, true);
    int best = Sample::kMarginsTell && (s.inside(near.lane) || (s.real[near.lane] && s.rough[near.lane])) ? near.lane : -1;
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
    if (s.rough[best]) Sample::refine(sweep.pose, at, q);
    return point(at, q, best);
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

  // The step to the vertex of the parabola through a point and two others, `ways` before it and lower by `falls`; whether it
  // lies between `left` and `right` and is less than half of the step `before`.
  static bool to_vertex(const double (&ways)[2], const double (&falls)[2], double before, double left, double right,
                        double& step) noexcept {
    const double r = ways[0] * falls[1];
    double t = ways[1] * falls[0], p = ways[1] * t - ways[0] * r;
    t = 2.0 * (t - r);
    p = t > 0.0 ? -p : p;
    t = std::abs(t);
    step = p / t;
    return std::abs(p) < std::abs(0.5 * t * before) && p > t * left && p < t * right;
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
      const double left = low - x, right = high - x, ways[2] = {x - second, x - third};
      const double falls[2] = {m.best.cost - second_cost, m.best.cost - third_cost};
      double there = 0.0;
      if (std::abs(before) > least && second_cost < kInfinity && third_cost < kInfinity &&
          to_vertex(ways, falls, before, left, right, there)) {
        before = step;
        step = there;
        if (i > 1 && std::abs(step) < least) return;
      } else {
        before = x < middle ? high - x : low - x;
        step = kGolden * before;
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
};

}  // namespace ikgen_runtime
