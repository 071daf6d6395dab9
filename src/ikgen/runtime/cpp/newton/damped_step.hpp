#pragma once

#include "arrays/small_matrix.hpp"

namespace ikgen_runtime {

// The damped Newton step (Levenberg 1944, Marquardt 1963) towards no error `e`, of slope V, `worst` its largest entry: at a
// fold of the solution set damped steps halve it. X: double, or lanes.
template <class Policy, class X, int Rows, int Columns>
inline void damped_step(const X (&V)[Rows][Columns], const X (&e)[Rows], const X& worst, X (&x)[Columns]) noexcept {
  using std::max;
  using std::min;
  const X bounded = min(worst, 1.0);
  least_squares(V, e, max(Policy::kDamping * (bounded * bounded), Policy::kLeastDamping), x);
  for (X& one : x) one = min(max(one, -Policy::kLargestStep), Policy::kLargestStep);
}

}  // namespace ikgen_runtime
