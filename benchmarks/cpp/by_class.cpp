// Times an emitted header beside the hand-written baseline of ortho_parallel.hpp, in turns.
//
// Compile with -DIKGEN_HEADER='"x_ik.hpp"' -DIKGEN_NAMESPACE=x_ik -DIKGEN_FREE=0, or 1 for a header with held joints.
// Prints: ns per solve, ns per pose of solve_batch, ns per pose of the baseline, the median over the rounds of the
// ratio of the first to the last, the largest error of a pose by the baseline's nearest row, mean rows of the header.

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <vector>

#include "ortho_parallel.hpp"
#include "reachable.hpp"

namespace {

constexpr double kEnough = 1e9;  // ns

// Of the processor: another process that takes it meanwhile hardly ever does so during the baseline, which is short.
template <class F> double time_of(const F& run) {
  const std::clock_t start = std::clock();
  run();
  return 1e9 / CLOCKS_PER_SEC * static_cast<double>(std::clock() - start) / static_cast<double>(kPoses);
}

std::vector<Eigen::Isometry3d> baseline_poses() {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> angle(-2.0, 2.0);
  std::vector<Eigen::Isometry3d> poses;
  for (std::size_t n = 0; n < kPoses; ++n) {
    ortho_parallel::Row q;
    for (double& x : q) x = angle(random);
    poses.push_back(ortho_parallel::forward(q));
  }
  return poses;
}

// The baseline must be right to be one: at every pose its best row closes.
double baseline_error(const std::vector<Eigen::Isometry3d>& poses) {
  double worst = 0.0;
  for (const Eigen::Isometry3d& pose : poses) {
    double best = 1e300;
    for (const auto& row : ortho_parallel::inverse(pose)) {
      const double error = (ortho_parallel::forward(row).matrix() - pose.matrix()).cwiseAbs().maxCoeff();
      if (error < best) best = error;
    }
    worst = std::max(worst, best);
  }
  return worst;
}

}  // namespace

int main() {
  const std::vector<Eigen::Isometry3d> poses = reachable_poses(), others = baseline_poses();
  std::vector<ik::Solutions> out(kPoses);
  ik::Options options;
  options.limits = false;
  double single = 1e300, batch = 1e300, baseline = 1e300, rows = 0.0, total = 0.0;
  std::vector<double> ratios;
  for (int round = 0; round < kRounds && (round < 5 || total < kEnough); ++round) {
    rows = 0.0;
    const double mine = time_of([&] {
      for (const Eigen::Isometry3d& pose : poses) {
        const ik::Solutions found = ik::solve(pose, options);
        asm volatile("" : : "g"(&found) : "memory");  // all of it is wanted
        rows += found.count;
      }
    });
    const double theirs = time_of([&] {
      for (const Eigen::Isometry3d& pose : others) {
        const auto found = ortho_parallel::inverse(pose);
        asm volatile("" : : "g"(&found) : "memory");
      }
    });
    const double many =
        time_of([&] { ik::solve_batch(poses.data(), static_cast<std::ptrdiff_t>(kPoses), out.data(), options); });
    single = std::min(single, mine), baseline = std::min(baseline, theirs), batch = std::min(batch, many);
    total += (mine + many) * static_cast<double>(kPoses);
    ratios.push_back(mine / theirs);
  }
  std::sort(ratios.begin(), ratios.end());
  std::printf("%.1f %.1f %.1f %.4f %.2e %.2f\n", single, batch, baseline, ratios[ratios.size() / 2],
              baseline_error(others), rows / static_cast<double>(kPoses));
  return 0;
}
