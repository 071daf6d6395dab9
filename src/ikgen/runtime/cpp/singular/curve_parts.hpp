// Solutions on parts of a curve, between two samples of it, by what is left of the error there and how that grows.
#pragma once

#include "roots/false_position.hpp"
#include "rows/solution_rows.hpp"
#include "singular/curve_samples.hpp"

namespace ikgen_runtime {

// Arm: as for FoldPair and SolutionRows.
template <class Arm> struct CurveParts : CurveSamples<Arm> {
  using Curve = CurveSamples<Arm>;
  using Fold = FoldPair<Arm>;
  using Sample = typename Curve::Sample;
  using Policy = typename Arm::Policy;
  static constexpr int kRoom = 32;

  int count = 0;  // solutions, nearly
  double found[kRoom][Arm::kDof];

  explicit CurveParts(const HeldAim<Arm>& goal) noexcept : Curve(goal) {}

  using Curve::is_solution;
  using Curve::kSmall;
  using Curve::part;
  using Curve::samples;

  // Finds those between two samples, by the signs of the coefficients, after Bernstein, of the cubic through values and
  // slopes; where they leave doubts, on halves of the part.
  void look(const Sample& a, const Sample& b, int deep = kDeep) noexcept {
    if (std::max(std::abs(a.left), std::abs(b.left)) >= kBeyond * Policy::kFoldReach) return;  // far beyond the curve's end
    double inner[2];
    take_inner(a, b, inner);
    const double most = std::max({std::abs(a.left), std::abs(inner[0]), std::abs(inner[1]), std::abs(b.left)});
    if (most < kSmall || deep == 0 || samples <= 0) return keep(std::abs(a.left) < std::abs(b.left) ? a : b);
    const bool from = is_solution(a), to = is_solution(b);  // whose sign is round-off's, and that are kept
    const int changes = (!from && a.left * inner[0] <= 0.0) + (inner[0] * inner[1] <= 0.0) + (!to && inner[1] * b.left <= 0.0);
    const bool tells = deep <= kDeep - kDoubts || !(a.on && b.on) || !bends(a, b, inner, most, changes);
    if (!tells || changes > 1 || (changes == 1 && (from || to))) {
      const Sample middle = part(a, b, 0.5);
      if (is_solution(middle)) keep(middle);
      look(a, middle, deep - 1);
      look(middle, b, deep - 1);
    } else if (changes == 1 && !close_in(a, b, 2.0 * most)) {
      Sample other = b;  // in the sense that samples on the way to it have
      Curve::turn_round(other);
      look(a, other, deep - 1);
    }
  }

  // Finds those between two configurations, whatever the cubic through both tells, in so many parts.
  void look_between(const double* from, const double* to, int parts = kParts) noexcept {
    Sample a = Curve::at(from);
    for (int i = 1; i <= parts; ++i) {
      double q[Arm::kDof];
      for (int j = 0; j < Arm::kDof; ++j) q[j] = from[j] + i * (SolutionRows<Arm>::change(j, from, to) / parts);
      const Sample b = Curve::at(q, a);
      if (is_solution(b)) keep(b);
      look(a, b);
      a = b;
    }
  }

  void keep(const Sample& s) noexcept {
    if (std::abs(s.left) < Policy::kArrived) note(s);
  }

  // Of where steps begin, whatever is left there.
  void note(const Sample& s) noexcept {
    if (count == kRoom) return;
    double* q = found[count++];
    for (int j = 0; j < Arm::kDof; ++j)
      q[j] = Arm::kHeld[j] ? s.q[j] : SolutionRows<Arm>::within_period(j, s.q[j]);
  }

 private:
  static constexpr int kDeep = 24, kDoubts = 3;  // how often a part is cut, and how often as the cubic bends by so much
  static constexpr double kBent = 1.5, kStraight = 0.03;  // of what it is in the middle, and at most
  static constexpr int kParts = 4;
  static constexpr int kSteps = 40;  // of false position; the product of what is left at both ends has to halve in kSoon
  static constexpr int kCubics = 4, kNewton = 8, kSoon = 4;  // first steps that go to roots of cubics, by Newton's method
  static constexpr double kRoundOff = 1e-15;
  static constexpr double kBeyond = 4.0;  // how far what is left at the end of a curve's last part may be beyond its bound
  static constexpr double kWay = 1e-10;   // rad or m: along a curve, by which what is left varies by round-off

  // Whether the cubic bends so much that it tells little of zeros beside its changes of sign: where it comes near 0, or
  // turns twice. One that only rises or falls on one side of 0 has none.
  static bool bends(const Sample& a, const Sample& b, const double (&inner)[2], double most, int changes) noexcept {
    const double first = inner[0] - a.left, middle = inner[1] - inner[0], last = b.left - inner[1];
    if (changes == 0 && first * middle >= 0.0 && middle * last >= 0.0) return false;
    const double bend = std::max(std::abs(middle - first), std::abs(last - middle));
    const bool twice = first * middle < 0.0 && middle * last < 0.0;
    return (twice || std::abs(inner[0] + inner[1]) < kBent * bend) && bend > kStraight * most;
  }

  // The inner two coefficients, after Bernstein, of the cubic through values and slopes.
  static void take_inner(const Sample& a, const Sample& b, double (&inner)[2]) noexcept {
    double way[Fold::kMoving];
    Curve::take_chord(a, b, way);
    inner[0] = a.left + a.slope * Fold::dot(way, a.still) / 3.0;
    inner[1] = b.left - b.slope * Fold::dot(way, b.still) / 3.0;
  }

  // Where that cubic vanishes between the samples, at which it has two signs: by Newton's method from a share of the way,
  // or the middle where that leads out.
  static double root_share(const Sample& a, const Sample& b, double share) noexcept {
    double inner[2], x = share, low = 0.0, high = 1.0;
    take_inner(a, b, inner);
    const double one = 3.0 * (inner[0] - a.left), two = 3.0 * (inner[1] - 2.0 * inner[0] + a.left);
    const double three = b.left - a.left + 3.0 * (inner[0] - inner[1]);
    for (int i = 0; i < kNewton; ++i) {
      const double value = ((three * x + two) * x + one) * x + a.left;
      (value * a.left > 0.0 ? low : high) = x;
      x -= value / ((3.0 * three * x + 2.0 * two) * x + one);
      if (!(x > low && x < high)) x = 0.5 * (low + high);
    }
    return x;
  }

  // Where what is left changes its sign: first at roots of cubics, then by false position, until that is round-off, or the
  // way to there is. Where far more is left between the samples than the cubic's coefficients bound, or the product at the
  // ends hardly falls, they are of no one curve: then false.
  bool close_in(Sample a, Sample b, double most) noexcept {
    double way = kInfinity, goal = kInfinity;
    bool led = true;
    FalsePosition ends{a.left, b.left};
    for (int i = 0; i < kSteps && way > kWay; ++i) {
      const double product = std::abs(a.left * b.left);
      if (std::min(std::abs(a.left), std::abs(b.left)) <= kRoundOff) break;
      led = i % kSoon != 0 || product <= goal;
      if (!led) break;
      if (i % kSoon == 0) goal = 0.5 * product;
      const double share = ends.share();
      const Sample c = part(a, b, i < kCubics ? root_share(a, b, share) : share);
      led = std::abs(c.left) <= most;
      if (!led) break;
      const bool last = a.left * c.left < 0.0;
      way = 0.0;
      for (int k = 0; k < Fold::kMoving; ++k)
        way = std::max(way, std::abs(c.q[Fold::kJoints[k]] - (last ? b : a).q[Fold::kJoints[k]]));
      (last ? b : a) = c;
      ends.take(c.left, !last);
    }
    keep(std::abs(a.left) < std::abs(b.left) ? a : b);
    return led;
  }
};

}  // namespace ikgen_runtime
