// self_motion against a fine grid, search against random values of the held joints, and the time of both.
//
// Compile with -DIKGEN_HEADER='"x_ik.hpp"' -DIKGEN_NAMESPACE=x_ik and -DHELD=1, or 0 for a header that holds more
// joints than one: then only searches are compared. Arguments: poses, random values a pose, seed. Prints: median and
// largest time (us, thread's processor time) of self_motion and of search by each preference; intervals, runs of grid
// values wider than a step at which they differ from the rows of solve, ends that are off by more than 1e-6; searches,
// and how many of them are worse than the best random value; then what failed, one a line: 0 (missed), 1 (off) or 2 to 4
// (worse, by preference), the pose, the value or by how much.

#include <time.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

#include IKGEN_HEADER

namespace ik = IKGEN_NAMESPACE;

namespace {

constexpr double kPi = 3.141592653589793, kStep = 1e-3, kOff = 1e-6, kWorse = 1e-7, kEnough = 3e3, kExact = 1e-11;
constexpr int kRuns = 25;
using Random = std::mt19937_64;

double now_us() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e6 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_nsec);
}

// Least time of some runs.
template <class F> double time_of(const F& run) {
  double best = 1e300, total = 0.0;
  for (int i = 0; i < kRuns && (i < 2 || total < kEnough); ++i) {
    const double start = now_us();
    run();
    const double spent = now_us() - start;
    best = std::min(best, spent);
    total += spent;
  }
  return best;
}

bool turns(int j) {
  static const ik::Joints probe = ik::Joints::Constant(0.3);
  static const auto J = ik::jacobian(probe);
  return J.template bottomRows<3>().col(j).norm() > 1e-12;
}

bool bounded(int j) { return ik::kUpper[std::size_t(j)] - ik::kLower[std::size_t(j)] < 1e9; }

double low_of(int j) { return bounded(j) ? ik::kLower[std::size_t(j)] : turns(j) ? -kPi : -1.0; }
double high_of(int j) { return bounded(j) ? ik::kUpper[std::size_t(j)] : turns(j) ? kPi : 1.0; }

ik::Joints draw(Random& random) {
  ik::Joints q;
  for (int j = 0; j < ik::kDof; ++j) q[j] = std::uniform_real_distribution<double>(low_of(j), high_of(j))(random);
  return q;
}

using Free = std::array<double, ik::kFree>;

// What is held: joints, or the arm angle.
#if ARM_ANGLE
double lowest() { return -kPi; }
double highest() { return kPi; }
Free held_of(const ik::Joints& q) { return {ik::arm_angle(q)}; }
#else
double lowest() { return low_of(ik::kFreeJoints[0]); }
double highest() { return high_of(ik::kFreeJoints[0]); }
Free held_of(const ik::Joints& q) {
  Free free;
  for (int k = 0; k < ik::kFree; ++k) free[std::size_t(k)] = q[ik::kFreeJoints[std::size_t(k)]];
  return free;
}
#endif

ik::Solutions rows_at(const Eigen::Isometry3d& pose, const Free& free, const ik::Joints* seed) {
  ik::Options options;
  options.free = free;
  options.hold_seed = false;
  options.seed = seed;
  return ik::solve(pose, options);
}

double least_singular_value(const ik::Joints& q) {
  const Eigen::Matrix<double, 6, ik::kDof> J = ik::jacobian(q);
  const Eigen::Matrix<double, 6, 6> N = J * J.transpose();
  return std::sqrt(std::max(0.0, Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>>(N).eigenvalues()[0]));
}

// What a search makes least.
double cost(const ik::Joints& q, ik::Prefer prefer, const ik::Joints& seed) {
  if (prefer == ik::Prefer::Dexterous) return -least_singular_value(q);
  double sum = 0.0;
  for (int j = 0; j < ik::kDof; ++j) {
    double d = q[j] - seed[j];
    if (prefer == ik::Prefer::Centre) {
      const auto i = std::size_t(j);
      d = bounded(j) ? (2.0 * q[j] - ik::kLower[i] - ik::kUpper[i]) / (ik::kUpper[i] - ik::kLower[i]) : 0.0;
    } else if (!bounded(j) && turns(j)) {
      d = std::remainder(d, 2.0 * kPi);
    }
    sum += d * d;
  }
  return std::sqrt(sum);
}

std::vector<double> motions, searches[3];
int intervals = 0, missed = 0, ends_off = 0, searched = 0, worse = 0;
std::vector<std::array<double, 3>> failures;  // kind, pose, where

#if HELD
int said(const ik::SelfMotion& found, double at) {
  int count = 0;
  for (const ik::Interval& one : found) count += one.low <= at && at <= one.high;
  return count;
}

