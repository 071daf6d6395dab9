// The nearest pose that the arm can take, of one that it cannot.
#pragma once

#include "arm/held_aim.hpp"
#include "arm/motion_chain.hpp"
#include "solving/nearest_row.hpp"
#include "arguments/given_options.hpp"
#include "arguments/pose_reading.hpp"
#include "rows/solution_rows.hpp"

namespace ikgen_runtime {

// Arm: as for NearestRow, PoseReading, SolutionRows and Way<Arm>, which solves an exact pose.
template <class Arm, template <class> class Way> struct Projection {
  using Options = typename Arm::Options;
  using Solutions = typename Arm::Solutions;
  using Chords = PoseChords<Arm>;
  using Nearest = NearestRow<Arm>;

  // Rows of the nearest pose where there is none of the pose, and by how much each row is off.
  [[gnu::cold, gnu::noinline]] static void apply(const Eigen::Isometry3d& pose, const GivenOptions<Arm>& given,
                                                 Solutions& out) noexcept {
    Eigen::Isometry3d target = pose;
    if (!given.valid || !PoseReading<Arm>::clean(target)) return;
    const double* t = target.matrix().data();
    if (out.count == 0) solve_nearest(target, given.options, out);
    for (int k = 0; k < out.count; ++k) Chords::off_by(out.q.data()[k].data(), t, out.off.data()[k].data());
  }

 private:
  static constexpr double kSettled = 1e-4;  // rad or m that the nearest row may be from one of its pose, where this is flat

  static bool is_new(const double* q, const Solutions& found) noexcept {
    for (int k = 0; k < found.count; ++k) {
      double most = 0.0;
      for (int j = 0; j < Arm::kDof; ++j)
        most = std::max(most, std::abs(SolutionRows<Arm>::change(j, q, found.q.data()[k].data())));
      if (most <= kSettled) return false;
    }
    return true;
  }

  // A nearer row than q beside those that take the pose outside the limits, where no other start may lead.
  static void take_beyond(const Eigen::Isometry3d& target, Options options, double least, double* q) noexcept {
    Solutions beyond;
    options.limits = false;
    Way<Arm>::template solve<1>(&target, options, &beyond);
    for (int k = 0; k < beyond.count; ++k) {
      double* row = beyond.q.data()[k].data();
      Nearest::put_inside(row);
      const double cost = Nearest::descend(target.matrix().data(), true, Nearest::kRoundOff, row);
      if (!(cost < least)) continue;
      least = cost;
      std::copy_n(row, Arm::kDof, q);
    }
  }

  static void solve_nearest(const Eigen::Isometry3d& target, Options options, Solutions& out) noexcept {
    double q[Arm::kDof];
    const double cost = Nearest::find(target.matrix().data(), options, options.limits, Nearest::kRoundOff, Nearest::kFirstSteps, q);
    if (out.status == Arm::Status::Limits) take_beyond(target, options, cost, q);
    Eigen::Isometry3d pose;
    by_columns(MotionChain<Arm>::forward(q), pose.matrix().data());
    HeldAim<Arm>::values(q, options.free);
    Way<Arm>::template solve<1>(&pose, options, &out);
    if (is_new(q, out) && SolutionRows<Arm>::place(q, options)) SolutionRows<Arm>::add(out, q, false);
    if (out.count > 0) out.status = Arm::Status::Ok;
  }
};

}  // namespace ikgen_runtime
