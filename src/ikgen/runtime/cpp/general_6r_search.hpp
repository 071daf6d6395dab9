#pragma once

#include "general_6r_newton.hpp"
#include "general_6r_solutions.hpp"

namespace ikgen_runtime {

// --- general_6r: by the trigonometric resultant -----------------------------------------------------

namespace g6 {

struct Rotated {  // the nodes at the angle where they begin
  alignas(64) double c[kNodes], s[kNodes];
};
constexpr Rotated rotate_nodes() noexcept {
  Rotated out{};
  for (int n = 0; n < kNodes; ++n) {
    out.c[n] = kNode.c[n] * kStart[0] - kNode.s[n] * kStart[1];
    out.s[n] = kNode.s[n] * kStart[0] + kNode.c[n] * kStart[1];
  }
  return out;
}
inline constexpr Rotated kRotated = rotate_nodes();

inline bool inside(const Zone& zone, double angle) noexcept {
  const double middle = 0.5 * (zone.low + zone.high);
  return std::abs(wrap(angle - middle)) <= 0.5 * (zone.high - zone.low);
}

// Angles around a zone's middle, seen closer: tan((theta - middle)/2) = scale tan(phi/2).
struct Lens {
  double c, s, scale;  // of the middle

  // The pair of theta from that of phi; returns what a polynomial's terms are to be multiplied with per degree.
  double apply(double& cosine, double& sine) const noexcept {
    const double a = 0.5 * (1.0 + cosine), b = 0.5 * (1.0 - cosine) * scale * scale, r = a + b;
    const double x = (a - b) / r, y = scale * sine / r;
    cosine = c * x - s * y;
    sine = s * x + c * y;
    return r;
  }
};

// Whether an interval of phi meets the zone, half as wide as `half` (rad) either side.
inline bool meets(const Lens& lens, const Zone& phi, double half) noexcept {
  const double edge = 2.0 * std::atan2(std::tan(0.5 * half), lens.scale);
  const double middle = wrap(0.5 * (phi.low + phi.high)), reach = 0.5 * (phi.high - phi.low);
  return std::abs(middle) <= edge + reach;
}

// The roots inside a zone, from nodes crowded there. False where that leaves it open.
inline bool look_closer(const Pencil& pencil, const Zone& zone, Roots& out) noexcept {
  const double middle = 0.5 * (zone.low + zone.high), half = 0.5 * (zone.high - zone.low);
  const double cz = std::cos(middle), sz = std::sin(middle);
  const Lens lens = {cz * kStart[0] - sz * kStart[1], sz * kStart[0] + cz * kStart[1],
                     std::max(0.03, std::tan(0.5 * half))};
  alignas(64) double c[kNodes], s[kNodes], f[kNodes];
  double weight[kNodes];
  for (int n = 0; n < kNodes; ++n) {
    c[n] = kNode.c[n];
    s[n] = kNode.s[n];
    const double r = lens.apply(c[n], s[n]), r2 = r * r, r4 = r2 * r2;
    weight[n] = r4 * r4;
  }
  resultants(pencil, c, s, f);
  for (int n = 0; n < kNodes; ++n) f[n] *= weight[n];
  const Polynomial g = interpolate(f);
  const Brackets brackets = isolate(g);
  Roots near;
  refine_all(g, brackets, near);
  for (int i = 0; i < near.count; ++i) {
    lens.apply(near.c[i], near.s[i]);
    const double off = std::atan2(near.s[i] * lens.c - near.c[i] * lens.s, near.c[i] * lens.c + near.s[i] * lens.s);
    if (std::abs(off) > half) continue;
    if (out.count == 2 * kRoots) return false;
    add_root(out, near.c[i], near.s[i]);
  }
  bool open = brackets.doubt;
  for (int i = 0; i < brackets.zones; ++i) open = open || meets(lens, brackets.zone[i], half);
  return !open;
}

// All roots; false where some may be missing.
inline bool find_roots(const Pencil& pencil, Roots& out) noexcept {
  alignas(64) double f[kNodes];
  resultants(pencil, kRotated.c, kRotated.s, f);
  const Polynomial polynomial = interpolate(f);
  const Brackets brackets = isolate(polynomial);
  if (brackets.doubt) return false;
  Roots found;
  refine_all(polynomial, brackets, found);
  for (int i = 0; i < found.count; ++i) {
    const double c = found.c[i], s = found.s[i];
    bool skip = false;
    if (brackets.zones > 0) {
      const double angle = std::atan2(s, c);
      for (int z = 0; z < brackets.zones; ++z) skip = skip || inside(brackets.zone[z], angle);
    }
    if (!skip) add_root(out, c * kStart[0] - s * kStart[1], s * kStart[0] + c * kStart[1]);
  }
  bool all = true;
  for (int z = 0; z < brackets.zones; ++z) all = look_closer(pencil, brackets.zone[z], out) && all;
  return all && out.count <= kRoots && out.count % 2 == 0;
}

// Adds the solutions of the roots from `first` on; whether each became one of its own.
inline bool add_rows(const Chain& F, const Frame& T, const Six& start, const double (&live)[kWide],
                     Solutions& out) noexcept {
  Six q = start;
  const Errors errors = newton(F, T, load<kWide>(live) > 0.5, q);
  double angles[6][kWide], c[6][kWide], s[6][kWide], error[kWide];
  store(errors.after, error);
  for (int i = 0; i < 6; ++i) {
    store(angle(q.s[i], q.c[i]), angles[i]);
    store(q.c[i], c[i]);
    store(q.s[i], s[i]);
  }
  bool all = true;
  for (int l = 0; l < kWide && live[l] > 0.5; ++l) {
    Solution row;
    for (int i = 0; i < 6; ++i) {
      row.q[i] = angles[i][l];
      row.c[i] = c[i][l];
      row.s[i] = s[i][l];
    }
    all = error[l] < kVerified && keep(row, out) && all;
  }
  return all;
}

// Adds the solutions for the pose T from the roots of the pose `aim`, which is T or close to it. True where they
// are all: every root is single, and leads to a solution of its own.
inline bool run_resultant(const Chain& F, const Frame& T, const Frame& aim, const std::array<int, 2>& plan,
                          Solutions& out) noexcept {
  const Loop loop = make_loop(F, aim, static_cast<Index>(plan[0]), plan[1] != 0);
  const Equations eq = eliminate(loop);
  const Pencil pencil = make_pencil(eq.E, eq.left);
  Roots roots;
  bool all = find_roots(pencil, roots);
  for (int i = roots.count; i < roots.count + kWide; ++i) {
    roots.c[i] = roots.count > 0 ? roots.c[0] : 1.0;
    roots.s[i] = roots.count > 0 ? roots.s[0] : 0.0;
  }
  for (int i = 0; i < roots.count; i += kWide) {
    const Pair three = {load<kWide>(roots.c + i), load<kWide>(roots.s + i)};
    double live[kWide];
    for (int l = 0; l < kWide; ++l) live[l] = i + l < roots.count ? 1.0 : 0.0;
    all = add_rows(F, T, complete(loop, eq, pencil, three), live, out) && all;
  }
  return all;
}

// All solutions, or false and those that were found. Where the first run leaves doubts, two in a row must find
// all that is known and no more: with the next hidden angle, and at poses displaced to either side.
template <std::size_t N>
inline bool solve_resultant(const Chain& F, const Frame& T, const std::array<std::array<int, 2>, N>& plans,
                            Solutions& out) noexcept {
  Frame aims[3] = {T, T, T};
  int number = 0, confirmed = 0;
  for (const Frame& aim : aims)
    for (const std::array<int, 2>& plan : plans) {
      if (number++ == 0) {
        if (run_resultant(F, T, aim, plan, out)) return true;
        aims[1] = compose(T, displacement());
        aims[2] = compose(T, inverse(displacement()));
        continue;
      }
      Solutions mine;
      const bool all = run_resultant(F, T, aim, plan, mine);
      bool fresh = false;
      for (int k = 0; k < mine.count; ++k) fresh = keep(mine.rows[static_cast<Index>(k)], out) || fresh;
      confirmed = all && !fresh && mine.count == out.count ? confirmed + 1 : 0;
      if (confirmed == 2 && out.count % 2 == 0) return true;
    }
  return false;
}

}  // namespace g6
}  // namespace ikgen_runtime
