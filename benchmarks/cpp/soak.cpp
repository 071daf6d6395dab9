// Millions of poses through one emitted header: is every row right, is the generating configuration among them?
//
// Compile with -DIKGEN_HEADER='"x_ik.hpp"' -DIKGEN_NAMESPACE=x_ik -DIKGEN_FREE=0 or 1 (held joints)
// -DSOAK_POSITION=0 or 1 and -DSOAK_TURN=0 (nothing), 1 (direction), 2 (yaw), 3 (rotation) or 4 (pitch): what the task reads, of
// the tool's axis -DSOAK_AXIS=0, 1 or 2.
// Arguments: random poses, poses beside singularities, seed. Of those half are drawn by descending on the smallest
// singular value, a quarter have joints at multiples of 45 degrees, all but the first of ten 10^-1 to 10^-12 (rad, m)
// off in a random direction, or in one joint; and a quarter have one joint there, or as far off, and the others drawn
// anew for every pose. Every other forty of them are solved without limits, and one of seven
// has a joint on a limit. Prints the rows that were returned and those
// that are wrong; then for each decade of the smallest singular value: random poses, missed, unanswered, and the same
// three of the poses beside singularities; then configurations that failed, one a line: kind, singular value, joints.

#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

#include IKGEN_HEADER

namespace ik = IKGEN_NAMESPACE;

