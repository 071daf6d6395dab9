#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "elimination/general_6r_frames.hpp"

namespace ikgen_runtime {

// --- general_6r: the solutions of a pose ------------------------------------------------------------

namespace elimination {

inline constexpr int kRoom = 64;  // a continuum gives more than the 16 that are apart

inline constexpr double kVerified = 0.5e-9;  // of the pose that a row reaches, lengths over the arm's
inline constexpr double kCoincidentRows = 1e-6;  // rad: closer ones are one

struct Solution {
  double q[6], c[6], s[6];  // angles in (-pi, pi], their cosines and sines; lengths of slides
};

struct Solutions {
  int count = 0;
  std::array<Solution, std::size_t{kRoom}> rows;
};

// Whether two configurations are one to within `reach` (rad); slides longer than any angle count relative to their
// length.
inline bool coincident(const double* a, const double* b, double reach = kCoincidentRows) noexcept {
  for (int i = 0; i < 6; ++i) {
    double gap = std::abs(a[i] - b[i]);
    if (gap > 3.0) gap = std::abs(gap - 2.0 * kPi);
    if (!(gap < reach * (std::abs(a[i]) > 4.0 ? std::abs(a[i]) : 1.0))) return false;
  }
  return true;
}

inline bool holds(const Solutions& all, const double* q) noexcept {
  for (int k = 0; k < all.count; ++k)
    if (coincident(q, all.rows[static_cast<Index>(k)].q)) return true;
  return false;
}

// Adds a row unless it is there already or there is no room; whether it did.
inline bool keep(const Solution& row, Solutions& out) noexcept {
  if (out.count == kRoom || holds(out, row.q)) return false;
  out.rows[static_cast<Index>(out.count++)] = row;
  return true;
}

// Sorts the rows by their first difference, so that the order does not hang on how they were found. The turn is
// cut at -1 rad, where no right angle lies.
inline void sort_rows(const Turning& turning, Solutions& out) noexcept {
  const auto key = [&](double x, int i) {
    return turning[static_cast<Index>(i)] && x + 1.0 < 0.0 ? x + 1.0 + 2.0 * kPi : x + 1.0;
  };
  const auto before = [&](const Solution& a, const Solution& b) {
    for (int i = 0; i < 6; ++i) {
      const double gap = key(a.q[i], i) - key(b.q[i], i);
      if (std::abs(gap) > 1e-7) return gap < 0.0;
    }
    return false;
  };
  const Index count = static_cast<Index>(out.count);
  for (Index n = 1; n < count; ++n) {
    Index at = n;
    while (at > 0 && before(out.rows[n], out.rows[at - 1])) --at;
    if (at < n) std::rotate(out.rows.data() + at, out.rows.data() + n, out.rows.data() + n + 1);
  }
}

}  // namespace elimination
}  // namespace ikgen_runtime
