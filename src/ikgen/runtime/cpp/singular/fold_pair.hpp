// Solutions near a singularity, where Newton's method stalls: the pose to second order along the direction in which it
// moves least, to first order along the others (Lyapunov and Schmidt's reduction; Golubitsky & Schaeffer 1985, I.3).
#pragma once

#include "arm/moving_joints.hpp"
#include "arm/pose_error.hpp"

namespace ikgen_runtime {

// Arm: as for PoseError; kHeld, a flag a joint; Policy.
template <class Arm> struct FoldPair {
  static constexpr MovingJoints<Arm> kJoints{};
  static constexpr int kMoving = MovingJoints<Arm>::kCount, kEquations = PoseError<Arm>::kCount;
  using Vector = double[kMoving];

  HeldAim<Arm> aim;
  Vector still;             // unit direction in which the pose moves least
  double out[kEquations];  // unit direction of the error in which no other moves it

  explicit FoldPair(const HeldAim<Arm>& goal) noexcept : aim(goal) {
    for (int k = 0; k < kMoving; ++k) still[k] = 1.0 + 0.1 * k;
    for (int e = 0; e < kEquations; ++e) out[e] = 0.1 + 0.01 * e;  // shorter than what has a sense
  }

  // From q towards one of the two solutions that may meet nearby, or to the place where they nearly do.
  void approach(double side, double* q) noexcept {
    for (int i = 0; i < kSteps; ++i)
      if (!(std::abs(step(side, q)) > kClose)) break;
  }

  // One step across the still direction; how far its fastest joint goes, what it leaves of the error, and how much more a
  // step along the still direction does.
  double correct(double* q, double& left, double& slope, Vector& across) noexcept {
    const PoseError<Arm> at(q, aim);
    find_still(at);
    const Others others(*this, at);
    Vector ignored;
    double rest[kEquations], square = 0.0, farthest = 0.0;
    others.take_away(at.error, rest, across);
    others.take_away(out, out, ignored);
    for (const double x : out) square += x * x;
    const double inverse = (square < kTurned ? others.sense(out, still) : 1.0) / std::sqrt(square);
    left = slope = 0.0;
    for (int e = 0; e < kEquations; ++e) {
      out[e] *= inverse;
      left += out[e] * rest[e];
      slope -= out[e] * others.flow[e];
    }
    move(across, 0.0, q);
    for (const double x : across) farthest = std::max(farthest, std::abs(x));
    return farthest;
  }

 private:
  static constexpr double kTurned = 0.5;  // squared length of what is left of a unit direction that turned by 45 degrees
  static constexpr double kAlong = 1e-4, kClose = 1e-9, kFar = 0.3, kStands = 1e-9;
  static constexpr int kSteps = 8;

  // One step; how far it goes in the still direction.
  double step(double side, double* q) noexcept {
    const PoseError<Arm> at(q, aim);
    find_still(at);
    const Others others(*this, at);
    double bend[kEquations], bent[kEquations], flow[kEquations], rest[kEquations], there[Arm::kDof];
    std::copy_n(q, Arm::kDof, there);
    for (int k = 0; k < kMoving; ++k) there[kJoints[k]] += kAlong * still[k];
    const PoseError<Arm> beyond(there, aim);
    for (int e = 0; e < kEquations; ++e) {
      bend[e] = 0.0;
      for (int k = 0; k < kMoving; ++k)
        bend[e] += (beyond.slope[e][kJoints[k]] - at.slope[e][kJoints[k]]) * still[k] / kAlong;
    }
    Vector ignored, across;
    others.take_away(at.error, rest, across);
    others.take_away(bend, bent, ignored);
    others.take_away(others.flow, flow, ignored);
    const double x = root(side, bent, flow, rest);
    move(across, x, q);
    return x;
  }

  void move(const Vector& across, double along, double* q) const noexcept {
    for (int k = 0; k < kMoving; ++k)
      q[kJoints[k]] += std::min(std::max(across[k], -kFar), kFar) + along * still[k];
  }

  // The root of s x + k x^2 / 2 = e on this side of the least error, or that, along the direction that the others leave.
  static double root(double side, const double (&bend)[kEquations], const double (&flow)[kEquations],
                     const double (&rest)[kEquations]) noexcept {
    double k = 0.0, s = 0.0, e = 0.0;
    for (int i = 0; i < kEquations; ++i) {
      k += bend[i] * bend[i];
      s += bend[i] * flow[i];
      e += bend[i] * rest[i];
    }
    if (!(k > 0.0)) return 0.0;
    const double square = s * s + 2.0 * k * e, p = s + std::copysign(std::sqrt(std::max(square, 0.0)), s);
    const double x = (s > 0.0) == (side > 0.0) && square > 0.0 ? 2.0 * e / p : -p / k;
    return std::min(std::max(x, -kFar), kFar);
  }

  // The directions across the still one, and what that does to the pose.
  struct Others {
    double V[kEquations][kMoving], A[kMoving][kMoving], flow[kEquations];

    Others(const FoldPair& fold, const PoseError<Arm>& at) noexcept {
      for (int e = 0; e < kEquations; ++e) {
        flow[e] = 0.0;
        for (int k = 0; k < kMoving; ++k) flow[e] += at.slope[e][kJoints[k]] * fold.still[k];
        for (int k = 0; k < kMoving; ++k) V[e][k] = at.slope[e][kJoints[k]] - flow[e] * fold.still[k];
      }
      for (int a = 0; a < kMoving; ++a)
        for (int b = 0; b <= a; ++b) {
          A[a][b] = fold.still[a] * fold.still[b] + (a == b ? Arm::Policy::kLeastDamping : 0.0);
          for (int e = 0; e < kEquations; ++e) A[a][b] += V[e][a] * V[e][b];
        }
      factor(A);
    }

    // 1 or -1, which takes `error` in the sense that goes with the still direction's, `along`: what the others do to the
    // pose, with `error` for the still one, keeps orientation, however far that turns from one sample to the next.
    double sense([[maybe_unused]] const double* error, [[maybe_unused]] const double* along) const noexcept {
      if constexpr (kEquations != kMoving) {
        return 1.0;
      } else {
        double turned[kMoving][kMoving];
        for (int e = 0; e < kEquations; ++e)
          for (int k = 0; k < kMoving; ++k) turned[e][k] = V[e][k] + error[e] * along[k];
        return keeps_orientation(turned) ? 1.0 : -1.0;
      }
    }

    // What they leave of z, by going y.
    void take_away(const double* z, double* rest, Vector& y) const noexcept {
      for (int k = 0; k < kMoving; ++k) {
        y[k] = 0.0;
        for (int e = 0; e < kEquations; ++e) y[k] += V[e][k] * z[e];
      }
      substitute(A, y);
      std::copy_n(z, kEquations, rest);
      for (int e = 0; e < kEquations; ++e)
        for (int k = 0; k < kMoving; ++k) rest[e] -= V[e][k] * y[k];
    }
  };

  // By inverse iteration, two steps at once, from what it was, which keeps its sense.
  void find_still(const PoseError<Arm>& at) noexcept {
    double N[kMoving][kMoving];
    for (int a = 0; a < kMoving; ++a)
      for (int b = 0; b <= a; ++b) {
        N[a][b] = a == b ? Arm::Policy::kLeastDamping : 0.0;
        for (int e = 0; e < kEquations; ++e) N[a][b] += at.slope[e][kJoints[a]] * at.slope[e][kJoints[b]];
      }
    factor(N);
    double change = 1.0;
    for (int i = 0; i < 2 && change > kStands * kStands; ++i) {
      Vector next;
      std::copy_n(still, kMoving, next);
      substitute(N, next);
      substitute(N, next);
      double square = 0.0;
      for (const double x : next) square += x * x;
      const double inverse = 1.0 / std::sqrt(square);
      change = 0.0;
      for (int k = 0; k < kMoving; ++k) {
        const double turned = inverse * next[k], gap = turned - still[k];
        change += gap * gap;
        still[k] = turned;
      }
    }
  }
};

}  // namespace ikgen_runtime
