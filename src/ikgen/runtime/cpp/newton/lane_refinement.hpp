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

  // Takes `count` lanes of rows along, numbered through all rows; the error that is left of each. A place in the pack
  // goes to the next lane as soon as it is done with one.
  static void run(const Pose<1>& pose, const std::array<double, Arm::kFree>& held, const int* lanes, int count,
                  Rows* rows, double* error) noexcept {
    if (count > 0) Pack{lanes, count, rows, error}.run(pose, held);
  }

 private:
  // The slope by the joints that move.
  struct Slope {
    Lanes<N> V[kEquations][kMoving];
  };

  struct Pack {
    const int* lanes;
    int count;
    Rows* rows;
    double* error;
    int next = 0, taken[N] = {};
    bool idle[N] = {};
    RefinementCourse<Policy> course[N] = {};
    alignas(64) double trial[Arm::kDof][N] = {};

    // A joint's value in a lane.
    double& value(int lane, int j) const noexcept { return rows[lane / Rows::kLanes].q[j][lane % Rows::kLanes]; }

    // Goes on from the best configuration of its lane.
    void start(int i) noexcept {
      for (int j = 0; j < Arm::kDof; ++j) trial[j][i] = value(taken[i], j);
    }

    // Goes to the next lane, if there is one.
    void take_next(int i) noexcept {
      idle[i] = next == count;
      if (idle[i]) return;
      taken[i] = lanes[next++];
      course[i] = {};
      start(i);
    }

    void run(const Pose<1>& pose, const std::array<double, Arm::kFree>& held) noexcept {
      LaneAim<Arm, N> aim(pose, held);
      for (int i = 0; i < N; ++i) take_next(i);
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
    }

    // Keeps what is better. Whether some steps go on, and which of them from the best configuration of their lane.
    bool judge(const Lanes<N>& worst, bool (&again)[N]) noexcept {
      alignas(64) double off[N];
      store(worst, off);
      bool any = false;
      for (int i = 0; i < N; ++i) {
        again[i] = idle[i];
        if (idle[i]) continue;
        if (course[i].takes(off[i]))
          for (int j = 0; j < Arm::kDof; ++j) value(taken[i], j) = trial[j][i];
        again[i] = course[i].starts_again();
        if (course[i].done) {
          error[taken[i]] = course[i].best;
          take_next(i);
        }
        any = any || !idle[i];
      }
      return any;
    }
  };
};

}  // namespace ikgen_runtime
