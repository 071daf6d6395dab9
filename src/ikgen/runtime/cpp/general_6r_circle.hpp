#pragma once

#include <array>
#include <cmath>

namespace ikgen_runtime {

// --- general_6r: trigonometric polynomials of degree 8 ----------------------------------------------

namespace g6 {

inline constexpr int kDegree = 8;
inline constexpr int kNodes = 24;

// Cosines of the multiples of a 384th of a turn, which all angles below are.
inline constexpr int kTurnParts = 384;
constexpr std::array<double, kTurnParts> cosine_table() noexcept {
  std::array<double, kTurnParts> out{};
  for (int k = 0; k < kTurnParts; ++k) {
    const int folded = k <= kTurnParts / 2 ? k : kTurnParts - k;  // to [0, pi]
    const bool far = folded > kTurnParts / 4;
    constexpr long double part = 6.283185307179586476925286766559005768L / kTurnParts;
    const long double x = part * (far ? kTurnParts / 2 - folded : folded);
    long double term = 1.0L, sum = 0.0L;
    for (int n = 1; n < 30; n += 2) {
      sum += term;
      term *= -x * x / (n * (n + 1));
    }
    out[static_cast<std::size_t>(k)] = static_cast<double>(4 * folded == kTurnParts ? 0.0L : far ? -sum : sum);
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

struct Nodes {
  alignas(64) double c[kNodes], s[kNodes];        // without that angle
  alignas(64) double weight[kNodes][kNodes];      // value k -> a0, a1..a8, b1..b8, and seven that must vanish
};
constexpr Nodes make_nodes() noexcept {
  Nodes out{};
  constexpr int step = kTurnParts / kNodes;
  for (int n = 0; n < kNodes; ++n) {
    out.c[n] = cosine(step * n);
    out.s[n] = sine(step * n);
    for (int j = 0; j < kNodes; ++j) {  // a9, a10, a11, a12, b9, b10, b11 at the end
      const bool odd = (j > kDegree && j <= 2 * kDegree) || j > 20;
      const int m = j <= kDegree ? j : j <= 2 * kDegree ? j - kDegree : j <= 20 ? j - kDegree : j - 12;
      const double scale = (m == 0 || m == 12 ? 1.0 : 2.0) / kNodes;
      out.weight[n][j] = scale * (odd ? sine(step * n * m) : cosine(step * n * m));
    }
  }
  return out;
}
inline constexpr Nodes kNode = make_nodes();

struct Polynomial {
  alignas(64) double c[kNodes];  // a0, a1..a8, b1..b8 of cos(m theta), sin(m theta); then what is noise
  double noise;                  // values below are of unknown sign
};

// Coefficients of f from its values at the nodes, and how far they may be off. A polynomial of degree 8 has no
// part in the seven frequencies above, so what is found there measures the error of the values. Were these errors
// equally spread, the polynomial's error at a point would be 1.1 t times the norm of the seven coefficients, t of
// Student's distribution with 7 degrees of freedom: beyond 10 once in 50,000, and that at a point where f itself
// comes as close to 0. Were one node's error all, it would be 4.7 times the norm. Rounding in the sums here and
// where the polynomial is evaluated comes on top.
inline Polynomial interpolate(const double (&f)[kNodes], double blur) noexcept {
  Polynomial out;
  double sum[kNodes] = {};
  for (int n = 0; n < kNodes; ++n)
    for (int j = 0; j < kNodes; ++j) sum[j] += f[n] * kNode.weight[n][j];
  double noise = 0.0, size = 0.0;
  for (int j = 0; j < kNodes; ++j) {
    out.c[j] = sum[j];
    if (j <= 2 * kDegree)
      size += std::abs(sum[j]);
    else
      noise += sum[j] * sum[j];
  }
  constexpr double kNoise = 11.0, kRounding = 1e-15;
  out.noise = kNoise * std::sqrt(noise) + kRounding * size + blur;
  return out;
}

}  // namespace g6
}  // namespace ikgen_runtime
