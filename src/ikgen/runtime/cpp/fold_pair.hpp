// Solutions near a singularity, where Newton's method stalls: the pose to second order along the direction in which it
// moves least, to first order along the others (Lyapunov and Schmidt's reduction; Golubitsky & Schaeffer 1985, I.3).
#pragma once

#include "moving_joints.hpp"
#include "pose_error.hpp"

namespace ikgen_runtime {

// Arm: as for PoseError; kHeld, a flag a joint; Policy.
template <class Arm> struct FoldPair {
  static constexpr MovingJoints<Arm> kJoints{};
  static constexpr int kMoving = MovingJoints<Arm>::kCount, kEquations = PoseError<Arm>::kCount;
  using Vector = double[kMoving];

  HeldAim<Arm> aim;
  Vector still;       // unit direction in which the pose moves least
  double size = 0.0;  // the pose's error

  explicit FoldPair(const HeldAim<Arm>& goal) noexcept : aim(goal) {
    for (int k = 0; k < kMoving; ++k) still[k] = 1.0 + 0.1 * k;
  }

  // From q towards one of the two solutions that may meet nearby, or to the place where they nearly do.
  void approach(double side, double* q) noexcept {
    for (int i = 0; i < kSteps; ++i)
      if (!(std::abs(step(side, q)) > kClose)) break;
  }

  // Configurations from q on along those where the pose hardly moves, the fastest joint by Policy::kTryStep from one
  // to the next; the largest error there.
  template <int N> double walk(const double* q, double (&out)[N][Arm::kDof]) noexcept {
    double worst = 0.0, at[Arm::kDof];
    std::copy_n(q, Arm::kDof, at);
    step(0.0, at);
    for (auto& sample : out) {
      for (int i = 0; i < 2; ++i) step(0.0, at);
      worst = std::max(worst, size);
      std::copy_n(at, Arm::kDof, sample);
      double largest = 0.0;
      for (const double x : still) largest = std::max(largest, std::abs(x));
      for (int k = 0; k < kMoving; ++k) at[kJoints[k]] += Arm::Policy::kTryStep / largest * still[k];
    }
    return worst;
  }

  // One step; how far it goes in the direction that hardly matters, which for side 0 it does not.
  double step(double side, double* q) noexcept {
    const PoseError<Arm> at(q, aim);
    size = at.largest();
    find_still(at);
    double flow[kEquations], bend[kEquations], rest[kEquations];
    Vector ignored, across;
    for (int e = 0; e < kEquations; ++e) {
      flow[e] = bend[e] = 0.0;
      rest[e] = at.error[e];
      for (int k = 0; k < kMoving; ++k) flow[e] += at.slope[e][kJoints[k]] * still[k];
    }
    const Others others(*this, at, flow);
    others.take_away(rest, across);
    double x = 0.0;
    if (side != 0.0) {
      double there[Arm::kDof];
      std::copy_n(q, Arm::kDof, there);
      for (int k = 0; k < kMoving; ++k) there[kJoints[k]] += kAlong * still[k];
      const PoseError<Arm> beyond(there, aim);
      for (int e = 0; e < kEquations; ++e)
        for (int k = 0; k < kMoving; ++k)
          bend[e] += (beyond.slope[e][kJoints[k]] - at.slope[e][kJoints[k]]) * still[k] / kAlong;
      others.take_away(bend, ignored);
      others.take_away(flow, ignored);
      x = root(side, bend, flow, rest);
    }
    for (int k = 0; k < kMoving; ++k)
      q[kJoints[k]] += std::min(std::max(across[k], -kFar), kFar) + x * still[k];
    return x;
  }

 private:
  static constexpr double kAlong = 1e-4, kClose = 1e-9, kFar = 0.3;
  static constexpr int kSteps = 8;

  // The root of s x + k x^2 / 2 = e on this side of the least error, along the direction that the others leave.
  static double root(double side, const double (&bend)[kEquations], const double (&flow)[kEquations],
                     const double (&rest)[kEquations]) noexcept {
    double k = 0.0, s = 0.0, e = 0.0;
    for (int i = 0; i < kEquations; ++i) {
      k += bend[i] * bend[i];
      s += bend[i] * flow[i];
      e += bend[i] * rest[i];
    }
    if (!(k > 0.0)) return 0.0;
    const double w = std::sqrt(std::max(s * s + 2.0 * k * e, 0.0)), p = s + std::copysign(w, s);
    const double x = (s > 0.0) == (side > 0.0) && p != 0.0 ? 2.0 * e / p : -p / k;
    return std::min(std::max(x, -kFar), kFar);
  }

  // The directions across the still one.
  struct Others {
    double V[kEquations][kMoving], A[kMoving][kMoving];

    Others(const FoldPair& fold, const PoseError<Arm>& at, const double (&flow)[kEquations]) noexcept {
      for (int e = 0; e < kEquations; ++e)
        for (int k = 0; k < kMoving; ++k) V[e][k] = at.slope[e][kJoints[k]] - flow[e] * fold.still[k];
      for (int a = 0; a < kMoving; ++a)
        for (int b = 0; b <= a; ++b) {
          A[a][b] = fold.still[a] * fold.still[b] + (a == b ? Arm::Policy::kLeastDamping : 0.0);
          for (int e = 0; e < kEquations; ++e) A[a][b] += V[e][a] * V[e][b];
        }
      factor(A);
    }

    // Takes from z what they can do, by y.
    void take_away(double (&z)[kEquations], Vector& y) const noexcept {
      for (int k = 0; k < kMoving; ++k) {
        y[k] = 0.0;
        for (int e = 0; e < kEquations; ++e) y[k] += V[e][k] * z[e];
      }
      substitute(A, y);
      for (int e = 0; e < kEquations; ++e)
        for (int k = 0; k < kMoving; ++k) z[e] -= V[e][k] * y[k];
    }
  };

  // By inverse iteration, from what it was, which keeps its sense.
  void find_still(const PoseError<Arm>& at) noexcept {
    double N[kMoving][kMoving];
    for (int a = 0; a < kMoving; ++a)
      for (int b = 0; b <= a; ++b) {
        N[a][b] = a == b ? Arm::Policy::kLeastDamping : 0.0;
        for (int e = 0; e < kEquations; ++e) N[a][b] += at.slope[e][kJoints[a]] * at.slope[e][kJoints[b]];
      }
    factor(N);
    for (int i = 0; i < 4; ++i) {
      substitute(N, still);
      double square = 0.0;
      for (const double x : still) square += x * x;
      for (double& x : still) x /= std::sqrt(square);
    }
  }
};

}  // namespace ikgen_runtime
