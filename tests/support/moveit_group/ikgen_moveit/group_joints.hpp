// An arm and a planning group written by hand: two joints about z and a third that follows the second, in one plane.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>
#include <Eigen/Geometry>
namespace ik {
using Joints = Eigen::Matrix<double, 2, 1>;
inline constexpr int kDof = 2, kFree = 2;
inline constexpr const char *kBaseLink = "base", *kTipLink = "tip";
inline constexpr const char* kTask = TASK;
inline constexpr std::array<double, 2> kLower = {-3.0, -1.0}, kUpper = {3.0, 2.0};
inline Eigen::Isometry3d turned(double angle, double x) {
  return Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) * Eigen::Translation3d(x, 0.0, 0.0) *
         Eigen::Isometry3d::Identity();
}
inline Eigen::Isometry3d forward(const Joints& q) {
  return turned(q[0], 1.0) * turned(q[1], 1.0) * turned(-2.0 * q[1] + 0.1, 0.5);
}
struct Options {
  const Joints* seed = nullptr;
  std::array<double, 2> free = {9.0, 9.0};
  bool hold_seed = true;
};
// Rows about the position; some tell what was asked.
inline std::vector<Joints> solve(const Eigen::Isometry3d& pose, const Options& options) {
  const double x = pose(0, 3), y = pose(1, 3);
  const double held = options.hold_seed ? 100.0 : options.free[0] + 0.001 * options.free[1];
  const double seed = (*options.seed)[0];
  return {{x, 1.0}, {x + 1.0, held}, {y, 1.5}, {x, 1.25}, {x + 6.0, -1.0}, {x, 1.0 + 4.0 * (seed - x)}};
}
}  // namespace ik
namespace ikgen_moveit {
using ik::Joints;
struct GroupJoint {
  const char* name;
  int joint;
  double factor, offset;
};
inline constexpr std::array<double, 2> kPeriod = {6.28318530717958647692, 0.0};
inline constexpr std::array<GroupJoint, 3> kGroup = {
    {{"first", 0, 1.0, 0.0}, {"second", 1, 1.0, 0.0}, {"third", 1, -2.0, 0.1}}};
inline std::vector<std::string> group_names() { return {"first", "second", "third"}; }
inline std::vector<double> group_values(const Joints& q) { return {q[0], q[1], -2.0 * q[1] + 0.1}; }
}  // namespace ikgen_moveit
