// A direction or a heading: see pose_reading.hpp.
#pragma once

#include <cmath>

#include "pose_reading.hpp"

namespace ikgen_runtime {

// A unit vector: N entries from `First` on. A heading (N = 2) may be shorter, as that of a tilted tool, which
// nothing reaches.
template <class Policy, int First, int N> struct VectorReading {
  static constexpr double kMost = kMostDefect<Policy, N>;

  static double defect(const double* t) noexcept {
    const double gap = square(t) - 1.0;
    return N == 2 && gap < 0.0 && gap * gap > kMost ? 0.0 : gap * gap;
  }
  static bool proper(const double* t) noexcept { return square(t) > 0.0; }
  static void clean(double* t) noexcept {
    const double length = std::sqrt(square(t));
    for (int i = First; i < First + N; ++i) t[i] /= length;
  }

 private:
  static double square(const double* t) noexcept {
    double sum = 0.0;
    for (int i = First; i < First + N; ++i) sum += t[i] * t[i];
    return sum;
  }
};

}  // namespace ikgen_runtime