// Rows that miss the pose by no more than rounding: just beyond a fold solve gives those that miss it by less than it
// tells apart.
int exact_rows(const Eigen::Isometry3d& pose, double at) {
  const ik::Solutions found = rows_at(pose, {at}, nullptr);
  return int(std::count_if(found.begin(), found.end(), [&](const ik::Joints& q) {
    return (ik::forward(q).matrix() - pose.matrix()).cwiseAbs().maxCoeff() < kExact;
  }));
}

void compare_with_grid(const Eigen::Isometry3d& pose, const ik::SelfMotion& found, int number) {
  const double low = lowest(), high = highest();
  int run = 0;
  for (double at = low; at < high; at += kStep) {
    run = rows_at(pose, {at}, nullptr).count != said(found, at) ? run + 1 : 0;
    if (run != 2) continue;
    ++missed;
    failures.push_back({0.0, double(number), at});
  }
  intervals += found.count;
  // An end that comes too late is claimed inside, one too early has a row outside; other intervals begin anywhere.
  std::vector<double> ends;
  for (const ik::Interval& one : found) ends.insert(ends.end(), {one.low, one.high});
  for (std::size_t k = 0; k < ends.size(); ++k)
    for (const double side : {-1.0, 1.0}) {
      const double end = ends[k], at = end + side * kOff;
      if (at < low || at > high) continue;
      const auto beside = [&](double other) { return other != end && std::abs(other - at) < kOff; };
      if (std::any_of(ends.begin(), ends.end(), beside)) continue;
      const bool inside = (side > 0.0) == (k % 2 == 0);
      const int rows = inside ? rows_at(pose, {at}, nullptr).count : exact_rows(pose, at), more = rows - said(found, at);
      if (inside ? more >= 0 : more <= 0) continue;
      ++ends_off;
      failures.push_back({1.0, double(number), at});
    }
}
#endif

void compare_with_random(const Eigen::Isometry3d& pose, const ik::Joints& seed, Random& random, int values, int number) {
  const ik::Prefer all[] = {ik::Prefer::Near, ik::Prefer::Centre, ik::Prefer::Dexterous};
  double best[3] = {1e300, 1e300, 1e300};
  for (int n = 0; n < values; ++n) {
    for (const ik::Joints& row : rows_at(pose, held_of(draw(random)), &seed))
      for (int p = 0; p < 3; ++p) best[p] = std::min(best[p], cost(row, all[p], seed));
  }
  for (int p = 0; p < 3; ++p) {
    ik::SearchOptions options;
    options.seed = &seed;
    options.prefer = all[p];
    const ik::Solutions found = ik::search(pose, options);
    searches[p].push_back(time_of([&] {
      const ik::Solutions again = ik::search(pose, options);
      asm volatile("" : : "g"(&again) : "memory");
    }));
    ++searched;
    const double mine = found.count ? cost(found.q[0], all[p], seed) : 1e300;
    if (mine <= best[p] + kWorse) continue;
    ++worse;
    failures.push_back({2.0 + p, double(number), mine - best[p]});
  }
}

double median(std::vector<double> x) {
  if (x.empty()) return 0.0;
  std::nth_element(x.begin(), x.begin() + std::ptrdiff_t(x.size() / 2), x.end());
  return x[x.size() / 2];
}

double largest(const std::vector<double>& x) { return x.empty() ? 0.0 : *std::max_element(x.begin(), x.end()); }

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) return 2;
  const int poses = std::atoi(arguments[1]), values = std::atoi(arguments[2]);
  Random random(static_cast<std::uint64_t>(std::atoi(arguments[3])));
  for (int n = 0; n < poses; ++n) {
    const Eigen::Isometry3d pose = ik::forward(draw(random));
    const ik::Joints seed = draw(random);
#if HELD
    const ik::SelfMotion found = ik::self_motion(pose);
    motions.push_back(time_of([&] {
      const ik::SelfMotion again = ik::self_motion(pose);
      asm volatile("" : : "g"(&again) : "memory");
    }));
    compare_with_grid(pose, found, n);
#endif
    compare_with_random(pose, seed, random, values, n);
  }
  std::printf("%.1f %.1f", median(motions), largest(motions));
  for (const auto& times : searches) std::printf(" %.1f %.1f", median(times), largest(times));
  std::printf("\n");
  std::printf("%d %d %d\n%d %d\n", intervals, missed, ends_off, searched, worse);
  for (const auto& f : failures) std::printf("%.0f %.0f %.9g\n", f[0], f[1], f[2]);
}
