// Joint values along a path of poses, on one branch.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "arguments/pose_reading.hpp"
#include "rows/singular_value.hpp"
#include "solving/shortest_motion.hpp"

namespace ikgen_runtime {

// Arm: as for PoseError and SingularValue; Solver: solve(pose, options, out), search(pose, options, out).
template <class Arm, class Solver> struct PathStep {
  static constexpr int kDof = Arm::kDof, kDeepest = 24, kShallow = 9;
  static constexpr int kMost = 1000;  // steps to a pose, where rows follow at no length
  static constexpr double kFarthest = 0.3, kAway = 1.0, kOff = 0.2, kLeastOff = 1e-4, kJump = 0.05;
  static constexpr double kLeastDamping = 1e-14;  // where steps foretell the next row
  using Shortest = ShortestMotion<Arm>;
  using Status = typename Arm::Status;

  double q[kDof];
  bool limits, crossed = false, at_singularity = false;
  int left = kMost;

  // From a pose to the next; where halved steps lead far away or nowhere, as beside a singularity, to a row next to the
  // last one if there is one: of arms with held joints also where these have other values than the shortest motion leads to.
  Status go_on(const Eigen::Isometry3d& before, const Eigen::Isometry3d& pose) noexcept {
    typename Arm::Joints last;
    double *const here = last.data(), there[kDof], expected[kDof], row[kDof];
    std::copy_n(q, kDof, here);
    left = kMost;
    Status status = step(before, pose, 0);
    if (status == Status::Ok && farthest(q, here) < kAway) return status;
    std::copy_n(q, kDof, there);
    std::copy_n(here, kDof, q);
    std::copy_n(here, kDof, expected);
    bool singular = false;
    Status why = next_row(pose, expected, row, singular);
    if (why == Status::Ok && beside(row, singular, pose)) return Status::Ok;
    if (Arm::kFree > 0 && status != Status::Ok) {
      const Status found = search(pose, last, limits, row, singular);
      if (found == Status::Ok && beside(row, singular, pose)) return Status::Ok;
      if (status == Status::Unreachable && why == Status::Unreachable && found == Status::Ok) why = status = Status::Singular;
    }
    std::copy_n(there, kDof, q);
    return status == Status::Singular && why != Status::Ok ? why : status;
  }

  // From a pose to the next, with halved steps where the rows do not follow the Jacobian.
  Status step(const Eigen::Isometry3d& before, const Eigen::Isometry3d& pose, int depth) noexcept {
    --left;
    double expected[kDof], row[kDof];
    bool singular = false;
    const bool none[kDof] = {};
    std::copy_n(q, kDof, expected);
    Shortest::move(expected, pose, none, kLeastDamping);
    Status status = next_row(pose, expected, row, singular);
    if (status == Status::Ok) {
      const double gap = farthest(row, expected), moved = farthest(row, q);
      const bool alike = moved < kFarthest && gap < kLeastOff + kOff * moved;
      const bool across = alike && !singular && !at_singularity && SingularValue<Arm>::between(q, row);
      const bool follows = alike && !(across && moved > kLeastOff);
      if (follows || (depth == kDeepest && moved < kJump)) {
        crossed = crossed || singular || across || !follows;
        at_singularity = singular;
        return arrive(row, pose);
      }
      status = Status::Singular;
    } else if (depth >= kShallow) {
      return status;
    }
    if (depth == kDeepest || left < 0) return status;
    const Eigen::Isometry3d middle = between(before, pose);
    const Status first = step(before, middle, depth + 1);
    return first == Status::Ok ? step(middle, pose, depth + 1) : first;
  }

  // To the row next to the start, if the arm has held joints and there is one, or the best that a search finds.
  Status begin(const Eigen::Isometry3d& pose, const typename Arm::Joints& start) noexcept {
    std::copy_n(start.data(), kDof, q);
    if constexpr (Arm::kFree > 0) {
      double row[kDof], expected[kDof];
      std::copy_n(q, kDof, expected);
      if (unstopped(pose, expected, row, crossed) == Status::Ok && farthest(row, q) < 0.1 && arrive(row, pose) == Status::Ok)
        return Status::Ok;
    }
    return search(pose, start, limits, q, crossed);
  }

 private:
  // The row that a search finds nearest to joint values.
  static Status search(const Eigen::Isometry3d& pose, const typename Arm::Joints& nearby, bool limits, double* row,
                       bool& singular) noexcept {
    typename Arm::Solutions found;
    typename Arm::SearchOptions options;
    options.seed = &nearby;
    options.limits = limits;
    Solver::search(pose, options, found);
    if (found.count > 0) {
      std::copy_n(found.q.data()->data(), kDof, row);
      singular = found.singular.data()[0];
    }
    return found.status;
  }

  static double farthest(const double* a, const double* b) noexcept {
    double most = 0.0;
    for (int j = 0; j < kDof; ++j) most = std::max(most, std::abs(a[j] - b[j]));
    return most;
  }

  // To a row that is next to where the arm is, if it is inside the limits.
  bool beside(const double* row, bool singular, const Eigen::Isometry3d& pose) noexcept {
    if (!(farthest(row, q) < kFarthest) || arrive(row, pose) != Status::Ok) return false;
    crossed = true;
    at_singularity = singular;
    return true;
  }

  // To a row, if it is inside the limits on the turn that it came to, or to the one beside it that is: rounding may move it out.
  Status arrive(const double* row, const Eigen::Isometry3d& pose) noexcept {
    double placed[kDof];
    std::copy_n(row, kDof, placed);
    const double off = limits ? outside(row) : 0.0;
    if (off > Arm::Policy::kLimitReach) return Status::Limits;
    if (off > Arm::Policy::kLimitTolerance) {
      const typename Arm::Solutions inside = rows_of(pose, row, true);
      const double* nearest = inside.q.data()[0].data();
      if (inside.count == 0 || !(farthest(nearest, row) < kLeastOff)) return Status::Limits;
      std::copy_n(nearest, kDof, placed);
    }
    for (int j = 0; j < kDof; ++j) q[j] = limits ? clipped(placed, j) : placed[j];
    return Status::Ok;
  }

  // How far a row is outside the limits; negative inside.
  static double outside(const double* row) noexcept {
    double most = -kInfinity;
    for (int j = 0; j < kDof; ++j) most = std::max(most, excess(row, j));
    return most;
  }
  static double excess(const double* row, int j) noexcept {
    return std::max(Arm::kLower.data()[j] - row[j], row[j] - Arm::kUpper.data()[j]);
  }

  // The row that goes on from here: of an arm without held joints the closed form's nearest to the expected one, of
  // others the one that all joints reach together, those that it would take out of their limits stopped there, and
  // expected is then where the Jacobian leads the others.
  Status next_row(const Eigen::Isometry3d& pose, double* expected, double* row, bool& singular) const noexcept {
    if constexpr (Arm::kFree > 0) {
      return unstopped(pose, expected, row, singular);
    } else {
      return closed_form(pose, q, expected, row, singular);
    }
  }

  // The closed form's row nearest to the expected one, what is held as `nearby` has it; from a singularity, where branches meet,
  // of those inside the limits if there are any.
  Status closed_form(const Eigen::Isometry3d& pose, const double* nearby, const double* expected, double* row,
                     bool& singular) const noexcept {
    typename Arm::Solutions found = rows_of(pose, nearby, false);
    const auto inside = [&](int k) noexcept { return !(outside(found.q.data()[k].data()) > Arm::Policy::kLimitReach); };
    int some = 0;
    for (int k = 0; k < found.count; ++k) some += inside(k);
    const bool left_out = limits && some > 0 && some < found.count &&
                          SingularValue<AllMoving<Arm>>::redundant_below(q, Arm::Policy::kSingularBelow);
    double least = kInfinity;
    for (int k = 0; k < found.count; ++k) {
      const double gap = farthest(found.q.data()[k].data(), expected);
      if (!(gap < least) || (left_out && !inside(k))) continue;
      least = gap;
      std::copy_n(found.q.data()[k].data(), kDof, row);
      singular = found.singular.data()[k];
    }
    return found.status;
  }

  // The closed form's rows, nearest first, what is held as `nearby` has it.
  static typename Arm::Solutions rows_of(const Eigen::Isometry3d& pose, const double* nearby, bool limits) noexcept {
    typename Arm::Options options;
    typename Arm::Joints seed;
    std::copy_n(nearby, kDof, seed.data());
    options.seed = &seed;
    options.limits = limits;
    typename Arm::Solutions found;
    Solver::solve(pose, options, found);
    return found;
  }

  // Where the steps end beside the pose, as at a fold, of the rows with what is held where they ended. Before, a joint
  // is let go once if the error would shrink by its motion off its limit: those stopped first may be the wrong ones.
  Status unstopped(const Eigen::Isometry3d& pose, double* expected, double* row, bool& singular) const noexcept {
    bool stopped[kDof] = {}, released[kDof] = {};
    double at[kDof];
    std::copy_n(q, kDof, at);
    for (bool any = false;; any = true) {
      const bool arrived = Shortest::newton(at, pose, stopped, row);
      const int joint = arrived ? farthest_out(row) : pulled_off(row, pose, stopped, released);
      if (joint < 0 && arrived) {
        if (any) {
          std::copy_n(at, kDof, expected);
          Shortest::move(expected, pose, stopped, kLeastDamping);
        }
        break;
      }
      if (joint < 0) {
        double held[kDof];
        for (int j = 0; j < kDof; ++j) held[j] = limits ? clipped(row, j) : row[j];
        if (closed_form(pose, held, expected, row, singular) == Status::Ok) break;
        return any ? Status::Limits : Status::Unreachable;
      }
      stopped[joint] = arrived;
      released[joint] = released[joint] || !arrived;
      at[joint] = arrived ? clipped(row, joint) : q[joint];
    }
    singular = SingularValue<AllMoving<Arm>>::redundant_below(row, Arm::Policy::kSingularBelow);
    return Status::Ok;
  }

  static double clipped(const double* row, int j) noexcept {
    return std::min(std::max(row[j], Arm::kLower.data()[j]), Arm::kUpper.data()[j]);
  }

  // The joint that is farthest out of its limits, if one is.
  int farthest_out(const double* row) const noexcept {
    const double most = outside(row);
    for (int j = 0; j < kDof && limits && most > Arm::Policy::kLimitTolerance; ++j)
      if (!(excess(row, j) < most)) return j;
    return -1;
  }

  // The stopped joint, not released before, by whose motion off its limit the error shrinks most, if one is.
  static int pulled_off(const double* row, const Eigen::Isometry3d& pose, const bool* stopped, const bool* released) noexcept {
    const PoseError<AllMoving<Arm>> here(row, HeldAim<AllMoving<Arm>>(pose));
    double most = 0.0;
    int best = -1;
    for (int j = 0; j < kDof; ++j) {
      if (!stopped[j] || released[j]) continue;
      double pull = 0.0;
      for (int a = 0; a < PoseError<AllMoving<Arm>>::kCount; ++a) pull += here.slope[a][j] * here.error[a];
      if (row[j] > Arm::kLower.data()[j]) pull = -pull;
      if (!(pull > most)) continue;
      most = pull;
      best = j;
    }
    return best;
  }

  // The pose halfway: the middle of the positions, half of the turn between.
  static Eigen::Isometry3d between(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) noexcept {
    Eigen::Isometry3d out = a;
    out.linear() = Eigen::Quaterniond(a.linear()).slerp(0.5, Eigen::Quaterniond(b.linear())).toRotationMatrix();
    out.translation() = 0.5 * (a.translation() + b.translation());
    return out;
  }
};

// Joint values along `count` poses. `Walk`: its result.
template <class Arm, class Solver, class Walk>
inline Walk follow_poses(const Eigen::Isometry3d* poses, std::ptrdiff_t count, const typename Arm::Joints& start, bool limits,
                         typename Arm::Joints* q, bool* singular) noexcept {
  using Status = typename Arm::Status;
  Walk out;
  PathStep<Arm, Solver> walk;
  walk.limits = limits;
  Eigen::Isometry3d before;
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    Eigen::Isometry3d pose = poses[i];
    walk.crossed = false;
    if (!PoseReading<Arm>::clean(pose)) {
      out.status = PoseReading<Arm>::refused(pose);
    } else {
      out.status = i > 0 ? walk.go_on(before, pose) : walk.begin(pose, start);
    }
    if (out.status != Status::Ok) return out;
    std::copy_n(walk.q, Arm::kDof, q[i].data());
    if (singular) singular[i] = walk.crossed;
    out.reached = i + 1;
    before = pose;
  }
  out.status = Status::Ok;
  return out;
}

}  // namespace ikgen_runtime
