#pragma once

#include "elimination/general_6r_resultant.hpp"
#include "elimination/general_6r_candidate.hpp"
#include "elimination/general_6r_newton.hpp"
#include "elimination/general_6r_solutions.hpp"
#include "arrays/lane_angle.hpp"

namespace ikgen_runtime {

// --- general_6r: by the trigonometric resultant -----------------------------------------------------

namespace elimination {

template <int D> struct Rotated {  // the nodes at the angle where they begin
  alignas(64) double c[kNodes<D>], s[kNodes<D>];
};
template <int D> constexpr Rotated<D> rotate_nodes() noexcept {
  Rotated<D> out{};
  for (int n = 0; n < kNodes<D>; ++n) {
    out.c[n] = kNode<D>.c[n] * kStart[0] - kNode<D>.s[n] * kStart[1];
    out.s[n] = kNode<D>.s[n] * kStart[0] + kNode<D>.c[n] * kStart[1];
  }
  return out;
}
template <int D> inline constexpr Rotated<D> kRotated = rotate_nodes<D>();

constexpr double power(double x, int n) noexcept { return n == 0 ? 1.0 : x * power(x, n - 1); }

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

// The roots of a polynomial that lie in none of the zones, as pairs at the nodes' angle.
template <int D>
inline void clear_roots(const Polynomial<D>& f, const Brackets<D>& brackets, Roots<D>& out) noexcept {
  refine_all(f, brackets, out);
  int kept = 0;
  for (int i = 0; i < out.count && brackets.zones > 0; ++i) {
    const double angle = std::atan2(out.s[i], out.c[i]);
    bool skip = false;
    for (int z = 0; z < brackets.zones; ++z) skip = skip || inside(brackets.zone[z], angle);
    out.c[kept] = out.c[i];
    out.s[kept] = out.s[i];
    kept += skip ? 0 : 1;
  }
  if (brackets.zones > 0) out.count = kept;
}

inline bool is_whole(const Zone& zone) noexcept { return zone.high - zone.low >= 2.0 * kPi; }

// One zone of all angles, none of which is known, in place of one of half of them or more: none is to overlap itself, nor
// to be seen from so near that little is seen of the rest.
template <int D> inline void round_up(Brackets<D>& brackets) noexcept {
  for (int z = 0; z < brackets.zones; ++z) {
    if (!(brackets.zone[z].high - brackets.zone[z].low > kPi)) continue;
    brackets.count = 0;
    brackets.zones = 1;
    brackets.zone[0] = {-kPi, kPi};
  }
}

// Where zones of phi lie in theta, cut off at the zone's ends; empty (high < low) where they do not meet it.
inline Zone seen_through(const Lens& lens, const Zone& phi, const Zone& zone) noexcept {
  const double middle = wrap(0.5 * (phi.low + phi.high)), reach = 0.5 * (phi.high - phi.low);
  const double centre = 0.5 * (zone.low + zone.high);
  if (is_whole(zone)) return {centre + middle - reach, centre + middle + reach};
  const auto angle = [&](double x) {
    const double inner = std::min(std::max(x, -3.1415), 3.1415);  // the other end is far outside
    return centre + 2.0 * std::atan(lens.scale * std::tan(0.5 * inner));
  };
  return {std::max(angle(middle - reach), zone.low), std::min(angle(middle + reach), zone.high)};
}

inline constexpr double kScales[] = {0.03, 5e-4};  // of the first look and of the second

// Where a function vanishes everywhere, on some continua without any round-off, nothing is sure.
inline constexpr double kLeastBlur = 1e-300;

// The roots inside a zone, from nodes crowded there, as pairs of theta. False where that leaves it open. values(close,
// c, s, f, blur, shift): of f at the nodes, and how far they may be off, tight where asked; false where roots of f
// alone are wanted, otherwise those of all functions that differ from f by at most shift.
template <int D, class Values>
inline bool look_closer(const Values& values, const Zone& zone, int look, Roots<D>& out) noexcept {
  const double middle = 0.5 * (zone.low + zone.high), half = 0.5 * (zone.high - zone.low);
  const double scale = is_whole(zone) ? 1.0 : std::tan(0.5 * half);
  const Lens lens = {std::cos(middle), std::sin(middle), std::max(kScales[look], scale)};
  constexpr int count = kNodes<D>;
  alignas(64) double c[count], s[count], f[count], blur[count], shift[count];
  double weight[count], worst = kLeastBlur;
  for (int n = 0; n < count; ++n) {
    c[n] = kNode<D>.c[n];
    s[n] = kNode<D>.s[n];
    weight[n] = power(lens.apply(c[n], s[n]), D);
  }
  const bool shifts = values(true, c, s, f, blur, shift);
  for (int n = 0; n < count; ++n) {
    if (shifts) shift[n] *= weight[n];
    f[n] *= weight[n];
    worst = std::max(worst, weight[n] * blur[n]);
  }
  Polynomial<D> g = interpolate<D>(f, worst);
  if (shifts) add_shift<D>(shift, g);
  const Brackets<D> brackets = isolate(g);
  Roots<D> nearby;
  clear_roots(g, brackets, nearby);
  for (int i = 0; i < nearby.count; ++i) {
    lens.apply(nearby.c[i], nearby.s[i]);
    const double off = std::atan2(nearby.s[i] * lens.c - nearby.c[i] * lens.s, nearby.c[i] * lens.c + nearby.s[i] * lens.s);
    if (std::abs(off) > half) continue;
    if (out.count == 2 * kRoots<D>) return false;
    add_root(out, nearby.c[i], nearby.s[i]);
  }
  bool all = !brackets.doubt;
  for (int i = 0; i < brackets.zones; ++i) {
    const Zone open = seen_through(lens, brackets.zone[i], zone);
    if (open.high < open.low) continue;
    if (look > 0 && out.open < kMostZones) out.middle[out.open++] = 0.5 * (open.low + open.high);
    all = look == 0 && look_closer<D>(values, open, 1, out) && all;
  }
  return all;
}

// All roots; false where some may be missing. settle(f, brackets) may take those away that are known to be none.
template <int D, class Values, class Settle>
inline bool find_roots(const Values& values, const Settle& settle, Roots<D>& out) noexcept {
  alignas(64) double f[kNodes<D>], blur[kNodes<D>], shift[kNodes<D>];
  const bool shifts = values(false, kRotated<D>.c, kRotated<D>.s, f, blur, shift);
  Polynomial<D> polynomial = interpolate<D>(f, std::max(*std::max_element(blur, blur + kNodes<D>), kLeastBlur));
  if (shifts) add_shift<D>(shift, polynomial);
  Brackets<D> brackets = isolate(polynomial);
  if (brackets.doubt) return false;
  settle(polynomial, brackets);
  round_up(brackets);
  clear_roots(polynomial, brackets, out);
  for (int i = 0; i < out.count; ++i) {
    const double c = out.c[i], s = out.s[i];
    out.c[i] = c * kStart[0] - s * kStart[1];
    out.s[i] = s * kStart[0] + c * kStart[1];
  }
  bool all = true;
  for (int z = 0; z < brackets.zones; ++z) {
    const Zone zone = {brackets.zone[z].low + kStartAngle, brackets.zone[z].high + kStartAngle};
    all = look_closer<D>(values, zone, 0, out) && all;
  }
  return all && out.count <= kRoots<D> && out.count % 2 == 0;
}

template <int D, class Values> inline bool find_roots(const Values& values, Roots<D>& out) noexcept {
  return find_roots<D>(values, [](const Polynomial<D>&, const Brackets<D>&) {}, out);
}

// Takes a row to round-off that steps left short of it, if that can be.
template <class Frames>
[[gnu::cold, gnu::noinline]] inline void sharpen(const Frames& F, const Frame& T, Solution& row) noexcept {
  Vector q;
  std::copy_n(row.q, 6, q.data());
  if (refine_along(F, T, kAllTurn, q) < kExactly) row = solution_of(kAllTurn, q);
}

// Adds the solutions of the roots from `first` on; whether each became one of its own.
template <class Frames>
inline bool add_rows(const Frames& F, const Frame& T, const Six& start, const double (&live)[kWide],
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
    const bool stalls = error[l] >= kExactly;  // beside two that meet: its root may be that of others as well
    if (stalls && error[l] < kVerified) sharpen(F, T, row);
    all = error[l] < kVerified && keep(row, out) && !stalls && all;
  }
  return all;
}

// Adds the solutions that of(angles) gives for roots side by side; whether each became one of its own.
template <int D, class Frames, class Of>
inline bool add_solutions(const Frames& F, const Frame& T, const Of& of, Roots<D>& roots, Solutions& out) noexcept {
  bool all = true;
  for (int i = roots.count; i < roots.count + kWide; ++i) {
    roots.c[i] = roots.count > 0 ? roots.c[0] : 1.0;
    roots.s[i] = roots.count > 0 ? roots.s[0] : 0.0;
  }
  for (int i = 0; i < roots.count; i += kWide) {
    double live[kWide];
    for (int l = 0; l < kWide; ++l) live[l] = i + l < roots.count ? 1.0 : 0.0;
    all = add_rows(F, T, of({load<kWide>(roots.c + i), load<kWide>(roots.s + i)}), live, out) && all;
  }
  return all;
}

// Adds to those that rounding hides the solutions to which steps lead from what of(angles) gives for the middles of zones
// that stay open: there may be a double root.
template <int D, class Frames, class Of>
[[gnu::cold, gnu::noinline]] inline void add_blurred(const Frames& F, const Frame& T, const Of& of, const Roots<D>& roots,
                                                     Solutions& blurred) noexcept {
  for (int k = 0; k < roots.open; ++k) {
    const Six start = of({spread<kWide>(std::cos(roots.middle[k])), spread<kWide>(std::sin(roots.middle[k]))});
    Vector q;
    double sum = 0.0;
    for (Index i = 0; i < 6; ++i) {
      q[i] = std::atan2(lane(start.s[i], 0), lane(start.c[i], 0));
      sum += q[i];
    }
    if (std::isfinite(sum) && refine_one(F, T, kAllTurn, q) < kVerified) keep(solution_of(kAllTurn, q), blurred);
  }
}

// Adds those that rounding hides, where nothing else was found nearby.
inline void take_blurred(const Solutions& blurred, Solutions& out) noexcept {
  constexpr double nearby = 1e-3;  // rad
  const int count = out.count;
  for (int k = 0; k < blurred.count; ++k) {
    const Solution& row = blurred.rows[static_cast<Index>(k)];
    bool fresh = true;
    for (int i = 0; i < count; ++i) fresh = fresh && !coincident(row.q, out.rows[static_cast<Index>(i)].q, nearby);
    if (fresh) keep(row, out);
  }
}

// Adds the solutions for the pose T. True where they are all: every root is single, and leads to a solution of
// its own. caution: times the rounding that values may have.
inline bool run_resultant(const Chain& F, const Frame& T, const std::array<int, 2>& plan, double caution,
                          Solutions& blurred, Solutions& out) noexcept {
  const Loop loop = make_loop(F, T, static_cast<Index>(plan[0]), plan[1] != 0);
  const Equations eq = eliminate(loop);
  const Pencil pencil = make_pencil(eq.E, eq.left);
  Roots<kDegree> roots;
  constexpr double kMade = 4.0;  // the bound is of rounding in the pencil: what it is made of has rounded before
  const auto values = [&](bool close, const auto& c, const auto& s, auto& f, auto& blur, auto&) {
    resultants(pencil, close, c, s, f, blur);
    for (double& x : blur) x *= kMade * caution;
    return false;
  };
  const bool all = find_roots<kDegree>(values, roots);
  const auto completed = [&](const Pair& three) { return complete(loop, eq, pencil, three); };
  const bool each = add_solutions<kDegree>(F, T, completed, roots, out);
  add_blurred(F, T, completed, roots, blurred);
  return each && all;
}

// All solutions, or false and those that were found, where every hidden angle leaves doubts. Poses displaced a
// little are no help: next to a singularity all of them may lack solutions that the pose itself has. That there are none
// is believed if it was found before, or with ten times the rounding, and no hidden angle left doubts: of a million poses
// beside singularities a few have a double root that lies over its bound, and nothing else.
template <auto Run, class Frames, class Plans>
inline bool solve_resultant(const Frames& F, const Frame& T, const Plans& plans, bool none, Solutions& blurred,
                            Solutions& out) noexcept {
  constexpr double kCautious = 10.0;
  bool doubtful = false;
  for (const auto& plan : plans) {
    if (out.count == 0) {
      bool all = Run(F, T, plan, 1.0, blurred, out);
      if (all && out.count == 0 && !none) all = !doubtful && Run(F, T, plan, kCautious, blurred, out) && out.count == 0;
      if (all) return true;
      doubtful = true;
      continue;
    }
    Solutions mine;
    const bool all = Run(F, T, plan, 1.0, blurred, mine);
    for (int k = 0; k < mine.count; ++k) keep(mine.rows[static_cast<Index>(k)], out);
    if (all && mine.count == out.count) return true;
  }
  return false;
}

}  // namespace elimination
}  // namespace ikgen_runtime
