// Newton's method where several directions hardly move the pose.
#pragma once

#include <algorithm>
#include <cmath>

#include "arm/pose_error.hpp"
#include "arrays/constants.hpp"

namespace ikgen_runtime {

// Undamped steps on the file's own chain: beside a continuum the error along a curve is as small as its slope, whose square
// the normal equations of damped steps lose. Arm: as for PoseError, and its Policy.
template <class Arm> struct FlatSteps {
  using Aim = HeldAim<Arm>;
  using Policy = typename Arm::Policy;

  // Whether they lead from a row to the aim; q: where they come nearest to it.
  [[gnu::cold, gnu::noinline]] static bool refine_from(const double* start, double* q, const Aim& aim) noexcept {
    double trial[Arm::kDof], best = kInfinity;
    std::copy_n(start, Arm::kDof, trial);
    for (int i = 0; i < kFlatSteps && best > kFlatEnough; ++i) {
      PoseError<Arm> at(trial, aim);
      if (at.largest() < best) {
        best = at.largest();
        std::copy_n(trial, Arm::kDof, q);
      }
      step(at, trial);
    }
    return best < Policy::kArrived;
  }

 private:
  static constexpr int kFlatSteps = 60;
  static constexpr int kSweeps = 12, kCount = PoseError<Arm>::kCount;
  static constexpr double kFlatLongest = 0.3;  // rad or m: along one direction
  static constexpr double kFlatEnough = 1e-14;
  static constexpr double kAcross = 1e-15;  // cosine of directions that are at right angles

  // Along each singular direction as far as it is to no error there, of rotations that leave the slope's columns at right
  // angles (Hestenes 1958).
  static void step(PoseError<Arm>& at, double* q) noexcept {
    double turned[Arm::kDof][Arm::kDof] = {};
    for (int j = 0; j < Arm::kDof; ++j) turned[j][j] = 1.0;
    bool going = true;
    for (int sweep = 0; sweep < kSweeps && going; ++sweep) {
      going = false;
      for (int a = 0; a < Arm::kDof; ++a)
        for (int b = a + 1; b < Arm::kDof; ++b) going = part(at.slope, turned, a, b) || going;
    }
    for (int j = 0; j < Arm::kDof; ++j) {
      double square = 0.0, along = 0.0;
      for (int r = 0; r < kCount; ++r) {
        square += at.slope[r][j] * at.slope[r][j];
        along += at.slope[r][j] * at.error[r];
      }
      if (!(square > 0.0)) continue;
      along = std::clamp(along / square, -kFlatLongest, kFlatLongest);
      for (int i = 0; i < Arm::kDof; ++i) q[i] += along * turned[i][j];
    }
  }

  // Turns two columns to right angles; whether they were not.
  static bool part(double (&slope)[kCount][Arm::kDof], double (&turned)[Arm::kDof][Arm::kDof], int a, int b) noexcept {
    double aa = 0.0, bb = 0.0, ab = 0.0;
    for (const auto& row : slope) {
      aa += row[a] * row[a];
      bb += row[b] * row[b];
      ab += row[a] * row[b];
    }
    if (!(std::abs(ab) > kAcross * std::sqrt(aa * bb))) return false;
    const double half = 0.5 * (bb - aa) / ab;
    const double t = std::copysign(1.0, half) / (std::abs(half) + std::sqrt(1.0 + half * half));
    const double c = 1.0 / std::sqrt(1.0 + t * t), s = c * t;
    const auto turn = [&](double* row) noexcept {
      const double x = row[a], y = row[b];
      row[a] = c * x - s * y;
      row[b] = s * x + c * y;
    };
    for (auto& row : slope) turn(row);
    for (auto& row : turned) turn(row);
    return true;
  }
};

}  // namespace ikgen_runtime
