// Real roots of a trigonometric quartic that lie together: lines through two each do not tell them apart. They are those of
// the quartic of tan((t - t0)/2), between the zeros of its derivative.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

namespace ikgen_runtime {

namespace tq {

constexpr double kTogether = 0.995;  // distance of lines whose roots are within 0.1 rad
constexpr double kSameWay = 0.98;    // cosine of the angle between two that have theirs in one place
constexpr double kAround = 0.25;     // tangents of half angles
constexpr double kValueRoundOff = 1e-13;  // of a value, twice: what coefficients are off by what they were made of

// Zeros of a polynomial of M coefficients, fewer than M, in order.
template <int M> struct Zeros {
  int count = 0;
  double x[M];
};

// Of falling powers.
template <int M> inline double value(const double (&p)[M], double x) noexcept {
  double out = p[0];
  for (int i = 1; i < M; ++i) out = out * x + p[i];
  return out;
}

template <int M> inline void derive(const double (&p)[M], double (&out)[M - 1]) noexcept {
  for (int i = 0; i + 1 < M; ++i) out[i] = p[i] * (M - 1 - i);
}

// Where it vanishes between places where it is below 0 and above it: by Newton's method, or halving.
template <int M> inline double zero_between(const double (&p)[M], double low, double high) noexcept {
  constexpr int kSteps = 64;
  double slope[M - 1] = {}, x = 0.5 * (low + high);
  derive(p, slope);
  for (int i = 0; i < kSteps; ++i) {
    const double y = value(p, x), rise = value(slope, x);
    (y < 0.0 ? low : high) = x;
    double ahead = rise != 0.0 ? x - y / rise : low;
    if (!(std::min(low, high) < ahead && ahead < std::max(low, high))) ahead = 0.5 * (low + high);
    if (ahead == x) break;
    x = ahead;
  }
  return x;
}

// One at most between two that follow each other of its derivative's.
template <int M> inline Zeros<M> zeros_between(const double (&p)[M], const Zeros<M - 1>& turns) noexcept {
  Zeros<M> out;
  double low = -kAround, below = value(p, low);
  for (int i = 0; i <= turns.count; ++i) {
    const double high = i < turns.count ? turns.x[i] : kAround, above = value(p, high);
    if (below * above < 0.0) out.x[out.count++] = above > 0.0 ? zero_between(p, low, high) : zero_between(p, high, low);
    low = high;
    below = above;
  }
  return out;
}

template <int M> inline Zeros<M> zeros_of(const double (&p)[M]) noexcept {
  Zeros<M - 1> turns{};
  if constexpr (M > 2) {
    double slope[M - 1];
    derive(p, slope);
    turns = zeros_of(slope);
  }
  return zeros_between(p, turns);
}

// The roots of a2 cos 2t + b2 sin 2t + a1 cos t + b1 sin t + a0 near the angle of (c, s), as cosines and sines in order;
// how many. Complex pairs of roots with imaginary parts up to tol count as one.
inline int roots_around(double a2, double b2, double a1, double b1, double a0, double c, double s, double tol,
                        double (&cosine)[4], double (&sine)[4]) noexcept {
  const double even = (c - s) * (c + s), odd = 2.0 * s * c;
  const double A2 = a2 * even + b2 * odd, B2 = b2 * even - a2 * odd, A1 = a1 * c + b1 * s, B1 = b1 * c - a1 * s;
  const double p[5] = {A2 - A1 + a0, 2.0 * B1 - 4.0 * B2, 2.0 * a0 - 6.0 * A2, 2.0 * B1 + 4.0 * B2, A2 + A1 + a0};
  double slope[4], bends[3];
  derive(p, slope);
  derive(slope, bends);
  const Zeros<4> turns = zeros_of(slope);
  const Zeros<5> found = zeros_between(p, turns);
  double x[7];
  int count = found.count;
  std::copy_n(found.x, count, x);
  for (int i = 0; i < turns.count; ++i) {
    const double y = value(p, turns.x[i]), bend = value(bends, turns.x[i]);
    const double most = 0.25 * tol * tol * std::abs(bend) + 0.125 * tol * tol * tol * tol * std::abs(p[0]) + kValueRoundOff;
    if (y * bend >= 0.0 && 2.0 * std::abs(y) <= most) x[count++] = turns.x[i];
  }
  for (int i = 1; i < count; ++i)  // few: std::sort has code for many, of which compilers warn
    for (int k = i; k > 0 && x[k - 1] > x[k]; --k) std::swap(x[k - 1], x[k]);
  count = std::min(count, 4);
  for (int i = 0; i < count; ++i) {
    const double over = 1.0 / (1.0 + x[i] * x[i]), u = (1.0 - x[i] * x[i]) * over, v = 2.0 * x[i] * over;
    cosine[i] = c * u - s * v;
    sine[i] = s * u + c * v;
  }
  return count;
}

}  // namespace tq

}  // namespace ikgen_runtime
