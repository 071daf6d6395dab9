#pragma once

#include <algorithm>
#include <cmath>

#include "general_6r_circle.hpp"
#include "general_6r_resultant.hpp"

namespace ikgen_runtime {

// --- general_6r: isolation of the roots on the circle -----------------------------------------------
// By Descartes' rule on Bernstein's coefficients: no change of sign on an arc is no root, one is one root, and more
// halves the arc. A coefficient within the noise has no sign: such an arc is halved as well, and where that does
// not help it is handed on as a zone in which nothing is known.

namespace g6 {

inline constexpr int kRoots = 16;      // of degree 8
inline constexpr int kMostZones = 6;
inline constexpr int kBits = 2 * kDegree + 1;

struct Zone {
  double low, high;
};

inline constexpr double kMargin = 1e-3;  // rad; zones are made wider by it, as roots near their ends are not exact

struct Brackets {
  int count = 0, zones = 0;
  bool doubt = false;  // more than there is room or time for
  double low[kRoots + kWide], high[kRoots + kWide], guess[kRoots + kWide];
  bool negative[kRoots + kWide];  // sign at the lower end
  Zone zone[kMostZones];
};

inline void add_zone(Brackets& out, double low, double high) noexcept {
  for (int i = 0; i < out.zones; ++i) {
    Zone& z = out.zone[i];
    if (low > z.high + kMargin || high < z.low - kMargin) continue;
    z = {std::min(z.low, low), std::max(z.high, high)};
    return;
  }
  if (out.zones == kMostZones) {
    out.doubt = true;
    return;
  }
  out.zone[out.zones++] = {low, high};
}

// What Bernstein's coefficients in the lanes say: changes of sign, whether one is within the noise, whether all
// are nearly so.
struct Verdict {
  double changes[kWide], unsure[kWide], lost[kWide];
};

inline void judge(const Wide (&b)[kBits], double noise, Verdict& out) noexcept {
  Wide changes = spread<kWide>(0.0), small = abs(b[0]), large = small;
  for (int i = 1; i < kBits; ++i) {
    const Wide size = abs(b[i]);
    changes = changes + select((b[i] > 0.0) & (0.0 > b[i - 1]), 1.0, 0.0) + select((0.0 > b[i]) & (b[i - 1] > 0.0), 1.0, 0.0);
    small = min(small, size);
    large = max(large, size);
  }
  constexpr double kHopeless = 100.0;  // times the noise: halving does not make it clearer
  store(changes, out.changes);
  store(noise > small, out.unsure);
  store(kHopeless * noise > large, out.lost);
}

struct Arc {
  double b[kBits], low;
  int level;
};

inline constexpr double kArcWidth = 2.0 * kPi / kArcs;
inline constexpr int kLevels = 12;  // 5e-5 rad

struct Stack {
  static constexpr int kRoom = 128;
  int top = 0;
  Arc arcs[kRoom];
};

inline double width_of(int level) noexcept { return std::ldexp(kArcWidth, -level); }

// Where the polygon of coefficients changes its sign, as a fraction of the arc.
inline double polygon_root(const double (&b)[kBits]) noexcept {
  for (int q = 1; q < kBits; ++q)
    if ((b[q] < 0.0) != (b[0] < 0.0)) return (q - 1 + b[q - 1] / (b[q - 1] - b[q])) / (kBits - 1);
  return 0.5;
}

// Files lane l of the coefficients b as a bracket, a zone or an arc to be halved.
inline void file(const Wide (&b)[kBits], const Verdict& verdict, int l, double low, int level, Stack& stack,
                 Brackets& out) noexcept {
  const bool unsure = verdict.unsure[l] > 0.0;
  if (verdict.changes[l] < 0.5 && !unsure) return;
  const double width = width_of(level);
  if (unsure && (verdict.lost[l] > 0.0 || level == kLevels)) {
    add_zone(out, low, low + width);
    return;
  }
  const bool one = verdict.changes[l] < 1.5 && !unsure;
  if (level == kLevels && !one) {
    add_zone(out, low, low + width);
    return;
  }
  if (stack.top == Stack::kRoom || (one && out.count == kRoots)) {
    out.doubt = true;
    return;
  }
  Arc& to = stack.arcs[stack.top];
  double lanes[kWide];
  for (int q = 0; q < kBits; ++q) {
    store(b[q], lanes);
    to.b[q] = lanes[l];
  }
  if (one) {
    out.low[out.count] = low;
    out.high[out.count] = low + width;
    out.guess[out.count] = low + width * polygon_root(to.b);
    out.negative[out.count++] = to.b[0] < 0.0;
    return;
  }
  to.low = low;
  to.level = level;
  ++stack.top;
}

// The 32 arcs of the circle.
inline void cover(const Polynomial& f, Stack& stack, Brackets& out) noexcept {
  for (int arc = 0; arc < kArcs; arc += kWide) {
    Wide even[kDegree + 1], odd[kDegree + 1], b[kBits];
    even[0] = spread<kWide>(f.c[0]);
    for (int m = 1; m <= kDegree; ++m) {
      const Wide c = load<kWide>(kCentre.c[m] + arc), s = load<kWide>(kCentre.s[m] + arc);
      even[m] = f.c[m] * c + f.c[kDegree + m] * s;
      odd[m] = f.c[kDegree + m] * c - f.c[m] * s;
    }
    for (int q = 0; q <= kDegree; ++q) {
      Wide e = kBernstein.even[0][q] * even[0], d = spread<kWide>(0.0);
      for (int m = 1; m <= kDegree; ++m) {
        e = e + kBernstein.even[m][q] * even[m];
        d = d + kBernstein.odd[m][q] * odd[m];
      }
      b[q] = e + d;
      b[2 * kDegree - q] = e - d;
    }
    Verdict verdict;
    judge(b, f.noise, verdict);
    for (int l = 0; l < kWide; ++l) file(b, verdict, l, kArcWidth * (arc + l), 0, stack, out);
  }
}

// Halves up to as many arcs as there are lanes, by de Casteljau's scheme on the circle: an arc of width w is cut by
// 1 / (2 cos(w/4)) of the sum of neighbours.
inline void halve(double noise, Stack& stack, Brackets& out) noexcept {
  const int n = std::min(stack.top, kWide);
  stack.top -= n;
  double lanes[kBits][kWide], low[kWide], weight[kWide];
  int level[kWide];
  for (int l = 0; l < kWide; ++l) {
    const Arc& a = stack.arcs[stack.top + (l < n ? l : 0)];
    for (int q = 0; q < kBits; ++q) lanes[q][l] = a.b[q];
    low[l] = a.low;
    level[l] = a.level + 1;
    const double w = width_of(a.level), u = w * w / 16.0;
    weight[l] = 0.5 * (1.0 + u * (0.5 + u * (5.0 / 24.0 + u * (61.0 / 720.0))));
  }
  Wide right[kBits], left[kBits];
  for (int q = 0; q < kBits; ++q) right[q] = load<kWide>(lanes[q]);
  const Wide k = load<kWide>(weight);
  left[0] = right[0];
  for (int s = 1; s < kBits; ++s) {
    for (int q = 0; q < kBits - s; ++q) right[q] = k * (right[q] + right[q + 1]);
    left[s] = right[0];
  }
  Verdict first, second;
  judge(left, noise, first);
  judge(right, noise, second);
  for (int l = 0; l < n; ++l) {
    file(left, first, l, low[l], level[l], stack, out);
    file(right, second, l, low[l] + width_of(level[l]), level[l], stack, out);
  }
}

inline void widen_zones(Brackets& out) noexcept {
  for (int i = 0; i < out.zones; ++i) {
    Zone& z = out.zone[i];
    const double margin = kMargin + 0.15 * (z.high - z.low);
    z = {z.low - margin, z.high + margin};
  }
  for (int i = 0; i < out.zones; ++i)
    for (int j = 0; j < i; ++j) {
      Zone &a = out.zone[j], b = out.zone[i];
      const double turns = 2.0 * kPi * std::nearbyint((0.5 * (a.low + a.high) - 0.5 * (b.low + b.high)) / (2.0 * kPi));
      b = {b.low + turns, b.high + turns};
      if (b.low > a.high || b.high < a.low) continue;
      a = {std::min(a.low, b.low), std::max(a.high, b.high)};
      out.zone[i] = out.zone[--out.zones];
      i = 0;  // what grew may meet another now
      break;
    }
}

inline Brackets isolate(const Polynomial& f) noexcept {
  Brackets out;
  Stack stack;
  cover(f, stack, out);
  constexpr int kMostSteps = 60;
  for (int step = 0; stack.top > 0 && !out.doubt; ++step) {
    halve(f.noise, stack, out);
    if (step == kMostSteps) out.doubt = true;
  }
  widen_zones(out);
  return out;
}

}  // namespace g6
}  // namespace ikgen_runtime
