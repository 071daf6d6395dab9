// Rows one by one, with care: on singularities, near them, of rounded geometry, and those of a seed alone.
#pragma once

#include "joint_range.hpp"
#include "lane_rows.hpp"
#include "newton_refinement.hpp"
#include "rank_loss.hpp"
#include "solution_rows.hpp"

namespace ikgen_runtime {

// Arm: as for NewtonRefinement, RankLoss and SolutionRows; Seed, Rows<P> and branches<P>, the closed form;
// kLaneOfRow; kRefined, whether its rows are right already; kSolvesBeside, whether add_rows_beside has more.
template <class Arm> struct CarefulSolve {
  using Options = typename Arm::Options;
  using Policy = typename Arm::Policy;
  using Refinement = NewtonRefinement<Arm>;
  using Row = SolutionRows<Arm>;
  using Rows = typename Arm::template Rows<1>;
  using Solutions = typename Arm::Solutions;

  // All solutions. Where the pose leaves a joint free and the seed's value of it leads nowhere, others are tried;
  // where no row fits, the seed is taken as a Newton start.
  [[gnu::always_inline]] static void solve(const Eigen::Isometry3d& pose, const Options& options,
                                           Solutions& out) noexcept {
    bool real = false;
    for (int turn = 0; turn < Policy::kTries; ++turn) {
      double start[Arm::kDof];
      for (int j = 0; j < Arm::kDof; ++j)
        start[j] = (options.seed ? options.seed->data()[j] : 0.0) + (Arm::kRevolute[j] ? turn * Policy::kTryStep : 0.0);
      for (std::size_t k = 0; k < Arm::kFreeJoints.size(); ++k) start[Arm::kFreeJoints[k]] = options.free[k];
      const bool hit = find_rows(pose, start, options, out);
      if constexpr (Arm::kSolvesBeside)
        if (turn == 0) Arm::add_rows_beside(pose, start, options, out);
      real = real || out.count > 0;
      Row::place_all(options, out);
      if (out.count == 0 && options.seed && Refinement::refine(start, pose)) {
        add(out, start, true);
        Row::place_all(options, out);
      }
      if (out.count > 0 || !hit) break;
    }
    if (options.seed) Row::sort_by_distance(out, options.seed->data());
    out.status = out.count > 0 ? Arm::Status::Ok : real ? Arm::Status::Limits : Arm::Status::Unreachable;
  }

  // The closed form's rows without limits; q0 gives the values of joints that the pose leaves free.
  static void find_lanes(const Eigen::Isometry3d& pose, const double* q0, const Options& options, Rows& out) noexcept {
    constexpr Range anywhere = {kUnbounded<Arm::kDof>.lower, kUnbounded<Arm::kDof>.upper};
    Arm::branches(gather<1>(&pose), typename Arm::Seed(q0), options.free, anywhere, out);
  }

  // Adds the row of a lane, refined if that leads to the pose.
  static void add_refined(const Eigen::Isometry3d& pose, const Rows& rows, int lane, Solutions& out) noexcept {
    double q[Arm::kDof];
    for (int j = 0; j < Arm::kDof; ++j) q[j] = rows.q[j][lane];
    if (Arm::kRefined || Refinement::refine(q, pose)) add(out, q, (bits(rows, lane) & kSingular) != 0);
  }

 private:
  static int bits(const Rows& rows, int lane) noexcept { return static_cast<int>(rows.flags[lane]); }

  // Adds a right row, as singular where it is one of a continuum or next to it.
  static void add(Solutions& out, const double* q, bool marked) noexcept {
    Row::add(out, q, RankLoss<Arm>::below(q, marked ? Policy::kContinuumRankLoss : Policy::kRankLoss));
  }

  // The distinct solutions of a pose, refined where the closed form lost digits. Whether it left a joint free.
  [[gnu::always_inline]] static bool find_rows(const Eigen::Isometry3d& pose, const double* q0, const Options& options,
                                               Solutions& out) noexcept {
    Rows rows;
    find_lanes(pose, q0, options, rows);
    out.count = 0;
    double q[Arm::kDof];
    bool hit = false;
    for (const int lane : Arm::kLaneOfRow) hit = hit || (bits(rows, lane) & kHit) != 0;
    if (hit) {
      std::copy_n(q0, Arm::kDof, q);
      if (Refinement::refine(q, pose)) add(out, q, true);
    }
    for (const int lane : Arm::kLaneOfRow)
      if ((bits(rows, lane) & kReal) != 0 && (Arm::kRefined || (bits(rows, lane) & kRough) != 0))
        add_refined(pose, rows, lane, out);
    for (const int lane : Arm::kLaneOfRow) {
      if (Arm::kRefined || (bits(rows, lane) & (kReal | kRough)) != kReal) continue;
      for (int j = 0; j < Arm::kDof; ++j) q[j] = rows.q[j][lane];
      Row::add(out, q, false);
    }
    return hit;
  }
};

}  // namespace ikgen_runtime
