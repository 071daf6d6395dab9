#pragma once

#include <algorithm>

#include "elimination/general_6r_isolation.hpp"

namespace ikgen_runtime {

// --- general_6r: roots to all digits ----------------------------------------------------------------

namespace elimination {

struct Pair {  // cosine and sine
  Wide c, s;
};

inline Pair times(const Pair& a, const Pair& b) noexcept { return {a.c * b.c - a.s * b.s, a.s * b.c + a.c * b.s}; }

// Of small angles: to 1e-16 up to 0.2.
inline Pair small_pair(const Wide& t) noexcept {
  const Wide u = t * t;
  return {1.0 + u * (-0.5 + u * (1.0 / 24 + u * (-1.0 / 720 + u * (1.0 / 40320 - u * (1.0 / 3628800))))),
          t * (1.0 + u * (-1.0 / 6 + u * (1.0 / 120 + u * (-1.0 / 5040 + u * (1.0 / 362880 - u * (1.0 / 39916800))))))};
}

// f and its derivative.
template <int D>
inline void evaluate(const Polynomial<D>& f, const Pair& z, Wide& value, Wide& slope) noexcept {
  Pair power[D + 1];
  power[1] = z;
  for (int k = 2; k <= D; ++k) power[k] = times(power[k / 2], power[k - k / 2]);
  Wide v[2] = {spread<kWide>(f.c[0]), spread<kWide>(0.0)}, d[2] = {spread<kWide>(0.0), spread<kWide>(0.0)};
  for (int k = 1; k <= D; ++k) {
    const double a = f.c[k], b = f.c[D + k];
    v[k % 2] = v[k % 2] + a * power[k].c + b * power[k].s;
    d[k % 2] = d[k % 2] + (k * b) * power[k].c - (k * a) * power[k].s;
  }
  value = v[0] + v[1];
  slope = d[0] + d[1];
}

template <int D> struct Roots {
  int count = 0, open = 0;
  alignas(64) double c[2 * kRoots<D> + kWide], s[2 * kRoots<D> + kWide];
  double middle[kMostZones];  // of zones that stay open, as angles
};

template <int D> inline void add_root(Roots<D>& out, double c, double s) noexcept {
  out.c[out.count] = c;
  out.s[out.count++] = s;
}

// Newton's method kept within the brackets from `first` on; to the last digits, as nearly double roots want them.
template <int D> inline Pair refine(const Polynomial<D>& f, const Brackets<D>& in, int first) noexcept {
  double low[kWide], high[kWide], guess[kWide], rising[kWide], c[kWide], s[kWide];
  for (int l = 0; l < kWide; ++l) {
    const int i = std::min(first + l, in.count - 1);
    const int arc = std::min(static_cast<int>(in.guess[i] * (1.0 / kArcWidth<D>)), kArcs<D> - 1);
    const double centre = kArcWidth<D> * (arc + 0.5);
    low[l] = in.low[i] - centre;
    high[l] = in.high[i] - centre;
    guess[l] = in.guess[i] - centre;
    rising[l] = in.negative[i] ? 1.0 : -1.0;
    c[l] = kFirstCut<D>.c[1][arc];
    s[l] = kFirstCut<D>.s[1][arc];
  }
  const Pair centre = {load<kWide>(c), load<kWide>(s)};
  const Wide up = load<kWide>(rising);
  Wide lower = load<kWide>(low), upper = load<kWide>(high), t = load<kWide>(guess);
  for (int step = 0; step < 50; ++step) {
    Wide value, slope;
    evaluate(f, times(centre, small_pair(t)), value, slope);
    const auto below = 0.0 > up * value;
    lower = select(below, t, lower);
    upper = select(below, upper, t);
    const Wide next = t - value / select(abs(slope) > 0.0, slope, 1e-300);
    const Wide inside = select((next > lower) & (upper > next), next, 0.5 * (lower + upper));
    const Wide moved = abs(inside - t);
    t = inside;
    if (!any(moved > 1e-12 + 1e-4 * (upper - lower))) break;
  }
  return times(centre, small_pair(t));
}

// All roots in brackets, as pairs at the nodes' angle.
template <int D> inline void refine_all(const Polynomial<D>& f, const Brackets<D>& in, Roots<D>& out) noexcept {
  out.count = in.count;
  for (int i = 0; i < in.count; i += kWide) {
    const Pair z = refine(f, in, i);
    store(z.c, out.c + i);
    store(z.s, out.s + i);
  }
}

}  // namespace elimination
}  // namespace ikgen_runtime
