#pragma once

#include <cstddef>

#include "general_6r_eigenproblem.hpp"
#include "general_6r_search.hpp"

namespace ikgen_runtime {

// --- general_6r: all real solutions of any 6R chain --------------------------------------------------
// Elimination of Raghavan & Roth (1990, 1993): by a trigonometric resultant, which says itself where it is not
// sure, and then by an eigenproblem.

// Upper rows of a transform, its lengths over the plan's.
template <class Plan>
inline g6::Frame scaled_frame(const double (&x)[12]) noexcept {
  g6::Frame out;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) out.R(r, c) = x[4 * r + c];
    out.p[r] = x[4 * r + 3] * (1.0 / Plan::kLength);
  }
  return out;
}

template <class Plan>
inline g6::Chain chain_of(const double (&F)[7][12]) noexcept {
  g6::Chain out;
  for (std::size_t n = 0; n < 7; ++n) out[n] = scaled_frame<Plan>(F[n]);
  return out;
}

// All real solutions of F_0 Rz(q_1) F_1 ... Rz(q_6) F_6 = T, sorted. F: constant rigid transforms, the upper three
// rows of each by rows; T: the same. Plan: kLength (m), a typical size of the arm; kResultants (start, reverse) and
// kEigenproblems (start, reverse, swap), arrays of eliminations in order of preference, the former perhaps empty.
// Joint angles are in (-pi, pi], distinct, and verified to 1e-9 (lengths over kLength).
template <class Plan>
inline void general_6r(const double (&F)[7][12], const double (&T)[12], g6::Solutions& out) noexcept {
  const g6::Chain chain = chain_of<Plan>(F);
  const g6::Frame target = scaled_frame<Plan>(T);
  out.count = 0;
  if (!g6::solve_resultant(chain, target, Plan::kResultants, out))
    g6::solve_eigenproblem(chain, target, Plan::kEigenproblems, out);
  g6::sort_rows(out);
}

}  // namespace ikgen_runtime
