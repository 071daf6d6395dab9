// A whole rotation: see pose_reading.hpp.
#pragma once

#include "pose_reading.hpp"

namespace ikgen_runtime {

template <class Policy> struct RotationReading {
  static constexpr double kMost = kMostDefect<Policy, 9>;

  static double defect(const double* t) noexcept {
    const double x = dot(t, t) - 1.0, y = dot(t + 4, t + 4) - 1.0, z = dot(t + 8, t + 8) - 1.0;
    const double xy = dot(t, t + 4), xz = dot(t, t + 8), yz = dot(t + 4, t + 8);
    return (x * x + y * y + z * z) + 2.0 * (xy * xy + xz * xz + yz * yz);
  }

  static bool proper(const double* t) noexcept {
    const double x = t[1] * t[6] - t[2] * t[5], y = t[2] * t[4] - t[0] * t[6], z = t[0] * t[5] - t[1] * t[4];
    return x * t[8] + y * t[9] + z * t[10] > 0.0;
  }

  // Steps R (3 - R^T R) / 2 of the iteration to the orthogonal polar factor (Bjorck & Bowie 1971), each of which
  // squares the error: from 1e-5 to round-off in two.
  static void clean(double* t) noexcept {
    for (int step = 0; step < 2; ++step) {
      double R[12];
      for (int i = 0; i < 12; ++i) R[i] = t[i];
      for (int v = 0; v < 12; v += 4) {
        for (int r = v; r < v + 3; ++r) t[r] = 1.5 * R[r];
        for (int u = 0; u < 12; u += 4) {
          const double half = 0.5 * dot(R + u, R + v);
          for (int r = 0; r < 3; ++r) t[v + r] -= half * R[u + r];
        }
      }
    }
  }

 private:
  static double dot(const double* u, const double* v) noexcept { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; }
};

}  // namespace ikgen_runtime
