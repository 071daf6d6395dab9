// Rows of a pose at one value of the held joint, lane by lane.
#pragma once

#include <algorithm>
#include <cmath>

#include "displacement.hpp"
#include "fold_rows.hpp"
#include "joint_range.hpp"
#include "newton_refinement.hpp"
#include "solution_rows.hpp"

namespace ikgen_runtime {

// The difference of two angles within a turn of each other, on the shortest way.
inline double shortest(double gap) noexcept {
  return gap > kPi ? gap - kTurn : gap < -kPi ? gap + kTurn : gap;
}

// Limits of the joints that move: index, middle and half of the range. Arm: as for SolutionRows.
template <class Arm> struct JointBounds {
  int count = 0;
  int joint[Arm::kDof];
  double middle[Arm::kDof], half[Arm::kDof];

  explicit JointBounds(bool limits) noexcept {
    for (int j = 0; j < Arm::kDof && limits; ++j) {
      double low = Arm::kLower.data()[j], high = Arm::kUpper.data()[j];
      const bool bounded = Arm::kRevolute[j] ? high - low < kTurn : low > -kInfinity || high < kInfinity;
      if (Arm::kHeld[j] || !bounded) continue;
      low = std::max(low, -1e6);
      high = std::min(high, 1e6);
      joint[count] = j;
      middle[count] = 0.5 * (low + high);
      if (Arm::kRevolute[j]) middle[count] -= kTurn * std::nearbyint(middle[count] / kTurn);
      half[count++] = 0.5 * (high - low);
    }
  }

  // A joint's value from the middle of its range.
  double offset(int i, double q) const noexcept {
    return Arm::kRevolute[joint[i]] ? shortest(q - middle[i]) : q - middle[i];
  }
};

// Arm: as for CarefulSolve; kFolds, how many margins its closed form has.
template <class Arm> struct HeldSample {
  static constexpr int kLanes = Arm::kMaxSolutions * (1 + Arm::kBesides), kMargins = Arm::kFolds > 0 ? Arm::kFolds : 1;
  double held = 0.0;
  double q[Arm::kDof][kLanes], off[kLanes], fold[kMargins][Arm::kMaxSolutions];
  bool real[kLanes];

  // Whether a row is real and inside the limits.
  bool inside(int lane) const noexcept { return real[lane] && off[lane] <= 0.0; }

  // The rows at a value; T: the pose as it is read.
  HeldSample(const Eigen::Isometry3d& T, double value, const JointBounds<Arm>& bounds) noexcept : held(value) {
    bool again = take(T, T, 0);
    if constexpr (Arm::kBesides > 0)
      for (int i = 0; i < Arm::kBesides; ++i) again = take(T, displaced(T, Arm::kBeside[i]), i + 1) || again;
    if (again) remove_repetitions();
    for (int l = 0; l < kLanes; ++l) off[l] = -kInfinity;
    for (int i = 0; i < bounds.count; ++i)
      for (int l = 0; l < kLanes; ++l)
        off[l] = std::max(off[l], std::abs(bounds.offset(i, q[bounds.joint[i]][l])) - bounds.half[i] - Arm::Policy::kLimitTolerance);
  }

  HeldSample() = default;

  void row(int lane, double* out) const noexcept {
    for (int j = 0; j < Arm::kDof; ++j) out[j] = q[j][lane];
  }

  // The change of a joint from one row to another.
  static double change(int j, const HeldSample& a, int i, const HeldSample& b, int k) noexcept {
    return between(j, a.q[j][i], b.q[j][k]);
  }

  // The largest change of a joint that moves, from one row to another.
  static double gap(const HeldSample& a, int i, const HeldSample& b, int k) noexcept {
    double most = 0.0;
    for (int j = 0; j < Arm::kDof; ++j)
      if (!Arm::kHeld[j]) most = std::max(most, std::abs(change(j, a, i, b, k)));
    return most;
  }
  double distance(int lane, const double* other) const noexcept {
    double most = 0.0;
    for (int j = 0; j < Arm::kDof; ++j)
      if (!Arm::kHeld[j]) most = std::max(most, std::abs(between(j, other[j], q[j][lane])));
    return most;
  }

  // The lane of the real row that is nearest to another; -1 without one.
  int nearest(const double* other) const noexcept {
    int best = -1;
    double least = kInfinity;
    for (int l = 0; l < kLanes; ++l) {
      const double here = real[l] ? distance(l, other) : kInfinity;
      if (here < least) {
        least = here;
        best = l;
      }
    }
    return best;
  }

 private:
  static double between(int j, double from, double to) noexcept {
    return Arm::kRevolute[j] ? shortest(to - from) : to - from;
  }

  // Takes the rows of the pose, or of one beside it, refined where that is needed; whether some may be equal.
  bool take(const Eigen::Isometry3d& T, const Eigen::Isometry3d& near, int part) noexcept {
    constexpr Range anywhere = {kUnbounded<Arm::kDof>.lower, kUnbounded<Arm::kDof>.upper};
    FoldRows<Arm::kDof, Arm::kMaxSolutions, Arm::kFolds> rows;
    Arm::branches(gather<1>(&near), typename Arm::Seed(), std::array<double, 1>{held}, anywhere, rows);
    bool again = part > 0;
    for (int r = 0; r < Arm::kMaxSolutions; ++r) {
      const int lane = Arm::kLaneOfRow[r], l = part * Arm::kMaxSolutions + r, bits = static_cast<int>(rows.flags[lane]);
      real[l] = (bits & kReal) != 0;
      for (int j = 0; j < Arm::kDof; ++j) q[j][l] = Arm::kHeld[j] ? held : rows.q[j][lane];
      if (part == 0)
        for (int k = 0; k < Arm::kFolds; ++k) fold[k][r] = rows.margin[k][lane];
      again = again || (real[l] && (bits & (kRough | kMeeting)) != 0);
      if (!real[l] || (bits & kRough) == 0 || Arm::kRefined) continue;
      double refined[Arm::kDof];
      row(l, refined);
      real[l] = NewtonRefinement<Arm>::refine(refined, T);
      for (int j = 0; j < Arm::kDof; ++j)
        q[j][l] = !Arm::kRevolute[j] || Arm::kHeld[j] ? refined[j] : refined[j] - kTurn * std::nearbyint(refined[j] / kTurn);
    }
    return again;
  }

  void remove_repetitions() noexcept {
    for (int l = 1; l < kLanes; ++l)
      for (int k = 0; k < l; ++k)
        if (real[l] && real[k] && gap(*this, l, *this, k) <= Arm::Policy::kCoincident) real[l] = false;
  }
};

}  // namespace ikgen_runtime
