#pragma once

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "arrays/constants.hpp"
#include "arguments/unit_columns.hpp"

namespace ikgen_runtime {

// What a task reads of a pose. Noise of its rotation is taken off first. Arm: Columns, its UnitColumns; kRead, the
// entries that count; kWholePose; Policy; Status.
template <class Arm> struct PoseReading {
  using Columns = typename Arm::Columns;
  using Policy = typename Arm::Policy;

  // Whether all that is read is near enough and free of noise, but for round-off.
  [[gnu::always_inline]] static bool exact(const Eigen::Isometry3d& pose) noexcept {
    return good(pose.matrix().data(), Policy::kOrthonormal * Policy::kOrthonormal, 1.0);
  }

  // Takes the noise off, if there is any; false where there is more than noise, or the position is beyond all reach.
  static bool clean(Eigen::Isometry3d& pose) noexcept {
    double* t = pose.matrix().data();
    constexpr double most = 1.0 + Policy::kPoseTolerance;
    if (!good(t, Columns::level(t, Policy::kLevel) ? 1.0 : Columns::most_defect(Policy::kPoseTolerance), most))
      return Columns::tilted(t) && good(t, 1.0, most);
    if (exact(pose)) return true;
    Columns::clean(t);
    for (const auto [row, column] : Arm::kRead)
      if (single(column)) t[4 * column + row] = std::min(std::max(t[4 * column + row], -1.0), 1.0);
    return true;
  }

  // Whether a pose can be read, `clean` then without noise; an answer to one that cannot says why.
  template <class Out> static bool readable(const Eigen::Isometry3d& pose, Eigen::Isometry3d& clean, Out& out) noexcept {
    clean = pose;
    if (PoseReading::clean(clean)) return true;
    out.count = 0;
    out.status = refused(pose);
    return false;
  }

  // The status of what is not clean.
  static typename Arm::Status refused(Eigen::Isometry3d pose) noexcept {
    for (double* x = pose.matrix().data() + 12; x < pose.matrix().data() + 15; ++x)
      if (std::abs(*x) < kInfinity) *x = 0.0;
    return clean(pose) ? Arm::Status::Unreachable : Arm::Status::Invalid;
  }

 private:
  // Whether an entry of the column is read for itself: a cosine.
  static constexpr bool single(int column) noexcept { return column < 3 && !Columns::has(column); }

  // `largest`: the size up to which an entry may be a cosine.
  [[gnu::always_inline]] static bool good(const double* t, double most, double largest) noexcept {
    double others = 0.0;
    for (const auto [row, column] : Arm::kRead)
      others += Columns::has(column) ? 0.0 : t[4 * column + row] * t[4 * column + row];
    for (const auto [row, column] : Arm::kRead)
      if (single(column) && !(std::abs(t[4 * column + row]) <= largest)) return false;
    if (Arm::kWholePose && !(t[3] == 0.0 && t[7] == 0.0 && t[11] == 0.0 && t[15] == 1.0)) return false;
    const bool reached = others <= kFarthest * kFarthest, unit = Columns::defect(t) <= most;
    return (reached & unit) && Columns::proper(t);  // one branch of both
  }
};

}  // namespace ikgen_runtime
