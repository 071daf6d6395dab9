// Solves one pose and checks the answers by forward kinematics.
#include <cstdio>

#include "arm_ik.hpp"

int main() {
  arm_ik::Joints q;
  q << 0.3, -0.8, 0.9, 0.4, 0.7, -0.2;
  const Eigen::Isometry3d pose = arm_ik::forward(q);
  const arm_ik::Solutions solutions = arm_ik::solve(pose);
  for (int i = 0; i < solutions.count; ++i) {
    const arm_ik::Joints& row = solutions.q[static_cast<std::size_t>(i)];
    std::printf("solution %d:", i);
    for (int j = 0; j < arm_ik::kDof; ++j) std::printf(" %8.4f", row[j]);
    std::printf("\n");
    if (!arm_ik::forward(row).isApprox(pose, 1e-9)) return 1;
  }
  return solutions.status == arm_ik::Status::Ok && solutions.count > 0 ? 0 : 1;
}
