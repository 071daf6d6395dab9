// What a task reads of a pose. Noise of its rotation is taken off first: the nearest orthonormal columns (Frobenius)
// count. A Reading has kMost, the largest defect of a pose; defect(t), the squared Frobenius norm of V^T V - 1 of the
// columns V that are read; proper(t), whether they can be a rotation's; clean(t), which puts the nearest in their
// place. t: the pose's matrix, columns first.
#pragma once

#include <Eigen/Geometry>

#include "pose_error.hpp"

namespace ikgen_runtime {

// Of columns with N entries, each off by the tolerance: |V^T V - 1| <= 2 |E| + |E|^2, E what they are off by.
template <class Policy, int N>
inline constexpr double kMostDefect =
    4.0 * N * Policy::kPoseTolerance * Policy::kPoseTolerance * (1.0 + 2.0 * N * Policy::kPoseTolerance);

// Arm: Reading; kRead, the entries that count; kWholePose; Policy.
template <class Arm> struct PoseReading {
  using Policy = typename Arm::Policy;
  using Reading = typename Arm::Reading;

  // Whether all that is read is finite and free of noise, but for round-off.
  static bool exact(const Eigen::Isometry3d& pose) noexcept {
    return good(pose.matrix().data(), Policy::kOrthonormal * Policy::kOrthonormal);
  }

  // Takes the noise off; false where there is more than noise.
  static bool clean(Eigen::Isometry3d& pose) noexcept {
    double* t = pose.matrix().data();
    if (!good(t, Reading::kMost)) return false;
    Reading::clean(t);
    return true;
  }

 private:
  static bool good(const double* t, double most) noexcept {
    double defect = Reading::defect(t);
    for (const Entry& entry : Arm::kRead) defect += 0.0 * t[4 * entry.column + entry.row];
    if (Arm::kWholePose && !(t[3] == 0.0 && t[7] == 0.0 && t[11] == 0.0 && t[15] == 1.0)) return false;
    return defect <= most && Reading::proper(t);
  }
};

// Entries that each count for themselves.
struct EntriesReading {
  static constexpr double kMost = 0.0;
  static double defect(const double*) noexcept { return 0.0; }
  static bool proper(const double*) noexcept { return true; }
  static void clean(double*) noexcept {}
};

}  // namespace ikgen_runtime
