#pragma once

#include <Eigen/Geometry>

#include "unit_columns.hpp"

namespace ikgen_runtime {

// What a task reads of a pose. Noise of its rotation is taken off first. Arm: Columns, its UnitColumns; kRead, the
// entries that count; kWholePose; Policy.
template <class Arm> struct PoseReading {
  using Columns = typename Arm::Columns;
  using Policy = typename Arm::Policy;

  // Whether all that is read is finite and free of noise, but for round-off.
  static bool exact(const Eigen::Isometry3d& pose) noexcept {
    return good(pose.matrix().data(), Policy::kOrthonormal * Policy::kOrthonormal);
  }

  // Takes the noise off; false where there is more than noise.
  static bool clean(Eigen::Isometry3d& pose) noexcept {
    double* t = pose.matrix().data();
    if (good(t, Columns::most_defect(Policy::kPoseTolerance))) {
      Columns::clean(t);
      return true;
    }
    return Columns::tilted(t) && good(t, 1.0);
  }

 private:
  static bool good(const double* t, double most) noexcept {
    double defect = Columns::defect(t);
    for (const auto [row, column] : Arm::kRead) defect += 0.0 * t[4 * column + row];
    if (Arm::kWholePose && !(t[3] == 0.0 && t[7] == 0.0 && t[11] == 0.0 && t[15] == 1.0)) return false;
    return defect <= most && Columns::proper(t);
  }
};

}  // namespace ikgen_runtime
