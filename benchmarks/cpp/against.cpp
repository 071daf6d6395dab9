// Times an emitted header against another solver's C++ source, in turns and on the same poses.
//
// Compile with -DIKGEN_HEADER='"x_ik.hpp"' -DIKGEN_NAMESPACE=x_ik, -DIKGEN_FREE=0, or 1 for a header with
// held joints, and one of
//   -DPEER_OPW -I<folder of opw_kinematics/opw_kinematics.h> -DPEER_PARAMETERS='{a1, a2, b, c1, c2, c3, c4,
//     {offsets}, {signs}}'
//   -DPEER_IKFAST='"ikfast_x.cpp"' -I<its folder, with ikfast.h>; held joints as its free parameters.
// Prints: ns a pose of each, the median of the ratio over the rounds, and mean rows of each.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "reachable.hpp"

namespace {

#ifdef PEER_OPW
}
#include <opw_kinematics/opw_kinematics.h>
namespace {
// Rows with a NaN are no solutions.
int solve_with_peer(const Eigen::Isometry3d& pose) {
  static const opw_kinematics::Parameters<double> parameters = [] {
    opw_kinematics::Parameters<double> p;
    const struct {
      double a1, a2, b, c1, c2, c3, c4;
      std::array<double, 6> offsets;
      std::array<signed char, 6> signs;
    } given = PEER_PARAMETERS;
    p.a1 = given.a1, p.a2 = given.a2, p.b = given.b;
    p.c1 = given.c1, p.c2 = given.c2, p.c3 = given.c3, p.c4 = given.c4;
    for (std::size_t j = 0; j < 6; ++j) {
      p.offsets[j] = given.offsets[j];
      p.sign_corrections[j] = given.signs[j];
    }
    return p;
  }();
  const auto rows = opw_kinematics::inverse(parameters, pose);
  asm volatile("" : : "g"(&rows) : "memory");  // all of it is wanted
  int count = 0;
  for (const auto& row : rows) {
    double sum = 0.0;
    for (const double q : row) sum += q;
    count += sum - sum == 0.0 ? 1 : 0;
  }
  return count;
}

std::vector<Eigen::Isometry3d> poses_of_peer(const std::vector<Eigen::Isometry3d>& poses) { return poses; }
#endif

#ifdef PEER_IKFAST
}
#define IKFAST_HAS_LIBRARY
#define IKFAST_NO_MAIN
#include PEER_IKFAST
namespace {
// Position and rotation by rows; held joints are at the header's defaults.
int solve_with_peer(const Eigen::Isometry3d& pose) {
  const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> rotation = pose.linear();
  const Eigen::Vector3d position = pose.translation();
  const auto held = ik::Options().free;
  ikfast::IkSolutionList<IkReal> found;
  ComputeIk(position.data(), rotation.data(), held.empty() ? nullptr : held.data(), found);
  std::vector<IkReal> row(static_cast<std::size_t>(GetNumJoints())), given;
  for (std::size_t i = 0; i < found.GetNumSolutions(); ++i) {
    const auto& solution = found.GetSolution(i);
    given.assign(solution.GetFree().size(), 0.0);
    solution.GetSolution(row.data(), given.empty() ? nullptr : given.data());
  }
  return static_cast<int>(found.GetNumSolutions());
}

Eigen::Isometry3d forward_of_peer(const ik::Joints& q) {
  Eigen::Matrix<double, 3, 3, Eigen::RowMajor> rotation;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  ComputeFk(q.data(), pose.translation().data(), rotation.data());
  pose.linear() = rotation;
  return pose;
}

// Its file may have been made for another link at the tip: the constant transform between the two.
std::vector<Eigen::Isometry3d> poses_of_peer(std::vector<Eigen::Isometry3d> poses) {
  const ik::Joints zero = ik::Joints::Zero(), one = ik::Joints::Constant(0.7);
  const Eigen::Isometry3d tip = ik::forward(zero).inverse() * forward_of_peer(zero);
  if (!(ik::forward(one) * tip).isApprox(forward_of_peer(one), 1e-6)) {
    std::fprintf(stderr, "the peer's geometry of the arm differs\n");
    std::exit(2);
  }
  for (Eigen::Isometry3d& pose : poses) pose = pose * tip;
  return poses;
}
#endif

// ns a pose, and rows a pose.
template <class F> std::array<double, 2> time_of(const std::vector<Eigen::Isometry3d>& poses, const F& solve) {
  int rows = 0;
  const auto start = std::chrono::steady_clock::now();
  for (const Eigen::Isometry3d& pose : poses) rows += solve(pose);
  const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - start;
  return {spent.count() / kPoses, static_cast<double>(rows) / kPoses};
}

}  // namespace

int main() {
  const std::vector<Eigen::Isometry3d> poses = reachable_poses(), its = poses_of_peer(poses);
  ik::Options options;
  options.limits = false;
  const auto ours = [&](const Eigen::Isometry3d& pose) {
    const ik::Solutions found = ik::solve(pose, options);
    asm volatile("" : : "g"(&found) : "memory");
    return found.count;
  };
  double mine = 1e300, theirs = 1e300, my_rows = 0.0, their_rows = 0.0;
  std::vector<double> ratios;
  for (int round = 0; round < kRounds; ++round) {
    const auto a = time_of(poses, ours), b = time_of(its, solve_with_peer);
    mine = std::min(mine, a[0]), theirs = std::min(theirs, b[0]);
    my_rows = a[1], their_rows = b[1];
    ratios.push_back(a[0] / b[0]);
  }
  std::sort(ratios.begin(), ratios.end());
  std::printf("%.1f %.1f %.3f %.2f %.2f\n", mine, theirs, ratios[ratios.size() / 2], my_rows, their_rows);
  return 0;
}
