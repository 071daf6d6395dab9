#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "general_6r_candidate.hpp"
#include "general_6r_pairs.hpp"
#include "general_6r_solutions.hpp"

namespace ikgen_runtime {

// --- general_6r: by the eigenproblem ----------------------------------------------------------------

namespace g6 {

inline Solution solution_of(const Vector& q) noexcept {
  Solution out;
  for (Index i = 0; i < 6; ++i) {
    out.q[i] = wrap(q[i]);
    out.c[i] = std::cos(q[i]);
    out.s[i] = std::sin(q[i]);
  }
  return out;
}

// Adds one plan's solutions for the pose T, with the roots of the pose `aim` next to it.
inline Spectrum run_eigenproblem(const Chain& F, const Frame& T, const Frame& aim, const std::array<int, 3>& plan,
                                 Solutions& out) noexcept {
  const bool reverse = plan[1] != 0, swap = plan[2] != 0;
  const Loop loop = make_loop(F, aim, static_cast<Index>(plan[0]), reverse);
  const Equations eq = eliminate(loop);
  Mat<14, 12> left = eq.left;
  if (swap)
    for (Index r = 0; r < 14; ++r)
      for (Index k = 0; k < 9; ++k) left(r, k) = eq.left(r, 3 * (k % 3) + k / 3);
  const Resultant M = lift(make_pencil(eq.E, left));
  Spectrum roots = find_roots(eq.E, left, M, 0.03);
  for (int i = 0; i < roots.count; ++i) {
    const double t3 = roots.theta[static_cast<Index>(i)];
    const Pairs pairs = find_pairs(M.at(std::cos(t3), std::sin(t3)));
    for (Index j = 0; j < pairs.count; ++j) {
      const Complex z4 = swap ? pairs.z5[j] : pairs.z4[j], z5 = swap ? pairs.z4[j] : pairs.z5[j];
      const Vector t = complete(loop, eq, t3, z4, z5);
      Vector q;
      for (Index n = 0; n < 6; ++n) q[loop.order[n]] = reverse ? -t[n] : t[n];
      double before = 0.0;
      if (refine_one(F, T, q, before) < kVerified) keep(solution_of(q), out);
      if (!(before <= 1e-5)) roots.simple = false;
    }
  }
  return roots;
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

// Adds all solutions of a pose to those that are known. One run of the first plan is enough where its roots are
// real, apart and each a solution to many digits. Otherwise more runs follow, with the pose displaced to either side
// and by the next elimination, until one finds all that is known and no more.
template <std::size_t N>
inline void solve_eigenproblem(const Chain& F, const Frame& T, const std::array<std::array<int, 3>, N>& plans,
                               Solutions& out) noexcept {
  const Frame there = displacement(), back = inverse(there);
  const int given = out.count;
  int least = 0, number = 0;
  for (const std::array<int, 3>& plan : plans)
    for (const Frame* shift : {static_cast<const Frame*>(nullptr), &there, &back}) {
      Solutions mine;
      const Frame aim = shift ? compose(T, *shift) : T;
      const Spectrum roots = run_eigenproblem(F, T, aim, plan, mine);
      if (!shift) least = std::max(least, roots.real);
      const int known = out.count;
      for (int k = 0; k < mine.count; ++k) keep(mine.rows[static_cast<Index>(k)], out);
      const bool alone = number == 0 && given <= mine.count && roots.simple && out.count == roots.real && out.count > 0;
      const bool repeated = number > 0 && mine.count == known && out.count == known;
      if (out.count % 2 == 0 && out.count >= least && (alone || repeated)) return;
      ++number;
    }
}

}  // namespace g6
}  // namespace ikgen_runtime
