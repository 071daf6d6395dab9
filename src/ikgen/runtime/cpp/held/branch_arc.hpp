// The curve on which a row moves with the held value, between two of its points: beyond a fold the held value turns back.
#pragma once

#include "held/branch_curve.hpp"
#include "held/held_sweep.hpp"
#include "roots/false_position.hpp"

namespace ikgen_runtime {

// Points are told apart by their share of the way along the chord between the two ends (Keller 1977: a curve goes on
// smoothly past a fold by another parameter than the held value). Arm: as for HeldSweep.
template <class Arm> struct BranchArc {
  static constexpr double kArrived = 1e-9;  // error of rows on it
  using Curve = BranchCurve<Arm>;
  static constexpr MovingJoints<Arm> kJoints{};
  static constexpr int kMoving = Curve::kMoving, kVariables = kMoving + 1;
  using Vector = double[kVariables];

  struct Point {
    double share = 0.0, held = 0.0, off = 0.0, q[Arm::kDof];
    Vector flow;  // derivatives of the joints that move and, last, of the held value by the share

    double rise() const noexcept { return flow[kMoving]; }
  };

  const HeldSweep<Arm>& sweep;
  Point from, to;

  // Between two rows, each at a value of the held joint.
  BranchArc(const HeldSweep<Arm>& values, const double* q, double held, const double* other, double value) noexcept
      : sweep(values) {
    set(from, q, held);
    set(to, other, value);
    to.share = 1.0;
    way(from, to, chord);
    for (const double x : chord) length += x * x;
    length = std::sqrt(length);
    std::copy_n(chord, kVariables, from.flow);
    std::copy_n(chord, kVariables, to.flow);
  }

  // Just before the held value, which goes up (`sense` 1) or down (-1) at the first of the ends, turns back; false where
  // it does not on the way to the other.
  bool fold(double sense, Point& out) const noexcept {
    if (length < kTouching) {
      out = from;
      return true;
    }
    Point a, b;
    if (!find(from.share, from, a) || !find(to.share, to, b) || !(sense * a.rise() > 0.0 && sense * b.rise() < 0.0)) return false;
    const double room = 0.5 * std::sqrt(kEnough * std::abs(a.rise() - b.rise()));
    const auto value = [&](const Point& p) noexcept { return sense * p.rise() - room; };
    const auto before = [&](const Point& p) noexcept { return value(p) > 0.0; };
    const auto close = [&](const Point& p) noexcept { return std::abs(value(p)) < room; };
    out = a;
    return close(a) || cross(a, b, value(a), value(b), value, before, close, out);
  }

  // The last point inside the limits on the way from a point that is inside to one that is not: where the joint that is
  // farthest outside comes to its limit, unless another does before.
  bool limit(const Point& inside, Point outside, Point& out) const noexcept {
    const double slope = std::abs((outside.off - inside.off) / (outside.held - inside.held)), room = 0.25 * kEnough * slope;
    for (int i = 0; i < sweep.bounds.count; ++i) {
      if (!stop(inside, outside, room, out)) break;
      if (!((out.held - inside.held) * (out.held - outside.held) <= 0.0)) break;
      if (out.off <= 0.0) return true;
      outside = out;
    }
    const auto value = [&](const Point& p) noexcept { return p.off + room; };
    const auto before = [&](const Point& p) noexcept { return p.off <= -room; };
    const auto close = [&](const Point& p) noexcept { return p.off <= 0.0 && p.off > -2.0 * room; };
    return cross(inside, outside, value(inside), value(outside), value, before, close, out);
  }

 private:
  static constexpr double kEnough = 1e-10, kTouching = 1e-6, kFar = 1.0, kNearly = 3e-6;
  static constexpr int kSteps = 10, kMost = 40;
  Vector chord;
  double length = 0.0;

  void set(Point& p, const double* q, double held) const noexcept {
    std::copy_n(q, Arm::kDof, p.q);
    p.held = held;
    p.off = outside(q);
  }

  static void way(const Point& a, const Point& b, Vector& out) noexcept {
    for (int k = 0; k < kMoving; ++k) out[k] = SolutionRows<Arm>::change(kJoints[k], a.q, b.q);
    out[kMoving] = b.held - a.held;
  }

  // How far a row is outside the limits at most.
  double outside(const double* q) const noexcept { return sweep.bounds.outside(q) - Arm::Policy::kLimitTolerance; }

  // Where the joint that is farthest outside at `b` is `room` inside its limit; false where that is not near.
  bool stop(const Point& a, const Point& b, double room, Point& out) const noexcept {
    int bound = 0, place = 0;
    sweep.bounds.outside(b.q, bound);
    const int joint = sweep.bounds.joint[bound];
    while (kJoints[place] != joint) ++place;
    const double half = sweep.bounds.half[bound] + Arm::Policy::kLimitTolerance - room, at = sweep.bounds.offset(bound, b.q[joint]);
    const double part = (a.off + room) / (a.off - b.off);
    Vector along, row = {};
    way(a, b, along);
    row[place] = 1.0;
    out = a;
    for (int k = 0; k < kMoving; ++k) out.q[kJoints[k]] += part * along[k];
    out.held += part * along[kMoving];
    for (int i = 0; i < kSteps; ++i) {
      const double left = std::copysign(half, at) - sweep.bounds.offset(bound, SolutionRows<Arm>::within_period(joint, out.q[joint]));
      const double size = step(out, row, left);
      if (!(size < kFar)) return false;
      if (size < kNearly) return finish(out);
    }
    return false;
  }

  // Within half a period, and how far that is outside.
  bool finish(Point& p) const noexcept {
    for (int k = 0; k < kMoving; ++k)
      p.q[kJoints[k]] = SolutionRows<Arm>::within_period(kJoints[k], p.q[kJoints[k]]);
    p.off = outside(p.q);
    return true;
  }

  // Where `value` of the points changes its sign.
  template <class Value, class Before, class Close>
  bool cross(Point a, Point b, double x, double y, const Value& value, const Before& before, const Close& close,
             Point& out) const noexcept {
    FalsePosition ends{x, y};
    for (int i = 0; i < kMost; ++i) {
      const double part = ends.share();
      if (!find(a.share + part * (b.share - a.share), part < 0.5 ? a : b, out)) return false;
      if (close(out)) return true;
      const bool first = before(out);
      (first ? a : b) = out;
      ends.take(value(out), first);
    }
    out = a;
    return true;
  }

  // The point with this share of the way, from one beside it, by Newton's method; false where that leads away.
  bool find(double share, const Point& nearby, Point& out) const noexcept {
    out = nearby;
    out.share = share;
    for (int k = 0; k < kMoving; ++k) out.q[kJoints[k]] += (share - nearby.share) * nearby.flow[k];
    out.held += (share - nearby.share) * nearby.flow[kMoving];
    double moved = 0.0;
    for (int i = 0; i < kSteps; ++i) {
      Vector done, row;
      double left = share * length;
      way(from, out, done);
      for (int k = 0; k < kVariables; ++k) {
        row[k] = chord[k] / length;
        left -= row[k] * done[k];
      }
      const double size = step(out, row, left);
      for (double& x : out.flow) x *= length;
      moved += size;
      if (!(moved < kFar)) return false;
      if (size <= kArrived) return finish(out);
    }
    return false;
  }

  // One step to what is `left` along `row`, and the flow by that before; how far the fastest joint goes.
  double step(Point& p, const Vector& row, double left) const noexcept {
    const Curve at(sweep.pose, p.q, p.held);
    Vector d;
    double V[Curve::kCount + 1][kVariables], error[Curve::kCount + 1], A[kVariables][kVariables], farthest = 0.0;
    std::copy_n(&at.slope[0][0], Curve::kCount * kVariables, &V[0][0]);
    std::copy_n(at.error, Curve::kCount, error);
    std::copy_n(row, kVariables, V[Curve::kCount]);
    std::copy_n(row, kVariables, p.flow);
    error[Curve::kCount] = left;
    transposed_times(V, error, d);
    gram_of_columns(V, A);
    factor(A);
    substitute(A, d);
    substitute(A, p.flow);
    for (int k = 0; k < kMoving; ++k) {
      p.q[kJoints[k]] += d[k];
      farthest = std::max(farthest, std::abs(d[k]));
    }
    p.held += d[kMoving];
    return farthest <= kFar ? farthest : 2.0 * kFar;
  }
};

}  // namespace ikgen_runtime
