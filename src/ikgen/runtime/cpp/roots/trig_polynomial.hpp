#pragma once

#include <algorithm>
#include <cmath>

#include "arrays/constants.hpp"

namespace ikgen_runtime {

// Real roots in an interval of `a0 + sum(a[i] cos(n[i] t) + b[i] sin(n[i] t))`, M terms, all of them. Intervals are halved
// until Taylor's expansion about the middle, with a bound on the third derivative, shows that the polynomial has no root
// in one, or goes one way there, or bends one way: then signs tell its roots. (R. E. Moore, Interval Analysis, 1966.)
template <int M> class TrigPolynomial {
public:
  double a[M], b[M], n[M], a0;

  // Of values up to 1. A complex pair of roots counts as one, at the extremum, where its imaginary part moves the
  // fastest term by `tol` (rad) at most.
  void bound(double tol) noexcept {
    double second = 0.0;
    fastest_ = third_ = 0.0;
    for (int i = 0; i < M; ++i) {
      const double r = std::sqrt(a[i] * a[i] + b[i] * b[i]);
      fastest_ = std::max(fastest_, n[i]);
      second += r * n[i] * n[i];
      third_ += r * n[i] * n[i] * n[i];
    }
    touch_ = 0.5 * tol * tol / (fastest_ * fastest_);
    slack_ = touch_ * second + kRoundOff;
  }

  // Roots from `low` to `high`, ascending, `most` at most; how many.
  int roots(double low, double high, int most, double* out) const noexcept {
    Found found{out, most, 0};
    const double pieces = std::max(std::ceil((high - low) * fastest_ / kStride), 1.0), step = (high - low) / pieces;
    for (double i = 1.0; i < pieces; i += 1.0) part(low + (i - 1.0) * step, low + i * step, found);
    part(low + (pieces - 1.0) * step, high, found);
    return found.count;
  }

private:
  static constexpr double kRoundOff = 1e-14;
  static constexpr double kStride = 1.5;  // of the fastest term (rad): length of the parts that are looked at first
  static constexpr double kLeast = 3e-5;  // the same: half length of parts that are not halved any more
  static constexpr double kSame = 1e-7;   // how far a root may lie from itself a turn before (rad)
  static constexpr int kSteps = 60;

  struct Found {
    double* root;
    int most, count;
    void add(double t) noexcept {
      for (int i = 0; i < count; ++i)  // of an interval that is longer than a turn
        if (std::abs(t - kTurn - root[i]) <= kSame) return;
      if (count < most) {
        root[count++] = t;
        return;
      }
      // Round-off makes more of some that meet: the one that is nearest behind another has to go.
      int nearest = most;
      double gap = t - root[most - 1];
      for (int i = most - 1; i > 0; --i)
        if (root[i] - root[i - 1] <= gap) gap = root[nearest = i] - root[i - 1];
      if (nearest == most) return;
      for (int i = nearest; i + 1 < most; ++i) root[i] = root[i + 1];
      root[most - 1] = t;
    }
  };

  // The polynomial and its two derivatives.
  struct Values {
    double order[3];
  };

  double fastest_, third_, touch_, slack_;

  Values values(double t) const noexcept {
    Values out{{a0, 0.0, 0.0}};
    for (int i = 0; i < M; ++i) {
      const double c = std::cos(n[i] * t), s = std::sin(n[i] * t), u = a[i] * c + b[i] * s;
      out.order[0] += u;
      out.order[1] += n[i] * (b[i] * c - a[i] * s);
      out.order[2] -= n[i] * n[i] * u;
    }
    return out;
  }

  void part(double low, double high, Found& found) const noexcept {
    const double middle = 0.5 * (low + high), half = 0.5 * (high - low), third = third_ * half;
    const Values at = values(middle);
    const double f = std::abs(at.order[0]), slope = std::abs(at.order[1]), bend = std::abs(at.order[2]);
    if (f > (slope + (0.5 * bend + third / 6.0) * half) * half + slack_) return;
    const bool one_way = slope > (bend + 0.5 * third) * half;
    if (one_way || bend > third || half * fastest_ < kLeast) {
      told(low, high, one_way, found);
    } else {
      part(low, middle, found);
      part(middle, high, found);
    }
  }

  // The roots where the polynomial goes one way, or bends one way.
  void told(double low, double high, bool one_way, Found& found) const noexcept {
    const Values before = values(low), after = values(high);
    const bool above = before.order[0] >= 0.0;
    if (above != (after.order[0] >= 0.0)) {
      found.add(crossing(low, high, 0));
      return;
    }
    if (one_way || (before.order[1] >= 0.0) == (after.order[1] >= 0.0)) return;
    const double top = crossing(low, high, 1);
    const Values there = values(top);
    if (above != (there.order[0] >= 0.0)) {
      found.add(crossing(low, top, 0));
      found.add(crossing(top, high, 0));
    } else if (!(std::abs(there.order[0]) > touch_ * std::abs(there.order[2]) + kRoundOff)) {
      found.add(top);
    }
  }

  // Where a derivative changes its sign between low and high: Newton steps, and halves where they leave what encloses it.
  double crossing(double low, double high, int order) const noexcept {
    const bool rises = values(high).order[order] >= 0.0;
    double t = 0.5 * (low + high);
    for (int i = 0; i < kSteps; ++i) {
      const Values at = values(t);
      const double f = at.order[order], slope = at.order[order + 1];
      if (f == 0.0) break;
      ((f >= 0.0) == rises ? high : low) = t;
      const double to = t - f / slope, before = t;
      t = to > low && to < high ? to : 0.5 * (low + high);
      if (std::abs(t - before) <= 4e-16 * std::max(std::abs(before), 1e-3)) break;
    }
    return t;
  }
};

// The roots as cosines and sines: a and b of each term, a0; the harmonic of each; the ends of the interval, the largest
// imaginary part, and how many roots there are at most. None where all coefficients are 0, or one is not finite.
struct TrigPolynomialRoots {
  template <int N, int B> int operator()(const double (&x)[N], double (&roots)[B][2]) const noexcept {
    constexpr int m = (N - 5) / 3;
    double size = 0.0;
    for (int i = 0; i <= 2 * m; ++i) size = std::max(size, std::isfinite(x[i]) ? std::abs(x[i]) : kInfinity);
    if (!(size > 0.0 && size < kInfinity)) return 0;
    TrigPolynomial<m> f;
    for (int i = 0; i < m; ++i) {
      f.a[i] = x[2 * i] / size;
      f.b[i] = x[2 * i + 1] / size;
      f.n[i] = x[2 * m + 1 + i];
    }
    f.a0 = x[2 * m] / size;
    const double* rest = x + 3 * m + 1;
    f.bound(rest[2]);
    double t[B];
    const int count = f.roots(rest[0], rest[1], B, t);
    for (int i = 0; i < count; ++i) {
      roots[i][0] = std::cos(t[i]);
      roots[i][1] = std::sin(t[i]);
    }
    return count;
  }
};

inline constexpr TrigPolynomialRoots trig_polynomial_branches{};

}  // namespace ikgen_runtime
