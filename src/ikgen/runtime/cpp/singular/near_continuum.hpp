// Solutions on what is a continuum of the geometry that was solved, and none of the file's. Along it the other joints take
// the pose's error away but for one direction (Lyapunov and Schmidt's reduction; Golubitsky & Schaeffer 1985, I.3): a
// solution is where what is left changes its sign, or touches 0.
#pragma once

#include "rows/solution_rows.hpp"
#include "singular/curve_parts.hpp"

namespace ikgen_runtime {

// Arm: as for FoldPair and SolutionRows.
template <class Arm> struct NearContinuum : CurveParts<Arm> {
  using Curve = CurveParts<Arm>;
  using Fold = FoldPair<Arm>;
  using Sample = typename Curve::Sample;
  using Policy = typename Arm::Policy;

  // Samples of broken curves that were followed all around or to both their ends, in order.
  struct Passed {
    static constexpr int kSamples = 128;
    int count = 0;
    Sample sample[kSamples];
    bool first[kSamples];  // of a way along a curve

    void add(const Sample& s, bool begins) noexcept {
      if (count < kSamples) {
        first[count] = begins;
        sample[count] = s;
      }
      ++count;
    }
  };

  explicit NearContinuum(const HeldAim<Arm>& goal) noexcept : Curve(goal) {}

  using Curve::at;
  using Curve::between;
  using Curve::count;
  using Curve::is_solution;
  using Curve::keep;
  using Curve::note;
  using Curve::look;
  using Curve::samples;

  // No continuum nearby, one of the solved geometry, one that was passed, one of the file's too.
  enum class Kind { None, Broken, Known, Whole };
  int passing = 0;  // samples of the last one, behind those that are kept
  int met = 0;      // solutions on the last one, be it too short for one or the file's

  // Finds those on the curve through a configuration: once around, or to both its ends; of one that is too short only
  // where it could not be followed; and those on others that cross it.
  Kind trace(const double* start, Passed& passed) noexcept {
    const Sample first = at(start);
    const bool keeps = Curve::fold.in_sense();
    if (const int end = passed_part(passed, first); end > 0) {
      look_beside(passed.sample[end - 1], first, passed.sample[end]);
      met = count;
      return Kind::Known;
    }
    crossings = 0;
    const Kind kind = follow_both(first, keeps, passed);
    if (kind == Kind::Whole || lost) return kind;
    const int noted = crossings, own = passing;
    crossings = kCrossings;  // those of the others do not count
    // where curves only come near each other, what is left turns to the other sense within a part
    for (int i = 0; i < noted && kind == Kind::Broken; ++i)
      Curve::look_between(crossing[i].from.q, crossing[i].to.q, kFine);
    for (int i = 0; i < noted; ++i) follow_other(crossing[i], passed);
    passing = own;
    met = count;
    return kind;
  }

  // From both sides of a configuration: where another curve nearly crosses, corrections lead astray.
  void trace_aside(const double* start, Passed& passed) noexcept {
    const auto begin = Curve::fold.begin(start);
    for (const double side : {kAside, -kAside}) {
      double q[Arm::kDof];
      step_along(start, begin.still, side, q);
      if (trace(q, passed) != Kind::None) return;
    }
  }

  // Whether a configuration is on curves that were passed.
  bool passes(const Passed& passed, const double* q) noexcept { return passed_part(passed, at(q)) > 0; }

 private:
  static constexpr int kMost = 96;
  static constexpr double kSettled = 4.0, kAround = 2.0;  // steps behind which it is on its curve, and it may be back
  static constexpr int kLeast = 4;
  static constexpr int kRounds = 3;
  static constexpr double kBeside = 0.06;
  static constexpr double kSameWay = 0.9;
  static constexpr double kFloor = 0.1, kAhead = 0.5;  // the shortest step, of Policy::kTryStep; how a step turns at most
  static constexpr double kOver = 0.05;  // of a part
  static constexpr double kOn = 1e-6;    // rad or m off a curve

  // A part of a curve on which others cross it: there two directions hardly move the pose, and the sense in which the others
  // do with the still one for another turns round.
  struct Crossing {
    Sample from, to;
    bool sense;  // at the first
  };
  static constexpr int kCrossings = 4;
  static constexpr int kHalves = 4;
  static constexpr int kFine = 8;  // parts of one in which what is left turns
  static constexpr double kAside = 0.4;  // rad or m: so far from a crossing curves are apart
  Crossing crossing[kCrossings];
  int crossings = 0;

  double steps = 0.0;  // of Policy::kTryStep
  bool lost = false;   // where corrections converge from no step
  bool ended = true;   // whether they were followed to their ends

  // To both sides of a sample, or once around; keeps: the sense there.
  Kind follow_both(const Sample& first, bool keeps, Passed& passed) noexcept {
    const int known = passed.count, before = count;
    double worst = std::abs(first.left);
    steps = 0.0;
    lost = false;
    ended = true;
    if (!follow(first, 1.0, keeps, worst, passed)) follow(first, -1.0, keeps, worst, passed);
    const Kind kind = steps < kLeast ? Kind::None : worst >= Policy::kArrived ? Kind::Broken : Kind::Whole;
    met = count;
    if (kind == Kind::Whole || (kind == Kind::None && !lost)) count = before;
    passing = passed.count - known;
    if (kind != Kind::Broken || lost || !ended || passed.count > Passed::kSamples) passed.count = known;
    return kind;
  }

  // The curves that cross another, from both sides of the crossing, which is found by halves: so near it corrections may lead
  // back to the one that is known.
  void follow_other(const Crossing& last, Passed& passed) noexcept {
    Sample a = last.from, b = last.to;
    for (int i = 0; i < kHalves; ++i) {
      const Sample middle = Curve::part(a, b, 0.5);
      (Curve::fold.in_sense() == last.sense ? a : b) = middle;
    }
    note(a);  // beside a crossing samples go astray to the other curve: steps begin there, wherever those led
    note(b);
    find_across(last, a);
    for (const double side : {kAside, -kAside}) {
      double q[Arm::kDof];
      step_along(a.q, a.still, side, q);
      for (const bool anew : {false, true}) {
        const Sample first = at(q, a, anew);
        const bool keeps = Curve::fold.in_sense();
        if (first.on && passed_part(passed, first) == 0) follow_both(first, keeps, passed);
      }
    }
  }

  // In the place of a sample's still direction the one across the part in which the pose moves least, by inverse iteration:
  // still directions turn there from one curve to the other.
  void find_across(const Crossing& part, Sample& s) const noexcept {
    double N[Fold::kMoving][Fold::kMoving], along[Fold::kMoving];
    way_to(part.from, part.to.q, along);
    make_unit(along);
    Fold::factor_normal(PoseError<Arm>(s.q, Curve::fold.aim), N, along);
    for (int k = 0; k < Fold::kMoving; ++k) s.still[k] = 1.0 + 0.1 * k;
    inverse_iteration(N, s.still);
    for (double& x : s.out) x *= 0.1;  // of no sense yet
  }

  // The place beside another in a direction, the fastest joint by so much.
  static void step_along(const double* from, const typename Fold::Vector& along, double by, double* q) noexcept {
    double largest = 0.0;
    std::copy_n(from, Arm::kDof, q);
    for (const double x : along) largest = std::max(largest, std::abs(x));
    for (int k = 0; k < Fold::kMoving; ++k) q[Fold::kJoints[k]] += by / largest * along[k];
  }

  // On from a sample, the fastest joint by Policy::kTryStep from one to the next, or by less where corrections converge
  // from there alone; whether it comes back to where it began. If that is beside the curve it ends where it comes back to a
  // sample that has settled.
  bool follow(const Sample& first, double sense, bool keeps, double& worst, Passed& passed) noexcept {
    Sample b = first;
    if (sense < 0.0) Curve::turn_round(b);
    const Sample origin = b;
    if (is_solution(b)) keep(b);
    passed.add(b, true);
    Sample settled;
    const double begun = steps;
    double reach = Policy::kTryStep, last = reach, from = kInfinity, before[Fold::kMoving];  // from: where it settled
    std::copy_n(b.still, Fold::kMoving, before);
    for (int k = 0; k < kMost && samples > 0; ++k) {
      double q[Arm::kDof], course[Fold::kMoving];  // as the curve turned since the sample before
      for (int i = 0; i < Fold::kMoving; ++i) course[i] = b.still[i] + 0.5 * reach / last * (b.still[i] - before[i]);
      step_along(b.q, course, reach, q);
      const Sample c = at(q, b);
      const bool now = Curve::fold.in_sense();
      if (!(c.on && ahead(b, c, reach))) {
        if (reach < kFloor * Policy::kTryStep) {
          lost = true;
          return false;
        }
        reach *= 0.5;
        continue;
      }
      if (!(std::abs(c.left) < Policy::kFoldReach)) {
        look(b, c);
        return false;
      }
      const double gone = steps - begun;  // to b
      steps += reach / Policy::kTryStep;
      passed.add(c, false);
      worst = std::max(worst, std::abs(c.left));
      if (now != keeps && crossings < kCrossings) crossing[crossings++] = {b, c, keeps};
      keeps = now;
      if (is_solution(c)) keep(c);
      look(b, c);
      if (gone >= kAround && back(origin, b)) return true;
      if (gone >= from + kAround && back(settled, b)) return false;
      if (gone >= kSettled && !(from < kInfinity)) {
        settled = b;
        from = gone;
      }
      std::copy_n(b.still, Fold::kMoving, before);
      b = c;
      last = reach;
      reach = std::min(2.0 * reach, Policy::kTryStep);
    }
    ended = false;
    return true;
  }

  // The end of the part of passed curves that goes through a sample, or 0.
  int passed_part(const Passed& passed, const Sample& s) noexcept {
    for (int i = 1; i < passed.count && s.on; ++i) {
      const Sample &a = passed.sample[i - 1], &b = passed.sample[i];
      if (passed.first[i]) continue;
      double chord[Fold::kMoving], way[Fold::kMoving], q[Arm::kDof];
      way_to(a, s.q, way);
      way_to(a, b.q, chord);
      const double share = Fold::dot(chord, way) / Fold::dot(chord, chord);
      if (!(share > -kOver && share < 1.0 + kOver && on_line(way, share, chord, kBeside))) continue;
      between(a, b, share, q);
      for (int round = 0; round < kRounds; ++round) {
        const Sample c = at(q, a);
        if (!c.on) break;
        const double ahead = way_to(c, s.q, way);
        if (on_line(way, ahead, c.still, kOn)) return i;
        if (!on_line(way, ahead, c.still, ahead * ahead)) break;
        std::copy_n(c.q, Arm::kDof, q);
        for (int k = 0; k < Fold::kMoving; ++k) q[Fold::kJoints[k]] += ahead * c.still[k];
      }
    }
    return 0;
  }

  // In a part that was looked at before, to both sides of another sample of it: solutions there may be more than a cubic
  // tells, and closed forms start near them.
  void look_beside(const Sample& a, Sample s, const Sample& b) noexcept {
    double way[Fold::kMoving];
    way_to(a, s.q, way);
    for (int k = 0; k < Fold::kMoving; ++k) s.q[Fold::kJoints[k]] = a.q[Fold::kJoints[k]] + way[k];
    s = at(s.q, a);  // in the same sense
    if (is_solution(s)) keep(s);
    look(a, s);
    look(s, b);
  }

  // Whether the curve goes on from a sample to another, and not back.
  static bool ahead(const Sample& a, const Sample& b, double reach) noexcept {
    double way[Fold::kMoving];
    const double along = way_to(a, b.q, way);
    return along > 0.5 * reach && along * along > 0.5 * Fold::dot(way, way) && Fold::dot(a.still, b.still) > kAhead;
  }

  // Whether the curve is at a sample of it again, and not at another part that is near.
  static bool back(const Sample& a, const Sample& b) noexcept {
    double way[Fold::kMoving];
    const double along = way_to(a, b.q, way);
    for (const double x : way)
      if (!(std::abs(x) < 0.75 * Policy::kTryStep)) return false;
    return Fold::dot(a.still, b.still) > kSameWay && on_line(way, along, a.still, kBeside);
  }

  // The way from a sample to a configuration but for whole turns, and how far it goes along the still direction.
  static double way_to(const Sample& a, const double* q, double (&way)[Fold::kMoving]) noexcept {
    for (int k = 0; k < Fold::kMoving; ++k) way[k] = SolutionRows<Arm>::change(Fold::kJoints[k], a.q, q);
    return Fold::dot(way, a.still);
  }

  // Whether a way goes so far in a direction, and less than a bound beside that.
  static bool on_line(const double* way, double along, const double* direction, double bound) noexcept {
    for (int k = 0; k < Fold::kMoving; ++k)
      if (!(std::abs(way[k] - along * direction[k]) < bound)) return false;
    return true;
  }
};

}  // namespace ikgen_runtime
