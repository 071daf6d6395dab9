#pragma once

#include "general_6r_circle.hpp"

namespace ikgen_runtime {

// --- general_6r: tables for arcs of the circle ------------------------------------------------------
// The circle is cut into 32 arcs, and an arc that needs it into eight, four times over. On an arc of width w about
// 0, a trigonometric polynomial has Bernstein coefficients of degree 16 in
// (sin((w/2 - t)/2), sin((t + w/2)/2)) / sin(w/2), for exp(i m t) is a product of (e, conj e)(exp(i t/2)).

namespace g6 {

inline constexpr int kArcs = 32;
inline constexpr int kParts = 8;
inline constexpr int kLevels = 4;  // of arcs cut from the first ones
inline constexpr double kArcWidth = 6.283185307179586476925 / kArcs;

template <int N>
struct Cut {  // cos and sin of m times the middles of N arcs side by side, about 0 but for the first
  alignas(64) double c[kDegree + 1][N], s[kDegree + 1][N];
};

struct Bernstein {  // coefficients of cos(m t) and sin(m t), the other halves by symmetry
  double even[kDegree + 1][kDegree + 1], odd[kDegree + 1][kDegree + 1];
};

struct Turn {
  long double c, s;
};

constexpr Turn turn_by(long double x) noexcept {  // |x| < 1
  long double term = 1.0L, c = 0.0L, s = 0.0L;
  for (int n = 1; n < 30; n += 2) {
    c += term;
    s += term * x / n;
    term *= -x * x / (n * (n + 1));
  }
  return {c, s};
}

constexpr Turn times(const Turn& a, const Turn& b) noexcept { return {a.c * b.c - a.s * b.s, a.s * b.c + a.c * b.s}; }

constexpr double binomial(int n, int r) noexcept {
  double out = 1.0;
  for (int i = 0; i < r; ++i) out = out * (n - i) / (i + 1);
  return out;
}

constexpr Bernstein make_bernstein(double width) noexcept {
  Turn half[kDegree * 2 + 1] = {};  // multiples of width/2
  half[0] = {1.0L, 0.0L};
  half[1] = turn_by(0.5L * static_cast<long double>(width));
  for (int k = 2; k <= kDegree * 2; ++k) half[k] = times(half[k - 1], half[1]);
  Bernstein out{};
  for (int m = 0; m <= kDegree; ++m)
    for (int q = 0; q <= kDegree; ++q) {
      long double even = 0.0L, odd = 0.0L;
      for (int j = 0; j <= q; ++j) {
        const int l = q - j, phase = j - l - m;
        if (l > kDegree - m) continue;
        const double share = binomial(kDegree + m, j) * binomial(kDegree - m, l) / binomial(2 * kDegree, q);
        const auto w = static_cast<long double>(share);
        even += w * half[phase < 0 ? -phase : phase].c;
        odd += w * (phase < 0 ? -half[-phase].s : half[phase].s);
      }
      out.even[m][q] = static_cast<double>(even);
      out.odd[m][q] = static_cast<double>(odd);
    }
  return out;
}

template <int N>
constexpr Cut<N> make_cut(double first, double width) noexcept {
  Cut<N> out{};
  for (int a = 0; a < N; ++a) {
    const long double angle = static_cast<long double>(first) + a * static_cast<long double>(width);
    const Turn quarter = turn_by(angle / 8);  // small enough for the series
    const Turn two = times(quarter, quarter), four = times(two, two), one = times(four, four);
    Turn now = {1.0L, 0.0L};
    for (int m = 0; m <= kDegree; ++m, now = times(now, one)) {
      out.c[m][a] = static_cast<double>(now.c);
      out.s[m][a] = static_cast<double>(now.s);
    }
  }
  return out;
}

constexpr double width_of(int level) noexcept {
  double out = kArcWidth;
  for (; level > 0; --level) out /= kParts;
  return out;
}

inline constexpr Cut<kArcs> kFirstCut = make_cut<kArcs>(0.5 * kArcWidth, kArcWidth);
inline constexpr Cut<kParts> kCuts[kLevels] = {
    make_cut<kParts>(-0.5 * (kParts - 1) * width_of(1), width_of(1)),
    make_cut<kParts>(-0.5 * (kParts - 1) * width_of(2), width_of(2)),
    make_cut<kParts>(-0.5 * (kParts - 1) * width_of(3), width_of(3)),
    make_cut<kParts>(-0.5 * (kParts - 1) * width_of(4), width_of(4)),
};
inline constexpr Bernstein kBernstein[kLevels + 1] = {make_bernstein(width_of(0)), make_bernstein(width_of(1)),
                                                      make_bernstein(width_of(2)), make_bernstein(width_of(3)),
                                                      make_bernstein(width_of(4))};
inline constexpr double kWidths[kLevels + 1] = {width_of(0), width_of(1), width_of(2), width_of(3), width_of(4)};

}  // namespace g6
}  // namespace ikgen_runtime
