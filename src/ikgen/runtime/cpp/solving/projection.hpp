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

  // Rows of the nearest pose where there is none of the pose, and by how much each row is off.
  [[gnu::cold, gnu::noinline]] static void apply(const Eigen::Isometry3d& pose, const GivenOptions<Arm>& given,
                                                 Solutions& out) noexcept {
    Eigen::Isometry3d target = pose;
    if (!given.valid || !PoseReading<Arm>::clean(target)) return;
    const double* t = target.matrix().data();
    if (out.count == 0) solve_nearest(t, given.options, out);
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

  static void solve_nearest(const double* t, Options options, Solutions& out) noexcept {
    double q[Arm::kDof];
    NearestRow<Arm>::find(t, options, options.limits, NearestRow<Arm>::kRoundOff, NearestRow<Arm>::kFirstSteps, q);
    Eigen::Isometry3d pose;
    by_columns(MotionChain<Arm>::forward(q), pose.matrix().data());
    HeldAim<Arm>::values(q, options.free);
    Way<Arm>::template solve<1>(&pose, options, &out);
    if (is_new(q, out) && SolutionRows<Arm>::place(q, options)) SolutionRows<Arm>::add(out, q, false);
    if (out.count > 0) out.status = Arm::Status::Ok;
  }
};

}  // namespace ikgen_runtime
