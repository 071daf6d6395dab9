#pragma once

#include <cstddef>

#include "elimination/general_6r_eigenproblem.hpp"
#include "elimination/general_6r_search.hpp"
#include "elimination/six_joint_arm.hpp"

namespace ikgen_runtime {

// --- general_6r: all real solutions of any 6R chain --------------------------------------------------
// Elimination of Raghavan & Roth (1990, 1993): by a trigonometric resultant, which says itself where it is not
// sure, and then by an eigenproblem.

namespace elimination {

// none: whether it was found already that there are no solutions; blurred: those that rounding hides, if any are known. As
// solve_in_runs.
template <class Plan>
inline bool solve_6r(const Chain& F, const Frame& T, bool none, Solutions& blurred, Solutions& out) noexcept {
  const bool sure = solve_resultant<run_resultant>(F, T, Plan::kResultants, none, blurred, out) ||
                    solve_in_runs<run_eigenproblem>(F, T, kAllTurn, Plan::kEigenproblems, out);
  take_blurred(blurred, out);
  return sure;
}
template <class Plan> inline bool solve_6r(const Chain& F, const Frame& T, Solutions& out) noexcept {
  Solutions blurred;
  return solve_6r<Plan>(F, T, false, blurred, out);
}

}  // namespace elimination

// All real solutions of F_0 Rz(q_1) F_1 ... Rz(q_6) F_6 = T, sorted. F: constant rigid transforms, the upper three
// rows of each by rows; T: the same. Plan: kLength (m), a typical size of the arm; kResultants (start, reverse) and
// kEigenproblems (start, reverse, swap), arrays of eliminations in order of preference, the former perhaps empty.
// Joint angles are in (-pi, pi], distinct, and verified to 0.5e-9 (lengths over kLength).
template <class Plan>
inline void general_6r(const double (&F)[7][12], const double (&T)[12], elimination::Solutions& out) noexcept {
  out.count = 0;
  elimination::solve_6r<Plan>(elimination::chain_of<Plan>(F), elimination::scaled_frame<Plan>(T), out);
  elimination::sort_rows(elimination::kAllTurn, out);
}

}  // namespace ikgen_runtime
