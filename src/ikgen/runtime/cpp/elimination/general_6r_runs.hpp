#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "elimination/general_6r_candidate.hpp"
#include "elimination/general_6r_solutions.hpp"
#include "elimination/general_6r_spectrum.hpp"

namespace ikgen_runtime {

// --- general_6r: runs of eliminations until one finds all that is known --------------------------------

namespace g6 {

inline constexpr double kFarthest = 1e4;  // of a slide, in arm lengths: beyond are those that become parallel

inline Solution solution_of(const Turning& turning, const Vector& q) noexcept {
  Solution out;
  for (Index i = 0; i < 6; ++i) {
    out.q[i] = turning[i] ? wrap(q[i]) : q[i];
    out.c[i] = std::cos(q[i]);
    out.s[i] = std::sin(q[i]);
  }
  return out;
}

// Adds a candidate of a run if it can be refined; one that is far off shows that the run's roots are not all sharp.
template <class Frames>
inline void add_refined(const Frames& F, const Frame& T, const Turning& turning, Vector q, Spectrum& roots,
                        Solutions& out) noexcept {
  double before = 0.0, farthest = 0.0;
  const bool arrived = refine_one(F, T, turning, q, before) < kVerified;
  for (Index i = 0; i < 6; ++i) farthest = std::max(farthest, turning[i] ? 0.0 : std::abs(q[i]));
  if (arrived && farthest < kFarthest) keep(solution_of(turning, q), out);
  if (!(before <= 1e-5)) roots.simple = false;
}

// A rotation of about 1e-3 rad, and as much of a translation: where right angles make solutions coincide in
// the hidden angle, they come apart at the pose displaced by it, and Newton's method takes them back.
inline Frame displacement() noexcept {
  constexpr double c = 0.99999959500002733750, s = 8.999998785000048e-4;      // 9e-4 rad about z
  constexpr double d = 0.99999939500006100416, e = 1.0999997781666800920e-3;  // 1.1e-3 rad about x
  Frame out{};
  const double R[9] = {c, -s * d, s * e, s, c * d, -c * e, 0.0, e, d};
  for (Index i = 0; i < 9; ++i) out.R.v[i] = R[i];
  out.p = {8e-4, -1.1e-3, 6e-4};
  return out;
}

// Adds all solutions of a pose to those that are known: Run(F, T, aim, turning, plan, found) gives those of a plan,
// with the roots of the pose `aim` beside. One run of the first plan is enough where its roots are real, as many as solutions, and each a solution to many
// digits. Otherwise more runs follow, with the pose displaced to either side and by the next elimination, until one
// finds all that is known and no more, and one of the pose itself tells.
template <auto Run, class Frames, std::size_t N>
inline void solve_in_runs(const Frames& F, const Frame& T, const Turning& turning,
                          const std::array<std::array<int, 3>, N>& plans, Solutions& out) noexcept {
  const Frame there = displacement(), back = inverse(there);
  const int given = out.count;
  int least = -1, number = 0;
  for (const std::array<int, 3>& plan : plans)
    for (const Frame* shift : {static_cast<const Frame*>(nullptr), &there, &back}) {
      Solutions mine;
      const Frame aim = shift ? compose(T, *shift) : T;
      const Spectrum roots = Run(F, T, aim, turning, plan, mine);
      if (!shift) least = std::max(least, roots.real);
      const int known = out.count;
      for (int k = 0; k < mine.count; ++k) keep(mine.rows[static_cast<Index>(k)], out);
      const bool alone = number == 0 && given <= mine.count && roots.simple && out.count == roots.real && out.count > 0;
      const bool repeated = number > 0 && mine.count == known && out.count == known;
      if (out.count % 2 == 0 && least >= 0 && out.count >= least && (alone || repeated)) return;
      ++number;
    }
}

}  // namespace g6
}  // namespace ikgen_runtime
