// The least cost between values of the held joint, by parabolas through the best three.
#pragma once

#include <algorithm>
#include <cmath>

#include "arrays/constants.hpp"
#include "rows/solution_rows.hpp"

namespace ikgen_runtime {

// A row, and what it costs. Arm: kDof.
template <class Arm> struct HeldPoint {
  double at, cost, q[Arm::kDof];
  int lane;
  bool fold = false;  // whether two branches meet there
};

// Three values, of which that between, or an end, is the best; the rows at the outer ones.
template <class Arm> struct HeldMinimum {
  double low, high, low_cost, high_cost;
  HeldPoint<Arm> best;
  bool folds[2];
  double rows[2][Arm::kDof];

  HeldMinimum() = default;
  HeldMinimum(const HeldPoint<Arm>& a, const HeldPoint<Arm>& b, const HeldPoint<Arm>& least) noexcept
      : low(a.at), high(b.at), low_cost(a.cost), high_cost(b.cost), best(least) {
    folds[0] = a.fold;
    folds[1] = b.fold;
    std::copy_n(a.q, Arm::kDof, rows[0]);
    std::copy_n(b.q, Arm::kDof, rows[1]);
  }

  // The branch's row at a value between them, nearly: beside folds it goes as the root of the value.
  void between(double at, double* q) const noexcept {
    const int side = at < best.at ? 0 : 1;
    const double from = way(best.at), share = (way(at) - from) / (way(side == 0 ? low : high) - from);
    for (int j = 0; j < Arm::kDof; ++j) q[j] = best.q[j] + share * SolutionRows<Arm>::change(j, best.q, rows[side]);
  }

 private:
  // What rows are even in, nearly.
  double way(double at) const noexcept {
    const double below = std::max(at - low, 0.0), above = std::max(high - at, 0.0);
    if (folds[0] && folds[1]) return std::atan2(std::sqrt(below), std::sqrt(above));
    return folds[0] ? std::sqrt(below) : folds[1] ? -std::sqrt(above) : at;
  }
};

// Through a point and two others, `a` and `b` before it, from which it falls by `fall_a` and `fall_b` (its own less theirs).
struct Parabola {
  double bend, slope;

  Parabola(double a, double fall_a, double b, double fall_b) noexcept
      : bend((fall_a / a - fall_b / b) / (b - a)), slope(fall_a / a + bend * a) {}

  double rise(double step) const noexcept { return step * (slope + bend * step); }

  // The step to where it is least; not finite where it has no such place.
  double vertex() const noexcept { return bend > 0.0 ? -slope / (2.0 * bend) : kInfinity; }
};

// Parabolic interpolation guarded by the golden section (Brent 1973), one value after the other: begin(minimum), then while
// next(), take(what the row at `trial` costs).
template <class Arm> struct ParabolicDescent {
  using Point = HeldPoint<Arm>;
  using Minimum = HeldMinimum<Arm>;
  // How near to a minimum is enough, of singular values, which have kinks: beside a fold joint values change as the root
  // of the held one's, up to 1e3 times as much.
  static constexpr double kNear = 1e-9;
  static constexpr double kForeseen = 1e-12;  // how well a parabola tells the cost at its vertex, where it is the least
  static constexpr int kSteps = 60;
  double trial;

  void begin(Minimum& wanted) noexcept {
    minimum = &wanted;
    const Minimum& m = wanted;
    low = m.low;
    high = m.high;
    step = 0.5 * (high - low);
    before = high - low;
    second = low;
    third = high;
    second_cost = m.low_cost;
    third_cost = m.high_cost;
    if (third_cost < second_cost) {
      std::swap(second, third);
      std::swap(second_cost, third_cost);
    }
    at_end = m.best.at == low || m.best.at == high;
  }

  // Whether there is a value to look at.
  bool next() noexcept {
    done = done || !tries();
    return !done;
  }

  void take(const Point& p) noexcept {
    Point& best = minimum->best;
    if (at_end) {
      at_end = false;
      done = p.cost >= best.cost && p.cost < kInfinity;
      return;
    }
    done = std::abs(p.cost - foreseen) <= kForeseen;
    if (p.cost < best.cost) {
      (p.at >= best.at ? low : high) = best.at;
      third = second;
      third_cost = second_cost;
      second = best.at;
      second_cost = best.cost;
      best = p;
    } else {
      (p.at < best.at ? low : high) = p.at;
      if (p.cost <= second_cost || second == best.at) {
        third = second;
        third_cost = second_cost;
        second = p.at;
        second_cost = p.cost;
      } else if (p.cost <= third_cost || third == best.at || third == second) {
        third = p.at;
        third_cost = p.cost;
      }
    }
  }

 private:
  static constexpr double kGolden = 0.3819660112501051;
  Minimum* minimum;
  double low, high, step, before, second, third, second_cost, third_cost, foreseen;
  int steps = 0;
  bool at_end, done = false;

  bool tries() noexcept {
    const Point& best = minimum->best;
    const double x = best.at, middle = 0.5 * (low + high), least = kNear * (1.0 + std::abs(x));
    if (at_end) {  // if it is better than what is next to it
      const double remote = x == low ? high : low;
      trial = x + std::copysign(least, remote - x);
      return std::abs(remote - x) > 2.0 * least;
    }
    if (steps == kSteps || std::abs(x - middle) <= 2.0 * least - 0.5 * (high - low)) return false;
    foreseen = kInfinity;
    const Parabola through(x - second, best.cost - second_cost, x - third, best.cost - third_cost);
    const double there = through.vertex();
    if (std::abs(before) > least && second_cost < kInfinity && third_cost < kInfinity &&
        std::abs(there) < std::abs(0.5 * before) && there > low - x && there < high - x) {
      before = step;
      step = there;
      if (steps > 1 && std::abs(step) < least) return false;
    } else {
      before = x < middle ? high - x : low - x;
      step = kGolden * before;
    }
    const double u = std::abs(step) >= least ? x + step : x + (step > 0.0 ? least : -least);
    trial = std::min(std::max(u, minimum->low), minimum->high);
    if (step == there) foreseen = best.cost + through.rise(trial - x);
    ++steps;
    return true;
  }
};

}  // namespace ikgen_runtime
