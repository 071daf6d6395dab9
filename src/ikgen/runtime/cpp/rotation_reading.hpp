// A whole rotation: see pose_reading.hpp.
#pragma once

#include <cmath>

namespace ikgen_runtime {

struct RotationReading {
  static constexpr int kEntries = 9;

  // 0 where the first rows are orthonormal and the third is their cross product.
  static double error(const double* t) noexcept {
    const double a = t[0], b = t[4], c = t[8], d = t[1], e = t[5], f = t[9];
    return (std::abs(a * a + b * b + c * c - 1.0) + std::abs(d * d + e * e + f * f - 1.0)) +
           (std::abs(a * d + b * e + c * f) + std::abs(b * f - c * e - t[2])) +
           (std::abs(c * d - a * f - t[6]) + std::abs(a * e - b * d - t[10]));
  }

  // Steps R (3 - R^T R) / 2 of the iteration to the orthogonal polar factor (Bjorck & Bowie 1971), each of which
  // squares the error: from 1e-6 to round-off in two.
  static double clean(double* t) noexcept {
    double moved = 0.0;
    for (int step = 0; step < 2; ++step) {
      double R[3][3];
      for (int i = 0; i < 9; ++i) R[i / 3][i % 3] = t[i + i / 3];
      for (int i = 0; i < 3; ++i)
        for (int r = 0; r < 3; ++r) {
          double x = 1.5 * R[i][r];
          for (const auto& column : R)
            x -= 0.5 * (R[i][0] * column[0] + R[i][1] * column[1] + R[i][2] * column[2]) * column[r];
          moved += (x - R[i][r]) * (x - R[i][r]);
          t[4 * i + r] = x;
        }
    }
    return moved;
  }
};

}  // namespace ikgen_runtime
