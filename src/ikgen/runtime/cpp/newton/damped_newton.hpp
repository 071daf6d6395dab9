#pragma once

#include <algorithm>

#include "newton/damped_step.hpp"
#include "newton/refinement_course.hpp"

namespace ikgen_runtime {

// The error that damped Newton steps from q leave, and q where that is. at(q): the error there, by its members error, slope and
// largest().
template <class Policy, int N, class At> inline double damped_newton(double* q, const At& at) noexcept {
  double trial[N];
  std::copy_n(q, N, trial);
  for (RefinementCourse<Policy> course;;) {
    const auto here = at(trial);
    const double worst = here.largest();
    if (course.takes(worst)) std::copy_n(trial, N, q);
    if (course.starts_again()) {
      if (course.done) return course.best;
      std::copy_n(q, N, trial);
    } else {
      double step[N];
      damped_step<Policy>(here.slope, here.error, worst, step);
      for (int j = 0; j < N; ++j) trial[j] += step[j];
    }
  }
}

}  // namespace ikgen_runtime
