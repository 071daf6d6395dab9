// Poses that the arm of IKGEN_HEADER reaches, held joints at their defaults; what all programs here measure on.
#pragma once

#include <algorithm>
#include <cstddef>
#include <random>
#include <vector>

#include IKGEN_HEADER

namespace ik = IKGEN_NAMESPACE;

inline constexpr std::size_t kPoses = 1000;
inline constexpr int kRounds = 60;

inline std::vector<Eigen::Isometry3d> reachable_poses() {
  std::mt19937_64 random(7);
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t n = 0; n < kPoses; ++n) {
    ik::Joints q;
    for (int j = 0; j < ik::kDof; ++j) {
      const auto i = static_cast<std::size_t>(j);
      const double low = std::max(ik::kLower[i], -3.1), high = std::min(ik::kUpper[i], 3.1);
      q[j] = std::uniform_real_distribution<double>(low, high)(random);
    }
#if IKGEN_FREE
    for (std::size_t k = 0; k < ik::kFreeJoints.size(); ++k) q[ik::kFreeJoints[k]] = ik::Options().free[k];
#endif
    poses.push_back(ik::forward(q));
  }
  return poses;
}
