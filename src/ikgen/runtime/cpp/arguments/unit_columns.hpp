#pragma once

#include <cmath>

namespace ikgen_runtime {

// The columns of the rotation that a task reads, `Count` of them from `First` on: unit vectors at right angles, as
// far as they are read, to `Height`. A heading (Height = 2) may be shorter than 1, as that of a tilted tool, which
// nothing reaches. t: the pose's matrix, columns first.
template <int First, int Count, int Height> struct UnitColumns {
  static constexpr bool kFlat = Count > 0 && Height == 2;
  static constexpr int kRelations = Count * (Count + 1) / 2;  // between their entries

  // The defect of columns whose entries are each off by `off`: |V^T V - 1| <= 2 |E| + |E|^2, E what they are off by.
  static constexpr double most_defect(double off) noexcept {
    return 4.0 * Count * Height * off * off * (1.0 + 2.0 * Count * Height * off);
  }

  // Whether it is a heading whose squared length is at most so much short of 1.
  static bool level(const double* t, double most) noexcept {
    return kFlat && dot(t + 4 * First, t + 4 * First) <= 1.0 && dot(t + 4 * First, t + 4 * First) >= 1.0 - most;
  }

  // What takes a heading's entries to unit length that is a little shorter.
  template <class X, class R> static X unit(const R& rotation) noexcept {
    if constexpr (kFlat) {
      const X x = rotation[0][First], y = rotation[1][First];
      const X less = 1.0 - (x * x + y * y);
      return 1.0 + less * (0.5 + less * (0.375 + 0.3125 * less));
    } else {
      return X{};
    }
  }

  static constexpr bool has(int column) noexcept { return First <= column && column < First + Count; }

  // Squared Frobenius norm of V^T V - 1.
  static double defect(const double* t) noexcept {
    double sum = 0.0;
    for (int i = First; i < First + Count; ++i)
      for (int j = First; j <= i; ++j) {
        const double gap = dot(t + 4 * i, t + 4 * j) - (i == j ? 1.0 : 0.0);
        sum += (i == j ? 1.0 : 2.0) * gap * gap;
      }
    return sum;
  }

  // Whether columns of small defect are a rotation's.
  static bool proper(const double* t) noexcept {
    if (Count < 3) return true;
    const double x = t[1] * t[6] - t[2] * t[5], y = t[2] * t[4] - t[0] * t[6], z = t[0] * t[5] - t[1] * t[4];
    return x * t[8] + y * t[9] + z * t[10] > 0.0;
  }

  static bool tilted(const double* t) noexcept {
    return Height == 2 && dot(t + 4 * First, t + 4 * First) > 0.0 && dot(t + 4 * First, t + 4 * First) < 1.0;
  }

  // Puts the nearest (Frobenius) in their place: steps V (3 - V^T V) / 2 of the iteration to the orthogonal polar
  // factor (Bjorck & Bowie 1971), each of which squares the error: from 1e-5 to round-off in two.
  static void clean(double* t) noexcept {
    for (int step = 0; step < 2; ++step) {
      double V[12];
      for (int i = 0; i < 12; ++i) V[i] = t[i];
      for (int i = 4 * First; i < 4 * (First + Count); i += 4) {
        for (int r = 0; r < Height; ++r) t[i + r] = 1.5 * V[i + r];
        for (int j = 4 * First; j < 4 * (First + Count); j += 4) {
          const double half = 0.5 * dot(V + i, V + j);
          for (int r = 0; r < Height; ++r) t[i + r] -= half * V[j + r];
        }
      }
    }
  }

 private:
  static double dot(const double* u, const double* v) noexcept {
    return u[0] * v[0] + u[1] * v[1] + (Height == 2 ? 0.0 : u[2] * v[2]);
  }
};

}  // namespace ikgen_runtime
