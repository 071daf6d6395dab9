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

  // From the largest eigenvalue of (J J^T)^-1, or (J^T J)^-1 where that is smaller: squared again and again it becomes the
  // projection onto its vector. Rows of lengths are not over the arm's size.
  static double smallest_singular_value(const double* q) noexcept {
    constexpr int e = PoseError<AllMoving<A>>::kCount, n = A::kDof < e ? A::kDof : e;
    PoseError<AllMoving<A>> at(q, HeldAim<AllMoving<A>>::own(q));
    for (int a = 0; a < e; ++a)
      if (A::kWholePose ? a < 3 : A::kRead[a][1] == 3)
        for (double& x : at.slope[a]) x *= A::kSize;
    double N[n][n], M[n][n], v[n];
    for (int a = 0; a < n; ++a)
      for (int b = 0; b <= a; ++b) {
        N[a][b] = 0.0;
        for (int k = 0; k < (n == e ? A::kDof : e); ++k)
          N[a][b] += n == e ? at.slope[a][k] * at.slope[b][k] : at.slope[k][a] * at.slope[k][b];
      }
    factor(N);
    double trace = 0.0;
    for (int a = 0; a < n; ++a) {
      for (int b = 0; b < n; ++b) M[a][b] = a == b ? 1.0 : 0.0;
      substitute(N, M[a]);
      trace += M[a][a];
    }
    for (int i = 0; i < kSquarings && !(i > 0 && trace > 1.0 - 1e-14); ++i) trace = square(M, 1.0 / trace);
    int best = 0;
    for (int a = 1; a < n; ++a)
      if (M[a][a] > M[best][best]) best = a;
    double length = 0.0, growth = 0.0;
    std::copy_n(M[best], n, v);
    for (const double x : v) length += x * x;
    substitute(N, v);
    for (int a = 0; a < n; ++a) growth += M[best][a] * v[a];
    return std::sqrt(std::max(length / growth, 0.0));
  }

 private:
  static constexpr int kSquarings = 24;  // or fewer: until nothing else is left

  // M = (scale M)^2, of a symmetric M; its trace, 1 once M is the projection onto one vector.
  template <int N> static double square(double (&M)[N][N], double scale) noexcept {
    double S[N][N], trace = 0.0;
    for (auto& row : M)
      for (double& x : row) x *= scale;
    for (int a = 0; a < N; ++a)
      for (int b = 0; b <= a; ++b) {
        S[a][b] = 0.0;
        for (int k = 0; k < N; ++k) S[a][b] += M[a][k] * M[b][k];
        S[b][a] = S[a][b];
      }
    for (int a = 0; a < N; ++a) trace += S[a][a];
    std::copy_n(&S[0][0], N * N, &M[0][0]);
    return trace;
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
