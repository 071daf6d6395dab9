// Newton steps of all rows at once on the file's own chain.
#pragma once

#include "arm/joint_range.hpp"
#include "arm/lane_aim.hpp"
#include "arrays/lane_blocks.hpp"
#include "arm/lane_chain.hpp"
#include "rows/lane_rows.hpp"
#include "arm/moving_joints.hpp"

namespace ikgen_runtime {

// The least squares solution of V d = e in lanes by V = Q R (modified Gram-Schmidt), the columns of Q as long as they come:
// the diagonal of R is 1.
template <int Rows, int Columns, int N> struct LaneFactors {
  Lanes<N> V[Rows][Columns], R[Columns][Columns], inverse[Columns];  // of the squared lengths of the columns of Q
  Lanes<N> pivot;  // the smallest of the lengths

  // Puts Q into the place of V.
  [[gnu::always_inline]] void factor() noexcept {
    Lanes<N> least = spread<N>(kInfinity);
    for (int k = 0; k < Columns; ++k) {
      Lanes<N> square = V[0][k] * V[0][k];
      for (int e = 1; e < Rows; ++e) square = square + V[e][k] * V[e][k];
      square = max(square, 1e-200);
      least = min(least, square);
      inverse[k] = 1.0 / square;
      for (int j = k + 1; j < Columns; ++j) {
        R[k][j] = V[0][k] * V[0][j];
        for (int e = 1; e < Rows; ++e) R[k][j] = R[k][j] + V[e][k] * V[e][j];
        R[k][j] = R[k][j] * inverse[k];
        for (int e = 0; e < Rows; ++e) V[e][j] = V[e][j] - R[k][j] * V[e][k];
      }
    }
    pivot = sqrt(least);
  }

  // d; e is left with what no d takes away.
  [[gnu::always_inline]] void solve(Lanes<N> (&e)[Rows], Lanes<N> (&d)[Columns]) const noexcept {
    for (int k = 0; k < Columns; ++k) {
      d[k] = V[0][k] * e[0];
      for (int i = 1; i < Rows; ++i) d[k] = d[k] + V[i][k] * e[i];
      d[k] = d[k] * inverse[k];
      for (int i = 0; i < Rows; ++i) e[i] = e[i] - d[k] * V[i][k];
    }
    for (int k = Columns - 1; k >= 0; --k)
      for (int j = k + 1; j < Columns; ++j) d[k] = d[k] - R[k][j] * d[j];
  }

  // What the product of the two smallest singular values is at least: over the inverse's ones, X, the sum of all such
  // products is (tr(X X^T)^2 - tr((X X^T)^2)) / 2.
  Lanes<N> least_product() const noexcept {
    Lanes<N> X[Columns][Columns], sum = spread<N>(0.0), squares = sum;
    for (int j = 0; j < Columns; ++j) {
      X[j][j] = sqrt(inverse[j]);
      for (int i = j - 1; i >= 0; --i) {
        X[i][j] = -(R[i][i + 1] * X[i + 1][j]);
        for (int k = i + 2; k <= j; ++k) X[i][j] = X[i][j] - R[i][k] * X[k][j];
      }
    }
    for (int i = 0; i < Columns; ++i)
      for (int j = 0; j <= i; ++j) {
        Lanes<N> inner = spread<N>(0.0);
        for (int k = i; k < Columns; ++k) inner = inner + X[i][k] * X[j][k];
        if (i == j) sum = sum + inner;
        squares = squares + (i == j ? 1.0 : 2.0) * (inner * inner);
      }
    return sqrt(2.0 / max(sum * sum - squares, 1e-200));
  }
};

// Arm: as for LaneChain, LaneAim and MovingJoints; Task; kSize; Rows<P>; Policy; kBlocks, the joints in the order of
// LaneBlocks, or none.
template <class Arm> struct LaneNewton {
  using Policy = typename Arm::Policy;
  template <int P> using Rows = typename Arm::template Rows<P>;
  static constexpr MovingJoints<Arm> kJoints{};
  static constexpr int kTask = Arm::Task::kCount, kEquations = kTask + LaneAim<Arm, 1>::kCount;
  static constexpr int kMoving = MovingJoints<Arm>::kCount;
  static_assert(kMoving <= kEquations);
  static constexpr bool kBlocks = !Arm::kBlocks.empty();
  static constexpr double kRoundOff = 1e-14;  // of errors (rad, or m over the arm's size)
  static constexpr double kUnmoved = 1e-3;  // of the pivot: rows that are moved by less stay the solutions that they are
  template <int N> using Factors = std::conditional_t<kBlocks, LaneBlocks<N>, LaneFactors<kEquations, kMoving, N>>;

  // Refines the rows that are real, and puts them into the range. What is not shown to be the one solution near its
  // start, or may not be, stays rough. Rows that take a long first step show it by the product of their two smallest singular
  // values; with a share all do, by so much of that.
  template <int P>
  static void refine(const Pose<P>& pose, const std::array<double, Arm::kFree>& held, const Range& range,
                     Rows<P>& rows, double share = 0.0) noexcept {
    constexpr int N = Rows<P>::kLanes < kNative ? Rows<P>::kLanes : kNative;
    const LaneAim<Arm, N> aim(pose, held);
    for (int at = 0; at < Rows<P>::kLanes; at += N) {
      alignas(64) double given[std::size_t{N}];
      int any = 0;
      for (int i = 0; i < N; ++i) {
        const int bits = rows.bits(at + i);
        given[i] = (bits & kReal) != 0 ? bits & (kReal | kDoubt) : 0;
        any |= bits & (kReal | kHit);
      }
      if (any == 0) continue;
      const auto flags = bit((any & kHit) != 0 ? spread<N>(1.0) > 0.0 : spread<N>(-1.0) > 0.0, kHit);
      refine_pack<P, N>(pose, aim, range, at, load<N>(given), flags, rows, share);
    }
  }

  // The joint of a column of the slope.
  static constexpr int column(int i) noexcept {
    if constexpr (kBlocks) {
      return Arm::kBlocks[static_cast<std::size_t>(i)];
    } else {
      return kJoints[i];
    }
  }

  // The error at the chain's tip, and with `fresh` its slope.
  template <int P, int N, class Slope>
  static void compare(const Pose<P>& pose, const LaneAim<Arm, N>& aim, const LaneChain<Arm, N>& chain, bool fresh,
                      Lanes<N> (&error)[kEquations], Slope& to) noexcept {
    Lanes<N> t[3][4], slope[kEquations][Arm::kDof];
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c) t[r][c] = spread<N>(pose.t[r][c]);
    Arm::Task::error(t, chain.tip, error);
    if constexpr (kEquations > kTask) aim.compare(error[kTask], slope[kTask]);
    if (!fresh) return;
    Lanes<N> J[6][Arm::kDof];
    chain.jacobian(J);
    Arm::Task::slope(chain.tip, J, slope);
    for (int e = 0; e < kEquations; ++e)
      for (int i = 0; i < kMoving; ++i) to.V[e][i] = slope[e][column(i)];
  }