namespace {

constexpr int kDecades = 14;           // the last holds all below
constexpr int kShown = 5;              // failures printed, of each kind
constexpr int kBeside = 10;            // poses beside each singular configuration
constexpr int kOnLimits = 7;           // one pose beside singularities of so many has a joint on a limit
constexpr double kRight = 1e-9;        // closure
constexpr double kFound = 1e-6;        // as ikgen.verify.completeness, which says why
constexpr double kNoise = 1e-13, kFarthest = 1e-2, kAlone = 1e-3;
constexpr int kRows = 3 * SOAK_POSITION + (SOAK_TURN == 0 ? 0 : SOAK_TURN % 2 == 0 ? 1 : 3);
constexpr int kRank = kRows - (SOAK_TURN == 1 ? 1 : 0);
using Task = Eigen::Matrix<double, kRows, Eigen::Dynamic>;

struct Arm {
  std::array<bool, ik::kDof> turns{};
  std::array<double, ik::kDof> low{}, high{};
  std::array<int, ik::kDof> active{};
  int moving = 0;
  double length = 1.0;
};

ik::Joints draw(const Arm& arm, std::mt19937_64& random) {
  ik::Joints q;
  for (int j = 0; j < ik::kDof; ++j) q[j] = std::uniform_real_distribution<double>(arm.low[j], arm.high[j])(random);
  return q;
}

Arm the_arm() {
  Arm arm;
  std::mt19937_64 random(3);
  const auto J = ik::jacobian(ik::Joints::Constant(0.3));
  for (int j = 0; j < ik::kDof; ++j) {
    arm.turns[j] = J.template bottomRows<3>().col(j).norm() > 1e-12;
    const double half = arm.turns[j] ? 3.141592653589793 : 1.0;
    const bool free = std::abs(ik::kLower[j]) > 1e3 || std::abs(ik::kUpper[j]) > 1e3;
    arm.low[j] = free ? -half : ik::kLower[j];
    arm.high[j] = free ? half : ik::kUpper[j];
    bool held = false;
#if IKGEN_FREE
    for (const int k : ik::kFreeJoints) held = held || k == j;
#endif
    if (!held) arm.active[arm.moving++] = j;
  }
  double longest = 1e-3;
  for (int n = 0; n < 64; ++n) longest = std::max(longest, ik::forward(draw(arm, random)).translation().norm());
  arm.length = longest;
  return arm;
}

// The derivative of what the task reads, lengths in units of the arm's reach.
Task task_jacobian(const Arm& arm, const ik::Joints& q) {
  const auto J = ik::jacobian(q);
  const Eigen::Matrix3d R = ik::forward(q).linear();
  Task out(kRows, arm.moving);
  for (int k = 0; k < arm.moving; ++k) {
    const int j = arm.active[k];
    const double unit = arm.turns[j] ? 1.0 : arm.length;
    const Eigen::Vector3d linear = J.col(j).template head<3>() * (unit / arm.length);
    Eigen::Vector3d angular = J.col(j).template tail<3>() * unit;
    if (SOAK_POSITION) out.col(k).template head<3>() = linear;
    const Eigen::Vector3d x = R.col(SOAK_AXIS), moved = angular.cross(x);
    if (SOAK_TURN == 1) angular -= x * x.dot(angular);
    if (SOAK_TURN == 4) {
      out(kRows - 1, k) = moved[2];
    } else if (SOAK_TURN == 2) {
      out(kRows - 1, k) = (x[0] * moved[1] - x[1] * moved[0]) / std::max(x[0] * x[0] + x[1] * x[1], 1e-12);
    } else if (SOAK_TURN) {
      out.col(k).template tail<3>() = angular;
    }
  }
  return out;
}

// Zeros make it square: a QR decomposition before would take most of the time to compile.
using Decomposition = Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::NoQRPreconditioner>;

Eigen::MatrixXd squared(const Task& J) {
  const Eigen::Index size = std::max(J.rows(), J.cols());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(size, size);
  out.topLeftCorner(J.rows(), J.cols()) = J;
  return out;
}

struct Singular {
  double sigma = 1.0, kappa = 0.0;
  Eigen::VectorXd left, null;
};

Singular singular_of(const Arm& arm, const ik::Joints& q) {
  const Decomposition svd(squared(task_jacobian(arm, q)), Eigen::ComputeFullU | Eigen::ComputeFullV);
  const int last = std::min(kRank, arm.moving) - 1;
  Singular out;
  out.sigma = svd.singularValues()[last];
  out.left = svd.matrixU().col(last).head(kRows);
  out.null = svd.matrixV().col(last).head(arm.moving);
  if (last > 0 && svd.singularValues()[last - 1] <= kAlone) out.kappa = -1.0;  // another direction is free too
  return out;
}

double smallest(const Arm& arm, const ik::Joints& q) {
  const Decomposition svd(squared(task_jacobian(arm, q)));
  return svd.singularValues()[std::min(kRank, arm.moving) - 1];
}

ik::Joints moved(const Arm& arm, ik::Joints q, const Eigen::VectorXd& along, double step) {
  for (int k = 0; k < arm.moving; ++k) {
    const int j = arm.active[k];
    q[j] += step * along[k] * (arm.turns[j] ? 1.0 : arm.length);
  }
  return q;
}

// Newton steps on the smallest singular value; false where they lead nowhere, or out of the limits.
bool find_singular(const Arm& arm, ik::Joints& q) {
  for (int round = 0; round < 16; ++round) {
    const Singular at = singular_of(arm, q);
    const Task J = task_jacobian(arm, q);
    Eigen::VectorXd gradient(arm.moving);
    for (int k = 0; k < arm.moving; ++k) {
      const Task other = task_jacobian(arm, moved(arm, q, Eigen::VectorXd::Unit(arm.moving, k), 1e-6));
      gradient[k] = at.left.dot((other - J) * at.null) / 1e-6;
    }
    const double step = std::clamp(at.sigma / std::max(gradient.squaredNorm(), 1e-12), 0.0, 1.0);
    q = moved(arm, q, (step * gradient).cwiseMax(-0.5).cwiseMin(0.5), -1.0);
  }
  for (int j = 0; j < ik::kDof; ++j) {
    if (arm.turns[j]) q[j] -= 6.283185307179586 * std::round((q[j] - 0.5 * (arm.low[j] + arm.high[j])) / 6.283185307179586);
    if (q[j] < arm.low[j] || q[j] > arm.high[j]) return false;
  }
  return smallest(arm, q) < 1e-9;
}

// How far a row's pose is off, in rad or lengths of the arm (at least 1 m, or of the row's longest slide).
double closure(const Arm& arm, const ik::Joints& row, const Eigen::Isometry3d& pose) {
  double size = std::max(1.0, arm.length);
  for (int j = 0; j < ik::kDof; ++j)
    if (!arm.turns[j]) size = std::max(size, std::abs(row[j]));
  const Eigen::Isometry3d got = ik::forward(row);
  double error = 0.0;
  if (SOAK_POSITION) error = (got.translation() - pose.translation()).norm() / size;
  const Eigen::Matrix3d E = pose.linear().transpose() * got.linear();
  if (SOAK_TURN == 3) error = std::max(error, 0.5 * std::sqrt(2.0) * (E - Eigen::Matrix3d::Identity()).norm());
  const Eigen::Vector3d x = got.linear().col(SOAK_AXIS), y = pose.linear().col(SOAK_AXIS);
  if (SOAK_TURN == 1) error = std::max(error, (x - y).norm());
  if (SOAK_TURN == 4) error = std::max(error, std::abs(x[2] - y[2]));
  if (SOAK_TURN == 2) {
    const double a = std::atan2(x[1], x[0]), b = std::atan2(y[1], y[0]);
    error = std::max(error, std::abs(std::remainder(a - b, 6.283185307179586)));
  }
  return std::isnan(error) ? 1e300 : error;
}

double apart(const Arm& arm, const ik::Joints& a, const ik::Joints& b) {
  double most = 0.0;
  for (int j = 0; j < ik::kDof; ++j) {
    const double d = a[j] - b[j];
    most = std::max(most, arm.turns[j] ? std::abs(std::remainder(d, 6.283185307179586)) : std::abs(d) / std::max(1.0, std::abs(b[j])));
  }
  return most;
}

// How close a row with this closure error must come.
double allowed(const Arm& arm, const ik::Joints& q, double error) {
  Singular at = singular_of(arm, q);
  const double e = kNoise + std::min(error, 1e-9);
  double move = e / std::max(at.sigma, 1e-300);
  if (at.kappa == 0.0) {
    const Task turned = task_jacobian(arm, moved(arm, q, at.null, 1e-5)) - task_jacobian(arm, q);
    at.kappa = std::abs(at.left.dot(turned * at.null)) / 1e-5;
    move = std::min(move, std::sqrt(2.0 * e / std::max(at.kappa, 1e-300)));
  }
  return kFound + std::min(move, kFarthest);
}

struct Count {
  long poses = 0, missed = 0, unanswered = 0;
};

struct Tally {
  long rows = 0, wrong = 0;
  std::array<std::array<Count, kDecades>, 2> decades{};
  std::array<int, 3> shown{};
};

void show(Tally& tally, int kind, const char* name, double sigma, const ik::Joints& q) {
  if (tally.shown[kind]++ >= kShown) return;
  std::printf("%s %.3e", name, sigma);
  for (int j = 0; j < ik::kDof; ++j) std::printf(" %.17g", q[j]);
  std::printf("\n");
}

bool contains(const Arm& arm, const ik::Solutions& found, const ik::Joints& q, const Eigen::Isometry3d& pose) {
  double best = 1e300;
  int which = -1;
  for (int k = 0; k < found.count; ++k) {
    const double gap = apart(arm, q, found.q[k]);
    if (gap < best) best = gap, which = k;
  }
  if (which < 0 || best > kFound + kFarthest) return false;
  return best <= kFound || best <= allowed(arm, q, closure(arm, found.q[which], pose));
}

void put(const Arm& arm, Tally& tally, bool near, bool limits, const ik::Joints& q) {
  const Eigen::Isometry3d pose = ik::forward(q);
  ik::Options options;
  options.limits = limits;
#if IKGEN_FREE
  for (std::size_t k = 0; k < ik::kFreeJoints.size(); ++k) options.free[k] = q[ik::kFreeJoints[k]];
#endif
  const ik::Solutions found = ik::solve(pose, options);
  const double sigma = smallest(arm, q);
  const int decade = sigma >= 1.0 ? 0 : std::clamp(static_cast<int>(-std::log10(std::max(sigma, 1e-300))), 0, kDecades - 1);
  Count& count = tally.decades[near][static_cast<std::size_t>(decade)];
  ++count.poses;
  tally.rows += found.count;
  bool flagged = false;
  for (int k = 0; k < found.count; ++k) {
    flagged = flagged || found.singular[k];
    if (closure(arm, found.q[k], pose) <= kRight) continue;
    ++tally.wrong;
    show(tally, 0, "wrong", sigma, q);
  }
  if (!found.count) ++count.unanswered, show(tally, 1, "unanswered", sigma, q);
  if (contains(arm, found, q, pose)) return;
  options.seed = &q;  // rows of a continuum take their free value from a seed
  if (flagged && contains(arm, ik::solve(pose, options), q, pose)) return;
  ++count.missed;
  show(tally, 2, "missed", sigma, q);
}

// The joint at a multiple of 45 degrees, a slide at a multiple of the arm's length over eight, where its limits have any.
void turn_even(const Arm& arm, ik::Joints& q, int j, std::mt19937_64& random) {
  const double eighth = arm.turns[j] ? 0.7853981633974483 : 0.125 * arm.length;
  const int low = static_cast<int>(std::ceil(arm.low[j] / eighth)), high = static_cast<int>(std::floor(arm.high[j] / eighth));
  if (high >= low) q[j] = eighth * std::uniform_int_distribution<int>(low, high)(random);
}

// All joints or some of them at multiples of 45 degrees.
ik::Joints even_turns(const Arm& arm, std::mt19937_64& random) {
  const double share = std::uniform_real_distribution<double>(0.3, 1.3)(random);
  ik::Joints q = draw(arm, random);
  for (int j = 0; j < ik::kDof; ++j)
    if (arm.turns[j] && std::uniform_real_distribution<double>()(random) <= share) turn_even(arm, q, j, random);
  return q;
}

double distance_off(std::mt19937_64& random) {
  return std::pow(10.0, -std::uniform_real_distribution<double>(1.0, 12.0)(random));
}

// One joint at a multiple of 45 degrees, or beside it.
ik::Joints even_turn(const Arm& arm, bool at, std::mt19937_64& random) {
  ik::Joints q = draw(arm, random);
  const int j = std::uniform_int_distribution<int>(0, ik::kDof - 1)(random);
  turn_even(arm, q, j, random);
  if (!at) q[j] = std::clamp(q[j] + distance_off(random), arm.low[j], arm.high[j]);
  return q;
}

ik::Joints beside(const Arm& arm, const ik::Joints& singular, bool one, std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  const double distance = distance_off(random);
  const int only = std::uniform_int_distribution<int>(0, ik::kDof - 1)(random);
  ik::Joints q = singular;
  for (int j = 0; j < ik::kDof; ++j)
    if (!one || j == only) q[j] = std::clamp(q[j] + distance * normal(random), arm.low[j], arm.high[j]);
  return q;
}

// One joint on one of its limits.
void to_limit(const Arm& arm, ik::Joints& q, std::mt19937_64& random) {
  const int j = std::uniform_int_distribution<int>(0, ik::kDof - 1)(random);
  q[j] = std::uniform_int_distribution<int>(0, 1)(random) ? arm.low[j] : arm.high[j];
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const long poses = std::atol(argv[1]), near = std::atol(argv[2]);
  std::mt19937_64 random(static_cast<unsigned long>(std::atol(argv[3])));
  const Arm arm = the_arm();
  Tally tally;
  for (long n = 0; n < poses; ++n) put(arm, tally, false, true, draw(arm, random));
  ik::Joints singular;
  bool known = false;
  for (long n = 0, tries = 0; n < near; ++n) {
    const bool even = n / kBeside % 2 == 1, first = n % kBeside == 0;
    if (even && first) singular = even_turns(arm, random);
    for (; !even && first && tries < 50 * (n / kBeside + 20); ++tries) {
      ik::Joints start = draw(arm, random);
      if (!find_singular(arm, start)) continue;
      singular = start, known = true;
      break;
    }
    if (!even && !known) singular = even_turns(arm, random);  // an arm without singularities
    const bool one = n / kBeside % 4 == 3;
    const bool limits = n / (4 * kBeside) % 2 == 0;
    ik::Joints q = one ? even_turn(arm, n % 2 == 0, random) : even && first ? singular : beside(arm, singular, even && n % 2 == 0, random);
    if (n % kOnLimits == 1) to_limit(arm, q, random);
    put(arm, tally, true, limits, q);
  }
  std::printf("rows %ld %ld\n", tally.rows, tally.wrong);
  for (int k = 0; k < kDecades; ++k) {
    std::printf("decade %d", k);
    for (const auto& kind : tally.decades) std::printf(" %ld %ld %ld", kind[k].poses, kind[k].missed, kind[k].unanswered);
    std::printf("\n");
  }
  return 0;
}
