// Values of what is held that alone reach a pose, which no sample meets: of an arm that is stretched, say, or whose joints
// stand on several limits.
#pragma once

#include "held/held_sample.hpp"
#include "held/seeds_row.hpp"
#include "solving/nearest_row.hpp"

namespace ikgen_runtime {

// Arm: as for NearestRow.
template <class Arm> struct LoneValue {
  using Nearest = NearestRow<AllMoving<Arm>>;
  static constexpr int kStarts = 32;
  // Of squares, what is left of a pose: that is reached to rounding, reached, reached perhaps if joints went on that hardly
  // move it.
  static constexpr double kExact = 1e-22, kThere = 1e-12, kAlmost = 1e-4;

  // A configuration that takes a pose, whatever is held, inside the limits if these hold; whether there is one.
  [[gnu::cold, gnu::noinline]] static bool find(const Eigen::Isometry3d& pose, bool limits, double* q) noexcept {
    constexpr double enough = Nearest::kStanding;
    const double* t = pose.matrix().data();
    double left = Nearest::find(t, {}, limits, enough, Nearest::kFewSteps, q, false, kStarts);
    if (left > kExact && left < kAlmost) left = Nearest::descend(t, limits, enough, q, Nearest::kSteps, Nearest::kFinest);
    if (left > kExact && left < kAlmost) left = Nearest::find(t, {}, limits, enough, Nearest::kFewSteps, q, true);
    return left < kThere;
  }
};

// Where a search found no row, the best one at the values of what is held that such a configuration has. Solver: as for
// take_seeds_row.
template <class Arm, class Solver>
inline void take_lone_row(const Eigen::Isometry3d& pose, const RowPreference<Arm>& preference, typename Arm::Solutions& out) noexcept {
  typename Arm::Joints q;
  if (out.count == 0 && LoneValue<Arm>::find(pose, preference.options.limits, q.data()))
    take_seeds_row<Arm, Solver>(pose, q, preference, out);
}

// Where self_motion found no interval, one without width, at the value that such a configuration has. Solver: as for
// take_seeds_row.
template <class Arm, class Solver>
inline void take_lone_value(const Eigen::Isometry3d& pose, bool limits, typename Arm::Intervals& out) noexcept {
  typename Arm::Joints q;
  if (out.count > 0 || !LoneValue<Arm>::find(pose, limits, q.data())) return;
  typename Arm::Options options;
  options.seed = &q;
  options.limits = limits;
  typename Arm::Solutions found;
  Solver::solve(pose, options, found);
  if (found.count == 0) return;
  constexpr int j = Arm::kFreeJoints[0];
  const HeldSample<Arm> s(pose, q.data()[j], JointBounds<Arm>(false));
  const int lane = s.nearest(SolutionRows<Arm>::row(found, 0));
  out.intervals.data()[out.count++] = {q.data()[j], q.data()[j], Arm::kGuarded && lane >= 0 ? lane % Arm::kLanes : 0};
  out.status = Arm::Status::Ok;
}

}  // namespace ikgen_runtime