 private:
  template <int P, int N, bool H, bool F>
  static void refine_pack(const Pose<P>& pose, const LaneAim<Arm, N>& aim, const Range& range, int at,
                          const LanesOf<N, H>& given, const LanesOf<N, F>& flags, Rows<P>& rows, double share) noexcept {
    const Mask<N> doubt = given > 0.5 + double{kReal}, started = given > 0.5;
    LaneChain<Arm, N> chain;
    for (int j = 0; j < Arm::kDof; ++j) chain.q[j] = load<N>(rows.q[j] + at);
    const Arrival<N> at_end = steps<P, N>(pose, aim, started, share, chain);
    const Mask<N> real = started & (doubt | (!at_end.beside)), good = at_end.good & !doubt;
    Lanes<N> off = spread<N>(0.0);
    for (int j = 0; j < Arm::kDof; ++j) {
      Lanes<N> q = chain.q[j];
      constexpr auto& period = Arm::kPeriod;
      const bool turns = period[j] > 0.0 && !Arm::kHeld[j];
      if (turns) q = shortest(q, period[j]);
      const Placed<N> placed = turns ? place<Policy>(j, q, range, period[j]) : clamp(j, q, range);
      off = max(off, placed.off);
      store(select(good, placed.q, load<N>(rows.q[j] + at)), rows.q[j] + at);
    }
    const auto found = bit(real, kReal) + bit(good & is_inside<Policy>(off), kFound);
    store(found + (bit(real & ((!good) | hardly_outside<Policy>(off)), kRough) + flags), rows.flags + at);
  }

