#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "elimination/general_6r_resultant.hpp"
#include "elimination/coupled_lanes.hpp"
#include "elimination/general_6r_search.hpp"

namespace ikgen_runtime {

// --- coupled_6r: by the trigonometric resultant in the coupled joint's angle -------------------------------

namespace elimination {

inline double length_of(const Frame& X) noexcept {
  return std::sqrt(X.p[0] * X.p[0] + X.p[1] * X.p[1] + X.p[2] * X.p[2]);
}

// By how large the invariants can be that the rows multiply.
template <class Plan> inline RowSizes row_sizes(const CoupledEquations<Plan>& of) noexcept {
  double reach = length_of(of.closing);
  for (const Frame& link : of.F) reach += length_of(link);
  const double size[4] = {1.0, reach, reach, reach * reach};
  const auto& E = of.eq.E;
  RowSizes out;
  for (Index i = 0; i < 6; ++i) {
    double sum = std::abs(E(i, 14)) + std::abs(E(i, 12)) * reach * reach + std::abs(E(i, 13)) * reach;
    for (Index k = 0; k < 12; ++k) sum += std::abs(E(i, k)) * size[k % 4];
    out.over[i] = 1.0 / (sum * sum + 1e-300);
  }
  return out;
}

// Two axes beside the coupled joint come into line at a crowded angle, and every pose has roots near it that are no
// solutions. In a circle about it there is no other where f over the crowded roots' factor does not wind around 0
// along the circle. Radii (rad) that are tried: along a wide one f is farther above its noise, but others may be in it.
inline constexpr double kCrowds[] = {0.03, 0.1, 0.25};

// f over (z - angle)^order at eight points of the circle's upper half.
template <int D>
inline Pair over_crowd(const Polynomial<D>& f, const Crowded& crowd, double radius, double& least) noexcept {
  double x[kWide], y[kWide], c[kWide], s[kWide], up[kWide];
  for (int i = 0; i < kWide; ++i) {
    const double turn = kPi / kWide * (i + 0.5);
    x[i] = std::cos(turn);
    y[i] = -std::sin(turn);  // of 1 over the point
    c[i] = std::cos(crowd.angle + radius * x[i]);
    s[i] = std::sin(crowd.angle + radius * x[i]);
    up[i] = std::exp(radius * y[i]);
  }
  const Wide grown = load<kWide>(up), shrunk = 1.0 / grown;
  const Pair z = {load<kWide>(c), load<kWide>(s)}, w = {grown * z.c, grown * z.s}, v = {shrunk * z.c, -(shrunk * z.s)};
  Pair wave = w, back = v, sum = {spread<kWide>(f.c[0]), spread<kWide>(0.0)};
  for (int m = 1; m <= D; ++m) {  // a cos + b sin = (a - i b)/2 w^m + (a + i b)/2 w^-m
    const double a = 0.5 * f.c[m], b = 0.5 * f.c[D + m];
    sum.c = sum.c + a * (wave.c + back.c) + b * (wave.s - back.s);
    sum.s = sum.s + a * (wave.s + back.s) - b * (wave.c - back.c);
    wave = times(wave, w);
    back = times(back, v);
  }
  double size[kWide];
  store(sum.c * sum.c + sum.s * sum.s, size);
  least = std::sqrt(*std::min_element(size, size + kWide));
  const Pair over = {load<kWide>(x), load<kWide>(y)};
  for (int k = 0; k < crowd.order; ++k) sum = times(sum, over);
  return sum;
}

template <int D> inline bool crowd_alone(const Polynomial<D>& f, const Crowded& crowd, double radius) noexcept {
  double least = 0.0, c[kWide], along[kWide];
  const Pair h = over_crowd(f, crowd, radius, least);
  const double noise = std::cosh(D * radius) * *std::max_element(f.noise, f.noise + kArcs<D>);
  store(h.c, c);
  store(h.c * h.c / (h.c * h.c + h.s * h.s), along);
  const auto ends = std::minmax_element(c, c + kWide);
  return least > 10.0 * noise && (*ends.first > 0.0) == (*ends.second > 0.0) &&
         *std::min_element(along, along + kWide) > 0.25;
}

inline double way(double angle, double place) noexcept { return std::abs(wrap(angle - place)); }

// Takes away what lies in a circle.
template <int D> inline void take_away(double place, double radius, Brackets<D>& out) noexcept {
  int kept = 0;
  for (int i = 0; i < out.count; ++i) {
    const bool skip = std::max(way(out.low[i], place), way(out.high[i], place)) < radius;
    out.low[kept] = out.low[i];
    out.high[kept] = out.high[i];
    out.guess[kept] = out.guess[i];
    out.negative[kept] = out.negative[i];
    kept += skip ? 0 : 1;
  }
  out.count = kept;
  kept = 0;
  for (int i = 0; i < out.zones; ++i) {
    const Zone zone = out.zone[i];
    const bool skip = std::max(way(zone.low, place), way(zone.high, place)) < radius;
    out.zone[kept] = zone;
    kept += skip ? 0 : 1;
  }
  out.zones = kept;
}

// Takes away what lies within a crowd that is alone. The crowd's angle is from the nodes' first.
template <int D>
inline void settle_crowd(const Polynomial<D>& f, const Crowded& crowd, Brackets<D>& out) noexcept {
  for (const double radius : kCrowds) {
    if (crowd_alone(f, crowd, radius)) take_away(crowd.angle, radius, out);
    if (out.zones == 0) return;
  }
}

// Adds the solutions for the pose T. True where they are all, as in `run_resultant`.
template <class Plan>
inline bool run_coupled_resultant(const CoupledChain<Plan>& F, const Frame& T, const std::array<int, 3>& plan,
                                  double caution, Solutions& blurred, Solutions& out) noexcept {
  constexpr int degree = (static_cast<int>(Plan::kDegree) + 3) / 4 * 4;
  const CoupledEquations<Plan> of = coupled_equations(F, T, plan);
  const auto values = [&](bool close, const auto& c, const auto& s, auto& f, auto& blur, auto&) {
    resultants(of, close, c, s, f, blur);
    for (double& x : blur) x *= caution;
    return false;
  };
  const auto settle = [](const Polynomial<degree>& f, Brackets<degree>& brackets) {
    for (const Crowded& at : Plan::kCrowded) settle_crowd(f, {at.angle - kStartAngle, at.order}, brackets);
  };
  Roots<degree> roots;
  const bool all = find_roots<degree>(values, settle, roots);
  const auto completed = [&](const Pair& angle) {
    Pair z[6];
    z[2] = {spread<kWide>(1.0), spread<kWide>(0.0)};
    inner_angles(of, angle, z[3], z[4]);
    WideFrame C[3];
    inner_links(of, angle, C);
    WideFrame U = C[0];
    rotate(U, z[3].c, z[3].s);
    U = compose(U, C[1]);
    rotate(U, z[4].c, z[4].s);
    Six q = close_loop(of.loop, of.eq, compose(U, C[2]), z);
    q.c[Plan::kCoupled] = angle.c;
    q.s[Plan::kCoupled] = angle.s;
    return q;
  };
  const bool each = add_solutions<degree>(F, T, completed, roots, out);
  add_blurred(F, T, completed, roots, blurred);
  return each && all;
}

}  // namespace elimination
}  // namespace ikgen_runtime
