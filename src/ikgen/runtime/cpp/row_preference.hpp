// Which rows are better than others.
#pragma once

#include "path_following.hpp"
#include "solution_rows.hpp"

namespace ikgen_runtime {

// A: as for PoseError and SolutionRows; Prefer, its preferences.
template <class A> struct RowPreference {
  using Prefer = typename A::Prefer;
  typename A::Joints wanted;
  double weight[A::kDof];
  typename A::Options options;
  Prefer prefer;

  // Near to the seed, or the middle of the limits, without a seed too. The object must not be moved.
  RowPreference(const double* seed, Prefer kind, bool limits) noexcept : prefer(kind) {
    if (seed && !SolutionRows<A>::finite(seed)) seed = nullptr;
    for (int j = 0; j < A::kDof; ++j) {
      const double low = A::kLower.data()[j], high = A::kUpper.data()[j];
      const bool bounded = high - low < kInfinity, near = kind == Prefer::Near && seed;
      const double half = std::max(0.5 * (high - low), 1e-6);
      wanted.data()[j] = bounded && !near ? 0.5 * (low + high) : seed ? seed[j] : 0.0;
      weight[j] = near ? 1.0 : bounded ? 1.0 / (half * half) : 0.0;
    }
    options.limits = limits;
    options.seed = &wanted;
  }
  RowPreference(const RowPreference&) = delete;

  // Puts a row on the turns that limits and preference ask for; false where it is outside the limits.
  bool place(double* q) const noexcept {
    for (int j = 0; j < A::kDof; ++j)
      if (A::kHeld[j] && A::kRevolute[j] && !(A::kUpper.data()[j] - A::kLower.data()[j] < kInfinity))
        q[j] += kTurn * std::nearbyint((wanted.data()[j] - q[j]) / kTurn);
    return SolutionRows<A>::place(q, options);
  }

  // Less is better: the squared distance, or minus the smallest singular value of the task's Jacobian.
  double cost(const double* q) const noexcept {
    if (prefer == Prefer::Dexterous) return -smallest_singular_value(q);
    double sum = 0.0;
    for (int j = 0; j < A::kDof; ++j) sum += weight[j] * (q[j] - wanted.data()[j]) * (q[j] - wanted.data()[j]);
    return sum;
  }

  // By inverse iteration on J J^T, or J^T J where that is smaller; rows of lengths are not over the arm's size.
  static double smallest_singular_value(const double* q) noexcept {
    constexpr int e = PoseError<AllMoving<A>>::kCount, n = A::kDof < e ? A::kDof : e;
    PoseError<AllMoving<A>> at(q, Eigen::Isometry3d::Identity());
    for (int a = 0; a < e; ++a)
      if (A::kWholePose ? a < 3 : A::kRead[a][1] == 3)
        for (double& x : at.slope[a]) x *= A::kSize;
    double N[n][n], v[n];
    for (int a = 0; a < n; ++a) {
      for (int b = 0; b <= a; ++b) {
        N[a][b] = 0.0;
        for (int k = 0; k < (n == e ? A::kDof : e); ++k)
          N[a][b] += n == e ? at.slope[a][k] * at.slope[b][k] : at.slope[k][a] * at.slope[k][b];
      }
      v[a] = 1.0 + 0.1 * a;
    }
    factor(N);
    double value = kInfinity;
    for (int i = 0; i < 300; ++i) {
      double length = 0.0, growth = 0.0, old[n];
      for (const double x : v) length += x * x;
      for (int a = 0; a < n; ++a) old[a] = v[a] /= std::sqrt(length);
      substitute(N, v);
      for (int a = 0; a < n; ++a) growth += old[a] * v[a];
      const double here = 1.0 / growth;
      if (std::abs(value - here) <= 1e-14 * here) break;
      value = here;
    }
    return std::sqrt(std::max(value, 0.0));
  }
};

// Rows of `solve`, best first. Solver: as for PathStep.
template <class A, class Solver>
inline void order_rows(const Eigen::Isometry3d& pose, const double* seed, typename A::Prefer prefer, bool limits,
                       typename A::Solutions& out) noexcept {
  const RowPreference<A> preference(seed, prefer, limits);
  typename A::Options options;
  typename A::Joints near;
  if (seed) {
    std::copy_n(seed, A::kDof, near.data());
    options.seed = &near;
  }
  options.limits = limits;
  Solver::solve(pose, options, out);
  for (int k = 0; k < out.count; ++k) preference.place(SolutionRows<A>::row(out, k));
  SolutionRows<A>::sort(out, [&](const double* q) noexcept { return preference.cost(q); });
}

}  // namespace ikgen_runtime
