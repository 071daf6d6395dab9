#pragma once

#include "elimination/general_6r_circle.hpp"

namespace ikgen_runtime {

// --- general_6r: tables for arcs of the circle ------------------------------------------------------
// The circle is cut into 4 D arcs, and an arc that needs it into eight, four times over. On an arc of width w about
// 0, a trigonometric polynomial has Bernstein coefficients of degree 2 D in
// (sin((w/2 - t)/2), sin((t + w/2)/2)) / sin(w/2), for exp(i m t) is a product of (e, conj e)(exp(i t/2)).

namespace elimination {

inline constexpr int kParts = 8;
inline constexpr int kLevels = 4;  // of arcs cut from the first ones
template <int D> inline constexpr double kArcWidth = 6.283185307179586476925 / kArcs<D>;

template <int D, int N>
struct Cut {  // cos and sin of m times the middles of N arcs side by side, about 0 but for the first
  alignas(64) double c[D + 1][N], s[D + 1][N];
};

template <int D> struct Bernstein {  // coefficients of cos(m t) and sin(m t), the other halves by symmetry
  double even[D + 1][D + 1], odd[D + 1][D + 1];
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

template <int N> struct Binomials {
  double of[N + 1][N + 1];
};
template <int N> constexpr Binomials<N> binomials() noexcept {
  Binomials<N> out{};
  for (int n = 0; n <= N; ++n)
    for (int r = 0; r <= n; ++r) out.of[n][r] = r == 0 || r == n ? 1.0 : out.of[n - 1][r - 1] + out.of[n - 1][r];
  return out;
}
template <int N> inline constexpr Binomials<N> kBinomials = binomials<N>();

template <int D> constexpr Bernstein<D> make_bernstein(double width) noexcept {
  Turn half[D * 2 + 1] = {};  // multiples of width/2
  half[0] = {1.0L, 0.0L};
  half[1] = turn_by(0.5L * static_cast<long double>(width));
  for (int k = 2; k <= D * 2; ++k) half[k] = times(half[k - 1], half[1]);
  Bernstein<D> out{};
  for (int m = 0; m <= D; ++m)
    for (int q = 0; q <= D; ++q) {
      long double even = 0.0L, odd = 0.0L;
      for (int j = 0; j <= q; ++j) {
        const int l = q - j, phase = j - l - m;
        if (l > D - m) continue;
        const auto& choices = kBinomials<2 * D>.of;
        const double share = choices[D + m][j] * choices[D - m][l] / choices[2 * D][q];
        const auto w = static_cast<long double>(share);
        even += w * half[phase < 0 ? -phase : phase].c;
        odd += w * (phase < 0 ? -half[-phase].s : half[phase].s);
      }
      out.even[m][q] = static_cast<double>(even);
      out.odd[m][q] = static_cast<double>(odd);
    }
  return out;
}

template <int D, int N>
constexpr Cut<D, N> make_cut(double first, double width) noexcept {
  Cut<D, N> out{};
  for (int a = 0; a < N; ++a) {
    const long double angle = static_cast<long double>(first) + a * static_cast<long double>(width);
    const Turn quarter = turn_by(angle / 8);  // small enough for the series
    const Turn two = times(quarter, quarter), four = times(two, two), one = times(four, four);
    Turn now = {1.0L, 0.0L};
    for (int m = 0; m <= D; ++m, now = times(now, one)) {
      out.c[m][a] = static_cast<double>(now.c);
      out.s[m][a] = static_cast<double>(now.s);
    }
  }
  return out;
}

template <int D> constexpr double width_of(int level) noexcept {
  double out = kArcWidth<D>;
  for (; level > 0; --level) out /= kParts;
  return out;
}

template <int D> constexpr Cut<D, kParts> part_cut(int level) noexcept {
  return make_cut<D, kParts>(-0.5 * (kParts - 1) * width_of<D>(level), width_of<D>(level));
}

template <int D> inline constexpr Cut<D, kArcs<D>> kFirstCut = make_cut<D, kArcs<D>>(0.5 * kArcWidth<D>, kArcWidth<D>);
template <int D> inline constexpr Cut<D, kParts> kCuts[kLevels] = {part_cut<D>(1), part_cut<D>(2), part_cut<D>(3),
                                                                   part_cut<D>(4)};
template <int D> inline constexpr Bernstein<D> kBernstein[kLevels + 1] = {
    make_bernstein<D>(width_of<D>(0)), make_bernstein<D>(width_of<D>(1)), make_bernstein<D>(width_of<D>(2)),
    make_bernstein<D>(width_of<D>(3)), make_bernstein<D>(width_of<D>(4))};
template <int D> inline constexpr double kWidths[kLevels + 1] = {width_of<D>(0), width_of<D>(1), width_of<D>(2),
                                                                 width_of<D>(3), width_of<D>(4)};

}  // namespace elimination
}  // namespace ikgen_runtime