  // Which lanes arrived at the one solution near their start, and which at a least error that is not 0.
  template <int N> struct Arrival {
    Mask<N> good, beside;
  };

  template <std::size_t M, int N> static Lanes<N> largest(const Lanes<N> (&x)[M]) noexcept {
    Lanes<N> out = abs(x[0]);
    for (std::size_t i = 1; i < M; ++i) out = max(out, abs(x[i]));
    return out;
  }

  // Steps until all lanes are done, or as many as there may be.
  template <int P, int N>
  static Arrival<N> steps(const Pose<P>& pose, LaneAim<Arm, N> aim, const Mask<N>& real, double share,
                          LaneChain<Arm, N>& chain) noexcept {
    Factors<N> factors{};
    Lanes<N> before = spread<N>(Policy::kFarthestStart), rest = before;
    Mask<N> good = real, done = !real, strained = done;
    chain.start();
    aim.start(chain.q);
    for (int k = 0; k < Policy::kLaneSteps; ++k) {
      Lanes<N> error[kEquations], d[kMoving], step[Arm::kDof];
      chain.forward();
      // derivatives stay behind a step so short that the next by them is the last, or was meant to be
      const bool fresh = k == 0 || !all((!good) | ((k == 1 ? 0.1 : 1.0) * Policy::kNear > before));
      compare<P, N>(pose, aim, chain, fresh, error, factors);
      if (fresh) factors.factor();
      const Lanes<N> worst = largest(error);
      factors.solve(error, d);
      const Lanes<N> size = largest(d);
      // steps that are round-off; those near singularities are as much longer as these enlarge it
      const Mask<N> still = (Policy::kConverged > size) | ((kRoundOff > worst) & (kUnmoved * factors.pivot > size));
      // Newton's method contracts this fast only near the one solution there (Deuflhard 2004, theorem 2.1)
      const Lanes<N> bound = k == 0 ? before : Policy::kContraction * before;
      if (k == 0) strained = real & (size > Policy::kPivotShare * factors.pivot) & !still;
      good = good & ((bound > size) | still) & (factors.pivot > Policy::kLeastPivot);
      for (auto& none : step) none = spread<N>(0.0);
      for (int i = 0; i < kMoving; ++i) step[column(i)] = select(good, d[i], 0.0);
      chain.add(step);
      rest = largest(error);
      if (k > 0) {
        // over the square of the step before; what was small in it may be a hundred times as much in the next
        const Lanes<N> next = (fresh ? 100.0 * size : before) * (size * size);
        done = (!good) | (Policy::kConverged * (before * before) > next) | still;
        if (all(done)) break;
      }
      chain.turn(step);
      aim.move(step);
      before = size;
    }
    const Mask<N> ended = good & done, remote = rest > Policy::kLeastMiss;
    Mask<N> sure = !(share > 0.0 ? real : strained);
    if (!all((!ended) | sure)) sure = sure | stands_alone<P, N>(pose, aim, chain, share > 0.0 ? share : 1.0);
    return {ended & (Policy::kArrived > rest) & sure, ended & remote & !strained};
  }

  // Beside which rows nothing can have come in. Along the direction in which the pose moves least, by s1, what the file
  // is off by turns the others by that over s2 at most, the next singular value; only where this is as much as s1 may the
  // pose come to rest once more.
  template <int P, int N>
  static Mask<N> stands_alone(const Pose<P>& pose, const LaneAim<Arm, N>& aim, const LaneChain<Arm, N>& chain,
                              double share) noexcept {
    LaneFactors<kEquations, kMoving, N> factors;
    Lanes<N> error[kEquations];
    compare<P, N>(pose, aim, chain, true, error, factors);
    factors.factor();
    return factors.least_product() > share * Policy::kFoldProduct;
  }
};

}  // namespace ikgen_runtime
