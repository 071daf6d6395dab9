#pragma once

#include <cstddef>

#include "arrays/least_eigenvalue.hpp"
#include "rows/lane_rows.hpp"
#include "arm/moving_joints.hpp"
#include "arm/pose_error.hpp"

namespace ikgen_runtime {

// Arm: as for PoseError; kHeld, a flag a joint.
template <class Arm> struct SingularValue {
  static constexpr MovingJoints<Arm> kJoints{};
  static constexpr int kMoving = MovingJoints<Arm>::kCount, kEquations = PoseError<Arm>::kCount;
  static constexpr int kRank = kMoving < kEquations ? kMoving : kEquations;

  // Whether the slope V at q has a singular value below `bound`: V V^T - bound^2, or V^T V - bound^2 where that is
  // smaller, is not positive definite then.
  static bool below(const double* q, double bound) noexcept {
    const PoseError<Arm> at(q, HeldAim<Arm>::own(q));
    return !above(at.slope, bound);
  }

  // The same of all joints, which may be more than the freedoms that the task fixes, or move fewer of them.
  static bool redundant_below(const double* q, double bound) noexcept {
    if constexpr (Arm::kRank >= kRank) {
      return below(q, bound);
    } else if constexpr (Arm::kWholePose || Arm::kRank < kEquations - Arm::Columns::kRelations) {
      const PoseError<Arm> at(q, HeldAim<Arm>::own(q));
      Lanes<1> V[kEquations][kMoving], A[kRank][kRank];
      for (int e = 0; e < kEquations; ++e)
        for (int k = 0; k < kMoving; ++k) V[e][k] = spread<1>(at.slope[e][kJoints[k]]);
      take_products(V, A);
      return eigenvalue<kRank - Arm::kRank>(A).v < bound * bound;
    } else {
      double slope[kEquations][Arm::kDof], A[kEquations][kEquations];
      const Frame T = of_all_joints(q, slope);
      take_products(slope, A);
      shift_diagonal(-bound * bound, A);
      Arm::Task::fill(T, 1.0, A);
      factor(A);
      return !definite(A);
    }
  }

  // Whether there is a singularity between two configurations: where the determinant changes its sign, of arms that hold
  // no joint. To be asked of none at one.
  static bool between(const double* a, const double* b) noexcept {
    if (Arm::kFree > 0) return false;
    double here[kEquations][Arm::kDof], there[kEquations][Arm::kDof], M[Arm::kDof][Arm::kDof] = {};
    of_all_joints(a, here);
    of_all_joints(b, there);
    for (int e = 0; e < kEquations; ++e)
      for (int i = 0; i < Arm::kDof; ++i)
        for (int j = 0; j < Arm::kDof; ++j) M[i][j] += here[e][i] * there[e][j];
    return !keeps_orientation(M);
  }

  // Which rows in lanes are real and have no such value. Not for arms that hold the arm angle.
  template <class Rows> static void regular(const Rows& rows, double bound, bool (&out)[Rows::kLanes]) noexcept {
    constexpr int N = Rows::kLanes < kNative ? Rows::kLanes : kNative;
    static_assert(PoseError<Arm>::kTask == kEquations);
    for (int at = 0; at < Rows::kLanes; at += N) {
      bool any = false;
      for (int i = at; i < at + N; ++i) {
        out[i] = rows.has(i, kReal);
        any = any || out[i];
      }
      if (!any) continue;
      Lanes<N> q[Arm::kDof], J[6][Arm::kDof], slope[kEquations][Arm::kDof];
      for (int j = 0; j < Arm::kDof; ++j) q[j] = load<N>(rows.q[j] + at);
      Arm::Task::slope(MotionChain<Arm>::forward(q, J), J, slope);
      alignas(64) double remote[std::size_t{N}];
      store(above(slope, bound), remote);
      for (int i = 0; i < N; ++i) out[at + i] = out[at + i] && remote[i] > 0.5;
    }
  }

 private:
  // The task's slope by all joints, of arms that hold no arm angle; the tip.
  static Frame of_all_joints(const double* q, double (&slope)[kEquations][Arm::kDof]) noexcept {
    double J[6][Arm::kDof];
    const Frame tip = MotionChain<Arm>::forward(q, J);
    Arm::Task::slope(tip, J, slope);
    return tip;
  }

  template <class X> static auto above(const X (&slope)[kEquations][Arm::kDof], double bound) noexcept {
    X V[kEquations][kMoving], A[kRank][kRank];
    kJoints.columns(slope, V);
    if constexpr (kMoving < kEquations) {
      gram_of_columns(V, A);
    } else {
      gram_of_rows(V, A);
    }
    shift_diagonal(-bound * bound, A);
    factor(A);
    return definite(A);
  }
};

}  // namespace ikgen_runtime
