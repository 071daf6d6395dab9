// A direction or a heading: see pose_reading.hpp.
#pragma once

#include <algorithm>
#include <cmath>

namespace ikgen_runtime {

// The unit vector of N entries from `First` on. Only a direction's own length says that it is none: that of a
// heading (N = 2) is the cosine of the axis' elevation.
template <int First, int N> struct VectorReading {
  static constexpr int kEntries = N;

  static double error(const double* t) noexcept { return std::abs(square(t) - 1.0); }

  static double clean(double* t) noexcept {
    const double length = std::sqrt(square(t)), off = N == 2 ? std::max(length - 1.0, 0.0) : length - 1.0;
    for (int i = First; i < First + N; ++i) t[i] /= length;
    return off * off;
  }

 private:
  static double square(const double* t) noexcept {
    double sum = 0.0;
    for (int i = First; i < First + N; ++i) sum += t[i] * t[i];
    return sum;
  }
};

}  // namespace ikgen_runtime
