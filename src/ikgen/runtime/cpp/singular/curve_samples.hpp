// Samples of a curve along which the other joints take the pose's error away but for one direction.
#pragma once

#include "arrays/constants.hpp"
#include "singular/fold_pair.hpp"

namespace ikgen_runtime {

// Arm: as for FoldPair.
template <class Arm> struct CurveSamples {
  using Fold = FoldPair<Arm>;

  // A configuration of which one direction of the error is left, and how that grows along the still direction; whether
  // its corrections converged.
  struct Sample {
    double q[Arm::kDof], still[Fold::kMoving], out[Fold::kEquations], left, slope;
    bool on;
  };

  Fold fold;
  int samples = 1200;  // that are left to be taken

  static constexpr double kSmall = 4e-15;  // what is left at a solution, at most, by round-off

  explicit CurveSamples(const HeldAim<Arm>& goal) noexcept : fold(goal) {}

  static bool is_solution(const Sample& s) noexcept { return std::abs(s.left) < kSmall; }

  // On the curve beside a configuration; its still direction is found anew, or near the one that was found last.
  Sample at(const double* q, bool anew = true) noexcept {
    Sample s;
    std::copy_n(q, Arm::kDof, s.q);
    s.on = false;
    double before[Fold::kMoving] = {}, last = kInfinity;
    for (int i = 0; i < kCorrections && !s.on; ++i) {
      double across[Fold::kMoving];
      const double farthest = fold.correct(s.q, anew && i == 0, s.left, s.slope, across);
      const double bound = std::max(kNear, kShare * std::abs(s.left));
      s.on = kCurved * farthest * farthest < bound;
      if (s.on && !(farthest < bound)) fold.measure(s.q, s.left, s.slope);
      const bool leaps = !s.on && farthest > kSlow * last && leap(before, across, s.q);
      last = leaps ? kInfinity : farthest;
      std::copy_n(across, Fold::kMoving, before);
    }
    std::copy_n(fold.still, Fold::kMoving, s.still);
    std::copy_n(fold.out, Fold::kEquations, s.out);
    --samples;
    return s;
  }

  // Beside a sample.
  Sample at(const double* q, const Sample& from, bool anew = true) noexcept {
    std::copy_n(from.still, Fold::kMoving, fold.still);
    std::copy_n(from.out, Fold::kEquations, fold.out);
    return at(q, anew);
  }

  Sample part(const Sample& a, const Sample& b, double share) noexcept {
    double q[Arm::kDof];
    between(a, b, share, q);
    return at(q, a, false);
  }

  // The same sample of a curve that is followed the other way.
  static void turn_round(Sample& s) noexcept {
    s.left = -s.left;
    for (double& x : s.still) x = -x;
    for (double& x : s.out) x = -x;
  }

  static void take_chord(const Sample& a, const Sample& b, double* way) noexcept {
    for (int k = 0; k < Fold::kMoving; ++k) way[k] = b.q[Fold::kJoints[k]] - a.q[Fold::kJoints[k]];
  }

  // By the cubic through two configurations along their still directions (Hermite).
  static void between(const Sample& a, const Sample& b, double share, double* q) noexcept {
    double way[Fold::kMoving];
    take_chord(a, b, way);
    const double along = Fold::dot(way, a.still), beyond = Fold::dot(way, b.still);
    const double rest = 1.0 - share, first = share * rest * rest, last = -share * share * rest;
    std::copy_n(a.q, Arm::kDof, q);
    for (int k = 0; k < Fold::kMoving; ++k)
      q[Fold::kJoints[k]] += share * way[k] + first * (along * a.still[k] - way[k]) + last * (beyond * b.still[k] - way[k]);
  }

 private:
  static constexpr int kCorrections = 6;
  static constexpr double kNear = 1e-11;  // rad or m: how far off the curve slopes along it are the curve's
  static constexpr double kShare = 3e-2;  // of what is left: as little as that off the curve changes neither
  static constexpr double kCurved = 10.0;  // how far off it corrections leave it, over their squares (1 / rad or 1 / m)
  static constexpr double kSlow = 0.1, kSteady = 0.8;  // how fast corrections converge that are not left to themselves

  // Goes to where two corrections that converge slowly lead in the end (Aitken 1926), if they do.
  static bool leap(const double* before, const double* across, double* q) noexcept {
    const double ratio = Fold::dot(across, before) / Fold::dot(before, before);
    if (!(std::abs(ratio) < kSteady)) return false;
    for (int k = 0; k < Fold::kMoving; ++k) q[Fold::kJoints[k]] += ratio / (1.0 - ratio) * across[k];
    return true;
  }
};

}  // namespace ikgen_runtime
