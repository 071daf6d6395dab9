// An arm written by hand: two joints about z, links of 1 m, the tip's x and y asked for.
#pragma once

#include <array>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "arrays/lane_angle.hpp"
#include "solving/lane_solve.hpp"
#include "arm/pose_entries.hpp"
#include "arguments/pose_solver.hpp"
#include "solving/single_solve.hpp"

namespace elbow {

using namespace ikgen_runtime;

struct Policy {
  static constexpr int kTries = 4, kPatience = 5, kCrowd = 4;
  static constexpr double kArrived = 5e-10, kPoseTolerance = 1e-6, kOrthonormal = 1e-14, kLevel = 1e-5;
  static constexpr double kCoincident = 1e-6;
  static constexpr double kMeeting = 2e-5, kLimitTolerance = 1e-9, kLimitReach = 1e-5, kTryStep = 0.4, kSingularBelow = 1e-7;
  static constexpr double kContinuumBelow = 1e-3, kLeastDamping = 1e-12, kDamping = 1e-3, kLargestStep = 0.3;
  static constexpr double kConverged = 1e-13, kProgress = 0.8, kExact = 1e-12, kNeighbouring = 1e-2, kHalfway = 2e-14;
  static constexpr double kFoldReach = 1e-4, kBesideReach = 0.0, kAnywhere = 1e3, kBrokenReach = 0.0;
  static constexpr RefineStage kRefinement[] = {{3, 1e-12, 0.1}, {30, 0.0, 0.0}};
};

struct Arm {
  enum class Status { Ok, Unreachable, Limits, Invalid };
  using Joints = Eigen::Matrix<double, 2, 1>;
  struct Solutions {
    Status status = Status::Unreachable;
    int count = 0;
    std::array<Joints, 2> q;
    std::array<bool, 2> singular;
  };
  struct Options {
    bool limits = true;
    const Joints* seed = nullptr;
    std::array<double, 0> free = {};
  };
  struct Seed {
    double c1 = 1.0, s1 = 0.0;
    Seed() = default;
    explicit Seed(const double* q) noexcept : c1(std::cos(q[0])), s1(std::sin(q[0])) {}
  };
  using Policy = elbow::Policy;
  using Task = PoseEntries<Arm>;
  using Columns = UnitColumns<0, 0, 3>;
  template <int P> using Rows = LaneRows<2, 2, P>;

  static constexpr int kDof = 2, kFree = 0, kMaxSolutions = 2, kLanes = 2, kBesides = 0;
  static constexpr std::array<double, 2> kLower = {-3.0, -2.5}, kUpper = {3.0, 7.0};
  static constexpr std::array<int, 0> kFreeJoints = {};
  static constexpr double kPeriod[] = {ikgen_runtime::kTurn, ikgen_runtime::kTurn};
  static constexpr bool kHeld[] = {false, false};
  static constexpr bool kWholePose = false, kFarLimits = false, kRefined = false;
  static constexpr int kFreedoms = 2;
  static constexpr bool kRounded = false, kNewton = false, kArmAngle = false;
  static constexpr int kRead[][2] = {{0, 3}, {1, 3}};
  static constexpr double kSize = 1.0;
  static constexpr Motion kMotions[] = {{0, true, 1.0, 0.0}, {1, true, 1.0, 0.0}};
  static constexpr double kFrames[][3][4] = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}},
                                             {{1, 0, 0, 1}, {0, 1, 0, 0}, {0, 0, 1, 0}},
                                             {{1, 0, 0, 1}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  static constexpr int kLaneOfRow[] = {0, 1};

  template <int P>
  static void branches(const Pose<P>& pose, const Seed& seed, const std::array<double, 0>&, const Range& range,
                       Rows<P>& rows) noexcept {
    const auto x = pose.t[0][3], y = pose.t[1][3];
    const auto square = x * x + y * y;
    const auto c2 = 0.5 * square - 1.0;
    const auto real = 1.0 + 1e-12 > c2;
    const auto s2 = signs<2 * P>() * sqrt(1.0 - c2 * c2);
    const auto regular = square > 1e-12;
    const auto over = 1.0 / select(regular, square, 1.0);
    const auto u = 1.0 + c2;
    const auto c1 = select(regular, (x * u + y * s2) * over, seed.c1);
    const auto s1 = select(regular, (y * u - x * s2) * over, seed.s1);
    const auto q1 = place<Policy>(0, angle(s1, c1), range, kPeriod[0]);
    const auto q2 = place<Policy>(1, angle(s2, c2), range, kPeriod[1]);
    constexpr int n = Rows<P>::kLanes;
    store(spread<n>(q1.q), rows.q[0]);
    store(spread<n>(q2.q), rows.q[1]);
    const auto found = bit(real, kReal) + bit(real & is_inside<Policy>(max(q1.off, q2.off)), kFound);
    const auto flat = 1e-9 > abs(s2);
    store(spread<n>(found + bit(!regular, kSingular) + bit(!regular, kHit) + bit(real & flat, kRough) +
                    bit(meeting<Policy, 2 * P>(c2, s2), kMeeting)),
          rows.flags);
  }
};

using Solutions = Arm::Solutions;
using Given = GivenOptions<Arm>;
using Quick = PoseSolver<Arm, LaneSolve>;
using Careful = PoseSolver<Arm, SingleSolve>;

}  // namespace elbow
