// Real roots of a2 cos 2t + b2 sin 2t + a1 cos t + b1 sin t + a0. Ferrari's resolvent in its geometric form: the
// pencil of the conic and the unit circle holds a pair of real lines; each meets the circle in two roots. No
// half-angle tangent, hence no point at infinity.
#pragma once

#include <algorithm>
#include <cmath>

#include "roots/crowded_roots.hpp"

namespace ikgen_runtime {

struct TrigRoots {
  int count;       // 0 to 4; -1: all coefficients vanish, t is free
  double c[4];     // cosines
  double s[4];     // sines
};

namespace tq {

constexpr double kFlat = 1e-14;      // of what a slope is the sum of: less is round-off, as at a triple root
constexpr double kChord = 1e-3;      // half width from which a line's chord tells its roots well
constexpr double kTouching = 0.02;   // half width below which an extremum tells them
constexpr double kContact = 0.5;     // of a line's half width: how far from its point of contact an extremum may be
constexpr double kNarrowest = 0.3;   // of a line's half width: the least one of a parabola
constexpr double kWidest = 3.0;      // of a line's half width: the largest one of a parabola
constexpr double kInexact = 1e-3;    // what a multiple of a line's half width may be off by
constexpr double kLeastHalf = 1e-7;  // distance from the extremum below which a root is round-off

struct Coefficients {
  double a2, b2, a1, b1, a0;
};

struct Point {
  double c, s;
};

struct Lines {
  int count;
  double x[2], y[2], d[2];  // (x, y) . (cos t, sin t) = d
};

// How far a value lies from the ends of [-1, 1].
struct Span {
  double above, below;  // -1, 1
};

// The best separated root m in [-1, 1] of g(m) = (a - m) (m^2 - 1) - pp (m - 1) - qq (m + 1), pp, qq >= 0: it is >= 0 at
// -1 and <= 0 at 1. A root that is double stands for a double root of the quartic. Newton's method from the end where g
// is convex (or that of -g(-m), where g is concave) all the way to the root never goes beyond it.
inline Span resolvent(double a, double pp, double qq) noexcept {
  const auto g = [&](double m) noexcept { return ((a - m) * m + 1.0 - pp - qq) * m - a + pp - qq; };
  const double disc = a * a + 3.0 * (1.0 - pp - qq);
  bool turned = g(std::min(std::max(a / 3.0, -1.0), 1.0)) > 0.0;
  if (disc > 0.0) {
    const double root = std::sqrt(disc), m1 = (a - root) / 3.0, m2 = (a + root) / 3.0, g1 = g(m1), g2 = g(m2);
    const bool left = std::abs(m1) <= 1.0 && g1 <= 0.0, right = std::abs(m2) <= 1.0 && g2 >= 0.0;
    if (left || right) turned = right && !(left && g2 <= -g1);
  }
  const double c0 = 2.0 * (turned ? qq : pp), c2 = (turned ? -a : a) + 3.0, c1 = 2.0 * (c2 - 2.0) + pp + qq;
  const double flat = kFlat * (4.0 + std::abs(a) + pp + qq);
  double u = 0.0;  // from that end
  for (int i = 0; i < 60; ++i) {
    const double slope = c1 - (2.0 * c2 - 3.0 * u) * u, step = (((c2 - u) * u - c1) * u + c0) / slope;
    if (!(slope > flat && step > 4e-16 * u)) break;
    u = std::min(u + step, 2.0);
  }
  return turned ? Span{2.0 - u, u} : Span{u, 2.0 - u};
}

inline Lines lines(const Coefficients& f) noexcept {
  Lines out{};
  const double rho = std::sqrt(f.a2 * f.a2 + f.b2 * f.b2), k = std::sqrt(f.a1 * f.a1 + f.b1 * f.b1);
  if (rho < 1e-8 * std::max(k, std::abs(f.a0))) {
    if (2.0 * k > std::abs(f.a0)) {
      out.count = 1;
      out.x[0] = f.a1 / k;
      out.y[0] = f.b1 / k;
      out.d[0] = -f.a0 / k;
    }
    return out;
  }
  const double first = std::sqrt(0.5 * (1.0 + std::abs(f.a2) / rho)), second = 0.5 * std::abs(f.b2) / (rho * first);
  const double ch = f.a2 >= 0.0 ? first : second;
  const double sh = std::copysign(f.a2 >= 0.0 ? second : first, f.b2);
  const double p = (f.a1 * ch + f.b1 * sh) / rho, q = (f.b1 * ch - f.a1 * sh) / rho, a = f.a0 / rho;
  const Span span = resolvent(a, 0.25 * p * p, 0.25 * q * q);
  const double h = 0.70710678118654752440, m = 0.5 * (span.above - span.below);
  const double A = std::sqrt(span.above), B = std::sqrt(span.below);
  double v, w, square;
  if (m <= 0.0) {
    v = 0.5 * q / B;
    square = a - m + v * v;
    if (square < -1e-6 * (1.0 + v * v)) return out;
    w = std::copysign(std::sqrt(std::max(square, 0.0)), p);
  } else {
    w = 0.5 * p / A;
    square = w * w - a + m;
    if (square < -1e-6 * (1.0 + w * w)) return out;
    v = std::copysign(std::sqrt(std::max(square, 0.0)), q);
  }
  out.count = 2;
  for (int i = 0; i < 2; ++i) {
    const double sign = i == 0 ? 1.0 : -1.0;
    out.x[i] = h * (A * ch + sign * B * sh);
    out.y[i] = h * (A * sh - sign * B * ch);
    out.d[i] = h * (-w - sign * v);
  }
  return out;
}

// A direction near which two lines have all their roots, if there is one.
inline bool is_crowded(const Lines& l, Point& at) noexcept {
  Point way[2];
  for (int i = 0; i < 2; ++i) {
    if (l.count < 2 || !(std::abs(l.d[i]) > kTogether && std::abs(l.d[i]) < 1.01)) return false;
    const double sign = std::copysign(1.0, l.d[i]);
    way[i] = {sign * l.x[i], sign * l.y[i]};
  }
  if (!(way[0].c * way[1].c + way[0].s * way[1].s > kSameWay)) return false;
  const Point sum = {way[0].c + way[1].c, way[0].s + way[1].s};
  const double size = std::sqrt(sum.c * sum.c + sum.s * sum.s);
  at = {sum.c / size, sum.s / size};
  return true;
}

// Up to five Newton steps to a zero of the function (order 0) or of its derivative (order 1).
inline Point newton(const Coefficients& f, Point t, int order) noexcept {
  for (int i = 0; i < 5; ++i) {
    const double c2 = (t.c - t.s) * (t.c + t.s), s2 = 2.0 * t.s * t.c;
    const double u = f.a2 * c2 + f.b2 * s2, v = f.a1 * t.c + f.b1 * t.s;
    const double slope = 2.0 * (f.b2 * c2 - f.a2 * s2) + f.b1 * t.c - f.a1 * t.s;
    const double top = order == 0 ? u + v + f.a0 : slope, below = order == 0 ? slope : -4.0 * u - v;
    if (top == 0.0 || std::abs(below) < 1e-200) break;
    const double step = std::min(std::max(-top / below, -0.1), 0.1);
    const Point n{t.c - step * t.s, t.s + step * t.c};
    if (std::abs(step) < 1e-9) return n;
    const double r = 1.0 / std::sqrt(n.c * n.c + n.s * n.s);
    t = {n.c * r, n.s * r};
  }
  return t;
}

// newton() to a root, undone where it leaves `reach`: among three close roots. Whether it stays there.
inline bool approach(const Coefficients& f, double reach, Point& t) noexcept {
  const Point n = newton(f, t, 0);
  if (!(std::abs(n.c - t.c) + std::abs(n.s - t.s) < reach)) return false;
  t = n;
  return true;
}

// The two roots beside the extremum near t; the extremum itself where it misses zero by a pair of complex
// roots with imaginary parts up to tol; -1: no such extremum within reach, the half width of the line's chord, or one
// of two roots that are much closer, or not where a parabola has them, as among four.
inline int tangent(const Coefficients& f, Point t, double reach, double tol, Point (&out)[2]) noexcept {
  const Point e = newton(f, t, 1);
  const double u = f.a2 * (e.c - e.s) * (e.c + e.s) + 2.0 * f.b2 * e.s * e.c, v = f.a1 * e.c + f.b1 * e.s;
  const double curve = -4.0 * u - v;
  if (std::abs(e.c - t.c) + std::abs(e.s - t.s) > kContact * reach + kInexact || std::abs(curve) < 1e-200) return -1;
  const double r = 2.0 * (u + v + f.a0) / curve, h = std::sqrt(std::abs(r));
  if (h < kNarrowest * reach - kInexact) return -1;
  if (r >= 0.0) {
    out[0] = e;
    if (r <= tol * tol + 1e-14 / std::abs(curve)) return 1;
    return reach > 1e-4 ? -1 : 0;
  }
  if (h > kWidest * reach + kInexact) return -1;
  const double n = std::sqrt(1.0 + h * h);
  out[0] = {(e.c - h * e.s) / n, (e.s + h * e.c) / n};
  out[1] = {(e.c + h * e.s) / n, (e.s - h * e.c) / n};
  if (h < kLeastHalf) return 2;  // the value at the extremum is round-off: Newton steps would be too
  for (Point& end : out)
    if (!approach(f, 0.5 * h, end) && h > kChord) return -1;
  return 2;
}

}  // namespace tq

// Real roots as (cos t, sin t). Coefficients all below `zero`: count -1. Complex pairs of roots with imaginary
// parts up to `tol` rad count as one, at the extremum.
inline TrigRoots trig_quartic(double a2, double b2, double a1, double b1, double a0, double tol = 1e-3,
                              double zero = 1e-13) noexcept {
  TrigRoots out{};
  const double size =
      std::max({std::abs(a2), std::abs(b2), std::abs(a1), std::abs(b1), std::abs(a0)});
  if (!(size > zero)) {
    out.count = -1;
    return out;
  }
  const tq::Coefficients f{a2 / size, b2 / size, a1 / size, b1 / size, a0 / size};
  const tq::Lines l = tq::lines(f);
  tq::Point at;
  if (tq::is_crowded(l, at)) {
    out.count = tq::roots_around(f.a2, f.b2, f.a1, f.b1, f.a0, at.c, at.s, tol, out.c, out.s);
    return out;
  }
  for (int i = 0; i < l.count; ++i) {
    const double x = l.x[i], y = l.y[i];
    double d = l.d[i];
    if (!(std::abs(d) < 1.01)) continue;
    const double r = std::sqrt(std::max((1.0 - d) * (1.0 + d), 0.0));
    tq::Point found[2];
    int n = -1;
    if (r < tq::kTouching) {
      const double e = std::copysign(1.0, d);
      n = tq::tangent(f, {e * x, e * y}, r, tol, found);
    }
    if (n < 0) {
      d = std::min(std::max(d, -1.0), 1.0);
      found[0] = {d * x - r * y, d * y + r * x};
      found[1] = {d * x + r * y, d * y - r * x};
      n = 2;
      for (tq::Point& end : found) tq::approach(f, 0.25 * r + 1e-5, end);
    }
    for (int j = 0; j < n; ++j) {
      bool fresh = true;
      for (int k = 0; k < out.count; ++k)
        fresh = fresh && std::abs(found[j].c - out.c[k]) + std::abs(found[j].s - out.s[k]) > 1e-13;
      if (!fresh) continue;
      out.c[out.count] = found[j].c;
      out.s[out.count++] = found[j].s;
    }
  }
  return out;
}

// The roots as cosines and sines, and how many there are.
inline int roots_as_branches(const TrigRoots& found, double (&roots)[4][2]) noexcept {
  for (int i = 0; i < found.count; ++i) {
    roots[i][0] = found.c[i];
    roots[i][1] = found.s[i];
  }
  return found.count;
}

// The roots as branches; none where the angle is free.
inline int trig_quartic_branches(const double (&x)[5], double (&roots)[4][2]) noexcept {
  return roots_as_branches(trig_quartic(x[0], x[1], x[2], x[3], x[4]), roots);
}

}  // namespace ikgen_runtime
