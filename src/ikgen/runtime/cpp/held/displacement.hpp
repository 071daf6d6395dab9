#pragma once

#include <Eigen/Geometry>

namespace ikgen_runtime {

struct Displacement {
  double R[9], p[3];  // columns first
};

// The pose of a tool that is moved in its own frame.
inline Eigen::Isometry3d displaced(const Eigen::Isometry3d& pose, const Displacement& motion) noexcept {
  Eigen::Isometry3d out = pose;
  out.translation() += pose.linear() * Eigen::Map<const Eigen::Vector3d>(motion.p);
  out.linear() = pose.linear() * Eigen::Map<const Eigen::Matrix3d>(motion.R);
  return out;
}

}  // namespace ikgen_runtime
