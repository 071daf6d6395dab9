#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace ikgen_runtime {

// --- general_6r: trigonometric polynomials of degree D ----------------------------------------------

namespace elimination {

inline constexpr int kDegree = 8;  // of the resultant of any arm

// A divisor of 384, so many more than coefficients that some frequencies must vanish.
constexpr int nodes_for(int degree) noexcept {
  for (const int count : {16, 24, 48, 64})
    if (count >= 2 * degree + 8) return count;
  return 96;
}
template <int D> inline constexpr int kNodes = nodes_for(D);
template <int D> inline constexpr int kArcs = 4 * D;  // that the circle is cut into

// Cosines of the multiples of a 384th of a turn, which all angles below are.
inline constexpr int kTurnParts = 384;
constexpr std::array<double, kTurnParts> cosine_table() noexcept {
  std::array<double, kTurnParts> out{};
  for (int k = 0; k < kTurnParts; ++k) {
    const int folded = k <= kTurnParts / 2 ? k : kTurnParts - k;  // to [0, pi]
    const bool remote = folded > kTurnParts / 4;
    constexpr long double part = 6.283185307179586476925286766559005768L / kTurnParts;
    const long double x = part * (remote ? kTurnParts / 2 - folded : folded);
    long double term = 1.0L, sum = 0.0L;
    for (int n = 1; n < 30; n += 2) {
      sum += term;
      term *= -x * x / (n * (n + 1));
    }
    out[static_cast<std::size_t>(k)] = static_cast<double>(4 * folded == kTurnParts ? 0.0L : remote ? -sum : sum);
  }
  return out;
}
inline constexpr std::array<double, kTurnParts> kCosines = cosine_table();
constexpr double cosine(int parts) noexcept {
  return kCosines[static_cast<std::size_t>(((parts % kTurnParts) + kTurnParts) % kTurnParts)];
}
constexpr double sine(int parts) noexcept { return cosine(parts - kTurnParts / 4); }

// The nodes begin at an angle that no right angle shares, lest roots lie on the ends of arcs.
inline constexpr double kStartAngle = 0.1;
inline constexpr double kStart[2] = {0.99500416527802576610, 0.09983341664682815230};  // its cosine and sine

template <int D> struct Nodes {
  static constexpr int kCount = kNodes<D>;
  alignas(64) double c[kCount], s[kCount];    // without that angle
  alignas(64) double weight[kCount][kCount];  // value k -> a0, a1..aD, b1..bD, and those that must vanish
};
template <int D> constexpr Nodes<D> make_nodes() noexcept {
  Nodes<D> out{};
  constexpr int count = kNodes<D>, step = kTurnParts / count;
  static_assert(kTurnParts % count == 0);
  for (int n = 0; n < count; ++n) {
    out.c[n] = cosine(step * n);
    out.s[n] = sine(step * n);
    for (int j = 0; j < count; ++j) {  // of the other cosines and, one less, the other sines at the end
      const bool odd = (j > D && j <= 2 * D) || j > D + count / 2;
      const int m = j <= D ? j : j <= D + count / 2 ? j - D : j - count / 2;
      const double scale = (m == 0 || m == count / 2 ? 1.0 : 2.0) / count;
      out.weight[n][j] = scale * (odd ? sine(step * n * m) : cosine(step * n * m));
    }
  }
  return out;
}
template <int D> inline constexpr Nodes<D> kNode = make_nodes<D>();

template <int D> struct Polynomial {
  alignas(64) double c[kNodes<D>];  // a0, a1..aD, b1..bD of cos(m theta), sin(m theta); then what is noise
  // On each of as many arcs: values below `noise` are of unknown sign, and a rise of neighbouring coefficients there by
  // more than `wobble` is one.
  alignas(64) double noise[kArcs<D>], wobble[kArcs<D>];
  double hopeless;  // times the noise: below that smaller arcs do not make it clearer
};

// Coefficients of f from its values at the nodes, and how far they may be off. A polynomial of degree D has no
// part in the frequencies above, seven or more, so what is found there measures the error of the values. Were these
// errors equally spread, the polynomial's error at a point would be 1.1 t times the norm of seven coefficients, t of
// Student's distribution with 7 degrees of freedom: beyond 10 once in 50,000, and that at a point where f itself
// comes as close to 0. Were one node's error all, it would be 4.7 times the norm. Rounding in the sums here and
// where the polynomial is evaluated comes on top.
template <int D> inline Polynomial<D> interpolate(const double (&f)[kNodes<D>], double blur) noexcept {
  constexpr int count = kNodes<D>;
  Polynomial<D> out;
  double sum[count] = {};
  for (int n = 0; n < count; ++n)
    for (int j = 0; j < count; ++j) sum[j] += f[n] * kNode<D>.weight[n][j];
  double noise = 0.0, size = 0.0;
  for (int j = 0; j < count; ++j) {
    out.c[j] = sum[j];
    if (j <= 2 * D)
      size += std::abs(sum[j]);
    else
      noise += sum[j] * sum[j];
  }
  constexpr double kNoise = 11.0, kRounding = 1e-15;
  const double off = kNoise * std::sqrt(noise) + kRounding * size + blur;
  std::fill(out.noise, out.noise + kArcs<D>, off);
  std::fill(out.wobble, out.wobble + kArcs<D>, 2.0 * off);
  out.hopeless = 100.0;
  return out;
}

// The roots of any smooth function are wanted that differs from f by at most `shift`, given at the nodes: on each arc
// the most of the two nodes before it and the two behind it, and half as much again.
template <int D> inline void add_shift(const double (&shift)[kNodes<D>], Polynomial<D>& f) noexcept {
  constexpr int count = kNodes<D>;
  for (int arc = 0; arc < kArcs<D>; ++arc) {
    const int before = arc * count / kArcs<D>;
    double most = 0.0;
    for (int n = before + count - 1; n < before + count + 4; ++n) most = std::max(most, shift[n % count]);
    f.noise[arc] += 1.5 * most;
    f.wobble[arc] += 0.3 * most;  // of a function of degree D, between places a sixteenth of an arc apart
  }
  f.hopeless = 3.0;
}

}  // namespace elimination
}  // namespace ikgen_runtime
