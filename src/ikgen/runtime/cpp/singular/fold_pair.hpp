// Solutions near a singularity, where Newton's method stalls: the pose to second order along the direction in which it
// moves least, to first order along the others (Lyapunov and Schmidt's reduction; Golubitsky & Schaeffer 1985, I.3).
#pragma once

#include "arm/moving_joints.hpp"
#include "arm/pose_error.hpp"
#include "arrays/constants.hpp"
#include "arrays/small_matrix.hpp"
#include "newton/lyapunov_schmidt.hpp"

namespace ikgen_runtime {

// Arm: as for PoseError; kHeld, a flag a joint; Policy.
template <class Arm> struct FoldPair {
  static constexpr MovingJoints<Arm> kJoints{};
  static constexpr int kMoving = MovingJoints<Arm>::kCount, kEquations = PoseError<Arm>::kCount;
  using Vector = double[kMoving];
  using Taken = LeftAcross<kEquations, kMoving>;

  HeldAim<Arm> aim;
  Vector still;             // unit direction in which the pose moves least
  double out[kEquations];  // unit direction of the error in which no other moves it
  double moved[kEquations][kMoving];  // what the others do to it where it was corrected last

  explicit FoldPair(const HeldAim<Arm>& goal) noexcept : aim(goal) {
    for (int k = 0; k < kMoving; ++k) still[k] = 1.0 + 0.1 * k;
    for (int e = 0; e < kEquations; ++e) out[e] = 0.1 + 0.01 * e;  // shorter than what has a sense
  }

  // Where an approach ends: at a solution that is known, next to one, or between two that there are not.
  enum class Led { Known, There, Between };

  // Where approaches to both sides begin.
  struct Begin {
    Taken taken;
    Vector still;

    // How far one leads along the still direction if the second order tells all.
    double lead(double side) const noexcept {
      Way way;
      return std::abs(root(side, taken.rest, way));
    }
  };

  Begin begin(const double* q) noexcept {
    Begin at{reduced(q, true), {}};
    std::copy_n(still, kMoving, at.still);
    return at;
  }

  // From q, where it begins, towards one of the two solutions that may meet nearby, until Newton's method goes there, or
  // to the place where they nearly do. known(q, reach): whether a solution is known that is nearer than that (rad or m)
  // to q.
  template <class IsKnown> Led approach(const Begin& from, double side, double* q, const IsKnown& known) noexcept {
    std::copy_n(from.still, kMoving, still);
    double bend[kEquations] = {}, apart = kInfinity;
    for (int i = 0; i < kSteps; ++i) {
      const Taken taken = i == 0 ? from.taken : reduced(q, false);
      const Way way = step(taken, side * sense_of(taken, bend), q);
      if (way.least > kApart + way.length * (kCubic * way.length * way.length + kMixed * way.across)) return Led::Between;
      if (way.apart > 0.0) apart = std::min(apart, way.apart);  // next to an inflection it tells nothing
      const double gap = way.apart > 0.0 ? apart : 0.0;
      if (known(q, kShare * std::min(gap, kTogether))) return Led::Known;
      if (way.length <= std::max(kClose, kSure * gap)) break;
    }
    return Led::There;
  }

  // One step across the still direction, found anew or that of the sample before; how far its fastest joint goes, what was
  // left of the error before it, and how much more of that a step along the still direction does.
  double correct(double* q, bool anew, double& left, double& slope, Vector& across) noexcept {
    const PoseError<Arm> at(q, aim);
    if (anew) find_still(at);
    const auto others = split<1>(at, &still);
    std::copy_n(&others.V[0][0], kEquations * kMoving, &moved[0][0]);
    const Taken taken(others, at.error, out, others.flow[0]);
    double remains = 0.0;
    for (int e = 0; e < kEquations; ++e) {
      out[e] = taken.rest[e][1];
      remains += out[e] * out[e];
    }
    const double sense = remains >= kTurned || in_sense() ? 1.0 : -1.0;  // however far it turned since the sample before
    const double inverse = sense / std::sqrt(remains);
    left = slope = 0.0;
    for (int e = 0; e < kEquations; ++e) {
      out[e] *= inverse;
      left += out[e] * taken.rest[e][0];
      slope -= out[e] * taken.rest[e][2];
    }
    const double farthest = taken.first(across);
    move(across, 0.0, q);
    slope *= turn(taken);
    return farthest;
  }

  // What is left of the error at q, and how much more of that a step along the still direction does: by directions that are
  // nearly right there, whose errors come in squared.
  void measure(const double* q, double& left, double& slope) const noexcept {
    const PoseError<Arm> at(q, aim);
    left = slope = 0.0;
    for (int e = 0; e < kEquations; ++e) {
      left += out[e] * at.error[e];
      slope -= out[e] * flow_of(at, e, still);
    }
  }

  // Whether all other directions move the pose by more than a bound (below 1) at q, where an approach ended.
  bool others_above(double bound, const double* q) const noexcept {
    return definite(split<1>(PoseError<Arm>(q, aim), &still, -bound * bound).A);
  }

  // Whether what the others did to the pose before the last correction, with `out` for the still one, keeps orientation; of
  // fewer joints than equations nothing tells.
  bool in_sense() const noexcept {
    double turned[kMoving][kMoving];
    for (int e = 0; e < kMoving; ++e)
      for (int k = 0; k < kMoving; ++k) turned[e][k] = moved[e][k] + out[e] * still[k];
    return kEquations != kMoving || keeps_orientation(turned);
  }

  // The factors of the normal equations of a pose's derivatives, with a direction that is stiff, or none.
  static void factor_normal(const PoseError<Arm>& at, double (&N)[kMoving][kMoving], const double* stiff = nullptr) noexcept {
    double slope[kEquations][kMoving];
    kJoints.columns(at.slope, slope);
    gram_of_columns(slope, N);
    for (int a = 0; a < kMoving && stiff; ++a)
      for (int b = 0; b <= a; ++b) N[a][b] += stiff[a] * stiff[b];
    shift_diagonal(Arm::Policy::kLeastDamping, N);
    factor(N);
  }

  // Those derivatives by K still directions, and by the others.
  template <int K>
  static StillSplit<kEquations, kMoving, K> split(const PoseError<Arm>& at, const Vector* along,
                                                  double shift = Arm::Policy::kLeastDamping) noexcept {
    double slope[kEquations][kMoving];
    kJoints.columns(at.slope, slope);
    return {slope, along, shift};
  }

  static double dot(const double* u, const double* v) noexcept {
    double sum = 0.0;
    for (int k = 0; k < kMoving; ++k) sum += u[k] * v[k];
    return sum;
  }

  // How a direction moves an entry of the pose's error.
  static double flow_of(const PoseError<Arm>& at, int e, const Vector& along) noexcept {
    double flow = 0.0;
    for (int k = 0; k < kMoving; ++k) flow += at.slope[e][kJoints[k]] * along[k];
    return flow;
  }

 private:
  static constexpr double kTurned = 0.5;  // squared length of what is left of a unit direction that turned by 45 degrees
  static constexpr double kAlong = 1e-4;  // rad or m: the way over which slopes are compared for the second derivative
  static constexpr double kClose = 1e-9, kFar = 0.3;  // rad or m: a step that is shorter is the last; a step, at most
  static constexpr double kSure = 1e-3;  // of the way from one solution to the other: nearer Newton's method goes there
  static constexpr double kShare = 0.1, kTogether = 1e-3;  // of that way (rad or m): nearer they are one solution
  static constexpr double kApart = 1e-8, kCubic = 20.0, kMixed = 3.0;  // least error of none; with what the second order
                                                                       // along leaves out, and the first order across
  static constexpr int kSteps = 8;

  // How far the fastest joint goes in a step, and across the still direction, how far the two solutions are apart and, where
  // there are none, the least error.
  struct Way {
    double length, across, apart, least;
  };

  // By four steps of inverse iteration from what it was, which keeps its sense.
  void find_still(const PoseError<Arm>& at) noexcept {
    double N[kMoving][kMoving];
    factor_normal(at, N);
    inverse_iteration(N, still);
  }

  // Turns the still direction to where less moves the pose, as a step of inverse iteration does: the others make good of
  // its flow, the third column. The inverse of how long it was before it was a unit again.
  double turn(const Taken& taken) noexcept {
    for (int k = 0; k < kMoving; ++k) still[k] -= taken.going[k][2];
    return make_unit(still);
  }

  // The error at q, how the still direction bends the pose and how it moves it.
  Taken reduced(const double* q, bool anew) noexcept {
    const PoseError<Arm> at(q, aim);
    if (anew) find_still(at);
    const auto others = split<1>(at, &still);
    double bend[kEquations], there[Arm::kDof];
    std::copy_n(q, Arm::kDof, there);
    for (int k = 0; k < kMoving; ++k) there[kJoints[k]] += kAlong * still[k];
    const PoseError<Arm> beyond(there, aim);
    for (int e = 0; e < kEquations; ++e) {
      bend[e] = 0.0;
      for (int k = 0; k < kMoving; ++k)
        bend[e] += (beyond.slope[e][kJoints[k]] - at.slope[e][kJoints[k]]) * still[k] / kAlong;
    }
    return Taken(others, at.error, bend, others.flow[0]);
  }

  // How what is left bends, in the sense of the steps before, takes the place of `before`. -1 where it has the other sense
  // itself, as behind an inflection: so have its slopes.
  static double sense_of(const Taken& taken, double (&before)[kEquations]) noexcept {
    double same = 0.0;
    for (int e = 0; e < kEquations; ++e) same += before[e] * taken.rest[e][1];
    const double sense = same < 0.0 ? -1.0 : 1.0;
    for (int e = 0; e < kEquations; ++e) before[e] = sense * taken.rest[e][1];
    return sense;
  }

  Way step(const Taken& taken, double side, double* q) noexcept {
    Vector across;
    Way way;
    const double x = root(side, taken.rest, way);
    way.across = taken.first(across);
    way.length = std::max(std::abs(x), way.across);
    move(across, x, q);
    turn(taken);
    return way;
  }

  void move(const Vector& across, double along, double* q) const noexcept {
    for (int k = 0; k < kMoving; ++k)
      q[kJoints[k]] += std::min(std::max(across[k], -kFar), kFar) + along * still[k];
  }

  // The root of s x + k x^2 / 2 = e on this side of the least error, or that, along the direction that the others leave,
  // of their columns e, k and s.
  static double root(double side, const double (&rest)[kEquations][4], Way& way) noexcept {
    double k = 0.0, s = 0.0, e = 0.0;
    for (const auto& row : rest) {
      e += row[1] * row[0];
      k += row[1] * row[1];
      s += row[1] * row[2];
    }
    way.apart = way.least = 0.0;
    if (!(k > 0.0)) return 0.0;
    const double square = s * s + 2.0 * k * e, size = std::sqrt(std::max(square, 0.0)), p = s + std::copysign(size, s);
    way.apart = 2.0 * size / k;
    way.least = -std::min(square, 0.0) / (2.0 * k * std::sqrt(k));
    const double x = (s > 0.0) == (side > 0.0) && square > 0.0 ? 2.0 * e / p : -p / k;
    return std::min(std::max(x, -kFar), kFar);
  }
};

}  // namespace ikgen_runtime
