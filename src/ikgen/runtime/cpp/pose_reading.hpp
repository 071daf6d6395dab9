// What a task reads of a pose. Noise of its rotation is taken off first: the nearest rotation (Frobenius) counts, the
// unit vector of a direction or a heading. A Reading has kEntries, how many of its entries may be off by the
// tolerance; error(t), 0 where there is nothing to take off; clean(t), which takes it off and returns the square of how
// far entries were moved. t: the pose's matrix, columns first.
#pragma once

#include <Eigen/Geometry>

#include "pose_error.hpp"

namespace ikgen_runtime {

// Arm: Reading; kRead, the entries that count; kWholePose; Policy.
template <class Arm> struct PoseReading {
  using Policy = typename Arm::Policy;
  using Reading = typename Arm::Reading;

  // Whether all that is read is finite and free of noise, but for round-off.
  static bool exact(const Eigen::Isometry3d& pose) noexcept {
    const double* t = pose.matrix().data();
    double error = Reading::error(t);
    for (const Entry& entry : Arm::kRead) error += 0.0 * t[4 * entry.column + entry.row];
    if (Arm::kWholePose && !(t[3] == 0.0 && t[7] == 0.0 && t[11] == 0.0 && t[15] == 1.0)) return false;
    return error <= Policy::kRoundOff;
  }

  // Takes the noise off; false where that does not make a pose of it.
  static bool clean(Eigen::Isometry3d& pose) noexcept {
    constexpr double most = Reading::kEntries * Policy::kPoseTolerance * Policy::kPoseTolerance;
    return Reading::clean(pose.matrix().data()) <= most && exact(pose);
  }
};

// Entries that each count for themselves.
struct EntriesReading {
  static constexpr int kEntries = 1;
  static double error(const double*) noexcept { return 0.0; }
  static double clean(double*) noexcept { return 0.0; }
};

}  // namespace ikgen_runtime
