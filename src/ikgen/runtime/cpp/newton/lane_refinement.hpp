// Damped Newton steps as in newton_refinement.hpp, of several starts at once.
#pragma once

#include "newton/damped_step.hpp"
#include "newton/lane_newton.hpp"
#include "newton/refinement_course.hpp"

namespace ikgen_runtime {

// Arm: as for LaneNewton.
template <class Arm> struct LaneRefinement {
  using Newton = LaneNewton<Arm>;
  using Policy = typename Arm::Policy;
  using Rows = typename Arm::template Rows<1>;
  static constexpr int N = Rows::kLanes < kNative ? Rows::kLanes : kNative;
  static constexpr int kEquations = Newton::kEquations, kMoving = Newton::kMoving;

  // Takes `count` lanes of rows along; the error that is left of each.
  static void run(const Pose<1>& pose, const std::array<double, Arm::kFree>& held, const int* lanes, int count,
                  Rows& rows, double* error) noexcept {
    for (int at = 0; at < count; at += N) {
      int taken[N];
      for (int i = 0; i < N; ++i) taken[i] = lanes[std::min(at + i, count - 1)];
      Pack(taken, rows).run(pose, held, error);
    }
  }

 private:
  // The slope by the joints that move.
  struct Slope {
    Lanes<N> V[kEquations][kMoving];
  };

  struct Pack {
    const int (&lanes)[N];
    Rows& rows;
    RefinementCourse<Policy> course[N];
    alignas(64) double trial[Arm::kDof][N];

    Pack(const int (&taken)[N], Rows& all) noexcept : lanes(taken), rows(all) {
      for (int i = 0; i < N; ++i) start(i);
    }

    void start(int i) noexcept {
      for (int j = 0; j < Arm::kDof; ++j) trial[j][i] = rows.q[j][lanes[i]];
    }

    void run(const Pose<1>& pose, const std::array<double, Arm::kFree>& held, double* error) noexcept {
      LaneAim<Arm, N> aim(pose, held);
      while (true) {
        LaneChain<Arm, N> chain;
        Slope slope;
        Lanes<N> left[kEquations], step[kMoving], worst;
        for (int j = 0; j < Arm::kDof; ++j) chain.q[j] = load<N>(trial[j]);
        chain.start();
        chain.forward();
        aim.start(chain.q);
        Newton::template compare<1, N>(pose, aim, chain, true, left, slope);
        worst = abs(left[0]);
        for (int e = 1; e < kEquations; ++e) worst = max(worst, abs(left[e]));
        bool again[N];
        if (!judge(worst, again)) break;
        damped_step<Policy>(slope.V, left, worst, step);
        for (int i = 0; i < kMoving; ++i) {
          double* q = trial[Newton::column(i)];
          store(load<N>(q) + step[i], q);
        }
        for (int i = 0; i < N; ++i)
          if (again[i]) start(i);
      }
      for (int i = 0; i < N; ++i) error[lanes[i]] = course[i].best;
    }

    // Keeps what is better. Whether some steps go on, and which of them from the best configuration again.
    bool judge(const Lanes<N>& worst, bool (&again)[N]) noexcept {
      alignas(64) double off[N];
      store(worst, off);
      bool any = false;
      for (int i = 0; i < N; ++i) {
        again[i] = course[i].done;
        if (course[i].done) continue;
        if (course[i].takes(off[i]))
          for (int j = 0; j < Arm::kDof; ++j) rows.q[j][lanes[i]] = trial[j][i];
        again[i] = course[i].starts_again();
        any = any || !course[i].done;
      }
      return any;
    }
  };
};

}  // namespace ikgen_runtime
