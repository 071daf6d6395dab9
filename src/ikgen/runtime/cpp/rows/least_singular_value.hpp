// The smallest singular value of the task's Jacobian, in lanes.
#pragma once

#include <algorithm>

#include "arm/motion_chain.hpp"
#include "arm/moving_joints.hpp"
#include "arrays/lanes.hpp"
#include "arrays/small_matrix.hpp"

namespace ikgen_runtime {

// Arm: as for PoseError. Rows of lengths are not over the arm's size.
template <class Arm, int N> struct LeastSingularValue {
  using Pack = Lanes<N>;

  // From the least eigenvalue of J J^T, or of J^T J where that is smaller.
  static Pack of(const Pack (&q)[Arm::kDof]) noexcept {
    Pack J[6][Arm::kDof], slope[kRows][Arm::kDof], S[kOrder][kOrder];
    const FrameOf<Pack> T = MotionChain<AllMoving<Arm>>::forward(q, J);
    Arm::Task::slope(T, J, slope);
    for (int a = 0; a < kRows; ++a)
      if (Arm::kWholePose ? a < 3 : Arm::kRead[a][1] == 3)
        for (Pack& x : slope[a]) x = Arm::kSize * x;
    for (int a = 0; a < kOrder; ++a)
      for (int b = 0; b <= a; ++b) {
        S[a][b] = spread<N>(0.0);
        for (int k = 0; k < (kByRows ? Arm::kDof : kRows); ++k)
          S[a][b] = S[a][b] + (kByRows ? slope[a][k] * slope[b][k] : slope[k][a] * slope[k][b]);
        S[b][a] = S[a][b];
      }
    if constexpr (kDependent) Arm::Task::fill(T, kFar, S);
    if constexpr (kInPlane) return sqrt(max(eigenvalue<kOrder - kRank>(S), 0.0));
    Pack diagonal[kOrder], squares[kOrder];
    reduce(S, diagonal, squares);
    return sqrt(least_root(diagonal, squares));
  }

  // Of `count` rows, row(k) each.
  template <class Row> static void of_rows(int count, const Row& row, double* out) noexcept {
    for (int k = 0; k < count; k += N) {
      double values[N];
      Pack q[Arm::kDof];
      for (int j = 0; j < Arm::kDof; ++j) {
        for (int i = 0; i < N; ++i) values[i] = row(k + i < count ? k + i : k)[j];
        q[j] = load<N>(values);
      }
      store(of(q), values);
      std::copy_n(values, std::min(N, count - k), out + k);
    }
  }

 private:
  static constexpr int kRows = Arm::Task::kCount, kLess = Arm::kDof < kRows ? Arm::kDof : kRows, kSteps = 40;
  static constexpr int kRank = AllMoving<Arm>::kRank;
  static constexpr bool kInPlane =  // all joints move fewer freedoms
      kRank < kLess && (Arm::kWholePose || kRank < kRows - Arm::Columns::kRelations);
  static constexpr bool kDependent = !kInPlane && kRank < kLess;  // rows
  static constexpr int kOrder = kDependent ? kRows : kLess;
  static constexpr bool kByRows = kOrder == kRows;
  static constexpr double kFar = 1e4;  // above the least

  // To tridiagonal form (Householder 1958): its diagonal, and the squares of what is beside that, from place 1 on.
  static void reduce(Pack (&S)[kOrder][kOrder], Pack (&diagonal)[kOrder], Pack (&squares)[kOrder]) noexcept {
    squares[0] = spread<N>(0.0);
    for (int k = 0; k < kOrder; ++k) {
      diagonal[k] = S[k][k];
      if (k + 1 == kOrder) return;
      Pack v[kOrder], w[kOrder], length = spread<N>(0.0), product = length;
      for (int i = k + 1; i < kOrder; ++i) {
        v[i] = S[i][k];
        length = length + v[i] * v[i];
      }
      squares[k + 1] = length;
      if (k + 2 == kOrder) continue;
      const Pack root = sqrt(length), turned = select(v[k + 1] > 0.0, root, -root);
      const Pack scale = 1.0 / max(length + abs(v[k + 1]) * root, 1e-300);
      v[k + 1] = v[k + 1] + turned;
      for (int i = k + 1; i < kOrder; ++i) {
        w[i] = spread<N>(0.0);
        for (int j = k + 1; j < kOrder; ++j) w[i] = w[i] + S[i][j] * v[j];
        w[i] = scale * w[i];
        product = product + w[i] * v[i];
      }
      product = 0.5 * scale * product;
      for (int i = k + 1; i < kOrder; ++i) w[i] = w[i] - product * v[i];
      for (int i = k + 1; i < kOrder; ++i)
        for (int j = k + 1; j <= i; ++j) {
          S[i][j] = S[i][j] - (v[i] * w[j] + w[i] * v[j]);
          S[j][i] = S[i][j];
        }
    }
  }

  // Laguerre's method from 0: where no root is below 0 its steps come to the least from the left, cubed where it is alone, and
  // each by less of the one before.
  static Pack least_root(const Pack (&diagonal)[kOrder], const Pack (&squares)[kOrder]) noexcept {
    Pack x = spread<N>(0.0), last = x;
    for (int i = 0; i < kSteps; ++i) {
      Pack p = diagonal[0] - x, before = spread<N>(1.0), d = spread<N>(-1.0), d_before = spread<N>(0.0), h = d_before, h_before = h;
      for (int k = 1; k < kOrder; ++k) {
        const Pack at = diagonal[k] - x;
        const Pack next = at * p - squares[k] * before, d_next = at * d - p - squares[k] * d_before;
        const Pack h_next = at * h - 2.0 * d - squares[k] * h_before;
        before = p;
        d_before = d;
        h_before = h;
        p = next;
        d = d_next;
        h = h_next;
      }
      constexpr double n = kOrder;
      const auto left = (p > 0.0) & (0.0 > d);  // of all roots
      const Pack over = 1.0 / select(left, p, 1.0), g = -d * over;
      const Pack step = n / (g + sqrt((n - 1.0) * ((n - 1.0) * g * g - n * h * over)));
      x = x + select(left, step, 0.0);
      if (all(!(left & (step * step > 1e-15 * x * last)))) break;
      last = step;
    }
    return x;
  }
};

}  // namespace ikgen_runtime
