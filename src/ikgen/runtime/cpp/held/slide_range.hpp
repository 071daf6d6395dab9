// Where on a slide an arm has to be for a pose: of a long travel no more is searched.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "arm/motion_chain.hpp"
#include "arrays/constants.hpp"

namespace ikgen_runtime {

// Arm: as for MotionChain; kLower, kUpper; Task.
template <class Arm> struct SlideRange {
  static constexpr int kCount = MotionChain<Arm>::kCount;
  static constexpr double kAcross = 1e-9;  // cosine of slides at a right angle

  double low = -kInfinity, high = kInfinity;

  // The values of a joint beyond which the arm's lengths keep its tip from the position p of a pose: of a slide that
  // nothing turns; else all.
  SlideRange(const double* p, int joint) noexcept {
    int first = 0, own = kCount;
    while (first < kCount && !Arm::kMotions[first].revolute) ++first;
    for (int i = kCount - 1; i >= 0; --i) {
      if (Arm::kMotions[i].joint != joint) continue;
      if (i >= first) return;
      own = i;
    }
    if (!Arm::Task::kPosition || own == kCount) return;
    double axes[kCount][3], along[3];
    const Frame last = directions(first, axes);
    std::copy_n(axes[own], 3, along);
    double slope = 0.0, least = dot(along, last.p), most = least;
    for (int i = 0; i < kCount; ++i) {
      const Motion& motion = Arm::kMotions[i];
      double a = motion.offset, b = motion.offset;
      if (motion.joint != joint) {
        a += motion.scale * Arm::kLower.data()[motion.joint];
        b += motion.scale * Arm::kUpper.data()[motion.joint];
      }
      if (i >= first) {
        const auto& F = Arm::kFrames[i + 1];
        double remote = std::sqrt(F[0][3] * F[0][3] + F[1][3] * F[1][3] + F[2][3] * F[2][3]);
        if (!motion.revolute) remote += std::max(std::abs(a), std::abs(b));
        least -= remote;
        most += remote;
        continue;
      }
      const double share = dot(along, axes[i]);
      if (std::abs(share) <= kAcross) continue;
      if (motion.joint == joint) slope += share * motion.scale;
      least += std::min(share * a, share * b);
      most += std::max(share * a, share * b);
    }
    if (std::abs(slope) < kAcross) return;
    low = (dot(along, p) - most) / slope;
    high = (dot(along, p) - least) / slope;
    if (slope < 0.0) std::swap(low, high);
  }

 private:
  static double dot(const double* a, const double* b) noexcept { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

  // Of the slides before the first joint that turns; the frame in front of that, all of them at 0.
  static Frame directions(int first, double (&axes)[kCount][3]) noexcept {
    Frame T = MotionChain<Arm>::first();
    for (int i = 0; i < first; ++i) {
      const auto& F = Arm::kFrames[i + 1];
      for (int r = 0; r < 3; ++r) {
        const double x = T.R[r][0], y = T.R[r][1], z = T.R[r][2];
        axes[i][r] = z;
        T.p[r] += x * F[0][3] + y * F[1][3] + z * F[2][3];
        for (int k = 0; k < 3; ++k) T.R[r][k] = x * F[0][k] + y * F[1][k] + z * F[2][k];
      }
    }
    return T;
  }
};

}  // namespace ikgen_runtime
