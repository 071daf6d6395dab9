// Time of solve and solve_batch of one emitted header, on reachable random poses.
//
// Compile with -DIKGEN_HEADER='"x_ik.hpp"' -DIKGEN_NAMESPACE=x_ik -DIKGEN_LIMITS=true, -DIKGEN_FREE=0, or 1
// for a header with held joints. Prints: ns per solve, ns per pose of solve_batch, mean number of solutions, ns per
// pose of a long span in one thread and split among all, how many those are.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>
#include <vector>

#include "reachable.hpp"

namespace {

constexpr double kEnough = 5e8, kLongSpan = 1e7;  // ns

// Best of the rounds, in ns a round; slow headers take fewer of them.
template <class F> double time_of(const F& run) {
  double best = 1e300, total = 0.0;
  for (int round = 0; round < kRounds && (round < 3 || total < kEnough); ++round) {
    const auto start = std::chrono::steady_clock::now();
    run();
    const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - start;
    best = std::min(best, spent.count());
    total += spent.count();
  }
  return best;
}

// ns a pose of a long span that the caller splits among threads; `single` is that of one `solve`.
double time_in_threads(const std::vector<Eigen::Isometry3d>& poses, const ik::Options& options, std::size_t threads,
                       double single) {
  const std::size_t part =  // starting a thread costs some 10 us
      std::clamp<std::size_t>(static_cast<std::size_t>(kLongSpan / single), kPoses, 20 * kPoses);
  std::vector<Eigen::Isometry3d> many;
  for (std::size_t n = 0; n < threads * part; ++n) many.push_back(poses[n % kPoses]);
  std::vector<ik::Solutions> answers(many.size());
  const auto solve_part = [&](std::size_t t) {
    ik::solve_batch(&many[t * part], static_cast<std::ptrdiff_t>(part), &answers[t * part], options);
  };
  return time_of([&] {
           std::vector<std::thread> workers;
           for (std::size_t t = 0; t < threads; ++t) workers.emplace_back(solve_part, t);
           for (std::thread& worker : workers) worker.join();
         }) /
         static_cast<double>(many.size());
}

}  // namespace

int main() {
  const std::vector<Eigen::Isometry3d> poses = reachable_poses();
  std::vector<ik::Solutions> out(kPoses);
  ik::Options options;
  options.limits = IKGEN_LIMITS;
  double rows = 0.0;
  const auto a_pose = [](double round) { return round / static_cast<double>(kPoses); };
  const double single = a_pose(time_of([&] {
    rows = 0.0;
    for (const Eigen::Isometry3d& pose : poses) {
      const ik::Solutions found = ik::solve(pose, options);
      asm volatile("" : : "g"(&found) : "memory");  // all of it is wanted
      rows += found.count;
    }
  }));
  const double batch = a_pose(
      time_of([&] { ik::solve_batch(poses.data(), static_cast<std::ptrdiff_t>(kPoses), out.data(), options); }));
  const std::size_t threads = std::max(1u, std::thread::hardware_concurrency());
  std::printf("%.1f %.1f %.2f %.1f %.1f %zu\n", single, batch, rows / static_cast<double>(kPoses),
              time_in_threads(poses, options, 1, single), time_in_threads(poses, options, threads, single), threads);
  return 0;
}
