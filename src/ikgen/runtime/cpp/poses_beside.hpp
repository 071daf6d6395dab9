#pragma once

#include "careful_solve.hpp"
#include "displacement.hpp"

namespace ikgen_runtime {

// Rows of poses beside the one that is asked for: near folds those have rows that the pose has not.
// Arm: as for CarefulSolve; kBeside, motions of the tool.
template <class Arm> struct PosesBeside {
  // Adds their rows, brought to the pose; q0 gives the values of joints that a pose leaves free.
  [[gnu::noinline]] static void add(const Eigen::Isometry3d& pose, const double* q0,
                                    const typename Arm::Options& options, typename Arm::Solutions& out) noexcept {
    for (const Displacement& motion : Arm::kBeside) {
      typename Arm::template Rows<1> rows;
      CarefulSolve<Arm>::find_lanes(displaced(pose, motion), q0, options, rows);
      for (const int lane : Arm::kLaneOfRow)
        if ((static_cast<int>(rows.flags[lane]) & kReal) != 0) CarefulSolve<Arm>::add_refined(pose, rows, lane, out);
    }
  }
};

}  // namespace ikgen_runtime
