#pragma once

#include <algorithm>
#include <cmath>

#include "elimination/general_6r_arcs.hpp"
#include "elimination/general_6r_null_space.hpp"

namespace ikgen_runtime {

// --- general_6r: isolation of the roots on the circle -----------------------------------------------
// By Descartes' rule on Bernstein's coefficients: no change of sign on an arc is no root, one is one root, and with
// more the arc is cut. A coefficient within the noise has no sign: such an arc is cut as well, and where that does
// not help it is handed on as a zone in which nothing is known.

namespace elimination {

template <int D> inline constexpr int kRoots = 2 * D;
inline constexpr int kMostZones = 8;
inline constexpr double kTogether = 0.015;  // rad; zones closer than this are looked at together
template <int D> inline constexpr int kBits = 2 * D + 1;

struct Zone {
  double low, high;
};

inline constexpr double kMargin = 1e-3;  // rad; zones are made wider by it, as roots near their ends are not exact

template <int D> struct Brackets {
  int count = 0, zones = 0;
  bool doubt = false;  // more than there is room or time for
  double low[kRoots<D> + kWide], high[kRoots<D> + kWide], guess[kRoots<D> + kWide];
  bool negative[kRoots<D> + kWide];  // sign at the lower end
  Zone zone[kMostZones];
};

template <int D> inline void add_zone(Brackets<D>& out, double low, double high) noexcept {
  for (int i = 0; i < out.zones; ++i) {
    Zone& z = out.zone[i];
    if (low > z.high + kTogether || high < z.low - kTogether) continue;
    z = {std::min(z.low, low), std::max(z.high, high)};
    return;
  }
  if (out.zones == kMostZones) {
    out.doubt = true;
    return;
  }
  out.zone[out.zones++] = {low, high};
}

// What may be off, as in Polynomial.
template <class T> struct Noise {
  T noise, wobble, hopeless;
};

// What Bernstein's coefficients in the lanes say: changes of sign, whether one is within the noise, whether all
// are nearly so, whether they rise or fall without doubt from end to end; for an arc with one change, where the polygon
// of coefficients has it, as a fraction of the arc.
struct Verdict {
  Wide changes, root;
  WideMask unsure, lost, steady;
};

template <int N> inline Verdict judge(const Wide (&b)[N], const Noise<Wide>& of) noexcept {
  const Wide none = spread<kWide>(0.0);
  Wide changes = none, before = none, over = spread<kWide>(1.0), place = none;
  Wide lesser = abs(b[0]), large = lesser, step = spread<kWide>(1e300);
  const Wide rise = select(b[N - 1] > b[0], spread<kWide>(1.0), spread<kWide>(-1.0));
  for (int i = 1; i < N; ++i) {
    const Wide size = abs(b[i]);
    lesser = min(lesser, size);
    large = max(large, size);
    step = min(step, rise * (b[i] - b[i - 1]));
    const auto change = 0.0 > b[i] * b[i - 1];
    changes = changes + select(change, 1.0, none);
    before = select(change, b[i - 1], before);
    over = select(change, b[i - 1] - b[i], over);
    place = select(change, spread<kWide>(i - 1.0), place);
  }
  return {changes, (place + before / over) * (1.0 / (N - 1)), of.noise > lesser, of.hopeless * of.noise > large,
          (step > of.wobble) & (min(abs(b[0]), abs(b[N - 1])) > of.noise)};
}

template <int D> struct Arc {
  double even[D + 1], odd[D + 1];  // of cos(m t), sin(m t), t from its middle
  double low;
  Noise<double> noise;
  int level;
};

template <int D> struct Stack {
  static constexpr int kSize = 96;
  int top = 0;
  Arc<D> arcs[kSize];
};

inline double lane(const Wide& x, int i) noexcept {
  double lanes[kWide];
  store(x, lanes);
  return lanes[i];
}

template <int D> struct Local {  // the polynomial about the middles of arcs side by side
  Wide even[D + 1], odd[D + 1];
};

template <int D>
inline void push(const Local<D>& f, int lane, double low, const Noise<double>& noise, int level,
                 Stack<D>& stack) noexcept {
  Arc<D>& to = stack.arcs[stack.top++];
  double lanes[kWide];
  for (int m = 0; m <= D; ++m) {
    store(f.even[m], lanes);
    to.even[m] = lanes[lane];
    store(f.odd[m], lanes);
    to.odd[m] = lanes[lane];
  }
  to.low = low;
  to.noise = noise;
  to.level = level;
}

// Files each of the arcs side by side as a bracket, as a zone, or to be cut.
template <int D>
inline void file(const Local<D>& f, const Verdict& verdict, const Noise<Wide>& noise, bool negative_at[kWide],
                 double low, int level, Stack<D>& stack, Brackets<D>& out) noexcept {
  const unsigned unsure = bits(verdict.unsure), lost = bits(verdict.lost);
  const unsigned some = bits(verdict.changes > 0.5) | unsure, sure = ~unsure | bits(verdict.steady);
  const unsigned one = some & ~bits(verdict.changes > 1.5) & sure;
  if (some == 0) return;
  const double width = kWidths<D>[level];
  double root[kWide];
  store(verdict.root, root);
  for (int l = 0; l < kWide; ++l, low += width) {
    const unsigned bit = 1U << l;
    if ((some & bit) == 0) continue;
    if ((one & bit) != 0) {
      if (out.count == kRoots<D>) {
        out.doubt = true;
        return;
      }
      out.low[out.count] = low;
      out.high[out.count] = low + width;
      out.guess[out.count] = low + width * root[l];
      out.negative[out.count++] = negative_at[l];
    } else if (level == kLevels || (unsure & lost & bit) != 0) {
      add_zone(out, low, low + width);
    } else if (stack.top == Stack<D>::kSize) {
      out.doubt = true;
      return;
    } else {
      push(f, l, low, {lane(noise.noise, l), lane(noise.wobble, l), lane(noise.hopeless, l)}, level, stack);
    }
  }
}

// The arcs in the lanes, whose middles are at the multiples c, s of the polynomial's angle.
template <int D, int N>
inline void examine(const double* even, const double* odd, const Cut<D, N>& cut, int first, double low, int level,
                    const Noise<Wide>& noise, Stack<D>& stack, Brackets<D>& out) noexcept {
  Local<D> f;
  f.even[0] = spread<kWide>(even[0]);
  f.odd[0] = spread<kWide>(0.0);
  for (int m = 1; m <= D; ++m) {
    const Wide c = load<kWide>(cut.c[m] + first), s = load<kWide>(cut.s[m] + first);
    f.even[m] = even[m] * c + odd[m] * s;
    f.odd[m] = odd[m] * c - even[m] * s;
  }
  const Bernstein<D>& table = kBernstein<D>[level];
  Wide b[kBits<D>];
  for (int q = 0; q <= D; ++q) {
    Wide e = table.even[0][q] * f.even[0], d = table.odd[1][q] * f.odd[1];
    for (int m = 1; m <= D; ++m) {
      e = e + table.even[m][q] * f.even[m];
      if (m > 1) d = d + table.odd[m][q] * f.odd[m];
    }
    b[q] = e + d;
    b[2 * D - q] = e - d;
  }
  double ends[kWide];
  store(b[0], ends);
  bool negative[kWide];
  for (int l = 0; l < kWide; ++l) negative[l] = ends[l] < 0.0;
  file(f, judge(b, noise), noise, negative, low, level, stack, out);
}

template <int D> inline void widen_zones(Brackets<D>& out) noexcept {
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

inline Noise<Wide> around(const Noise<double>& x) noexcept {
  return {spread<kWide>(x.noise), spread<kWide>(x.wobble), spread<kWide>(x.hopeless)};
}

template <int D> inline Brackets<D> isolate(const Polynomial<D>& f) noexcept {
  Brackets<D> out;
  Stack<D> stack;
  const double* even = f.c;
  double odd[D + 1] = {};
  for (int m = 1; m <= D; ++m) odd[m] = f.c[D + m];
  for (int arc = 0; arc < kArcs<D>; arc += kWide) {
    const Noise<Wide> noise = {load<kWide>(f.noise + arc), load<kWide>(f.wobble + arc), spread<kWide>(f.hopeless)};
    examine(even, odd, kFirstCut<D>, arc, kArcWidth<D> * arc, 0, noise, stack, out);
  }
  constexpr int kMostSteps = 64;
  for (int step = 0; stack.top > 0 && !out.doubt; ++step) {
    const Arc<D> arc = stack.arcs[--stack.top];
    examine(arc.even, arc.odd, kCuts<D>[arc.level], 0, arc.low, arc.level + 1, around(arc.noise), stack, out);
    if (step == kMostSteps) out.doubt = true;
  }
  widen_zones(out);
  return out;
}

}  // namespace elimination
}  // namespace ikgen_runtime
