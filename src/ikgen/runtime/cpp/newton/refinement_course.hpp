#pragma once

#include <cstddef>
#include <iterator>

#include "arrays/constants.hpp"

namespace ikgen_runtime {

// At most `steps` steps for what is off by at least `fine` and less than `promising` once the stage before is done.
struct RefineStage {
  int steps;
  double fine, promising;
};

// How steps from one start go on: only what is promising takes many. All digits are wanted where they come easily, as
// rows may lie on a limit.
template <class Policy> struct RefinementCourse {
  double best = kInfinity;  // the least error of this stage

  // Whether a configuration that is off by `worst` is the best one so far.
  bool takes(double worst) noexcept {
    stalled = worst < Policy::kProgress * best && worst > Policy::kConverged ? 0 : stalled + 1;
    if (!(worst < best)) return false;
    best = worst;
    return true;
  }

  // Whether the next step goes from the best configuration: a new stage begins. None goes on once it is done.
  bool starts_again() noexcept {
    if (step++ < stage().steps && stalled < Policy::kPatience && best > Policy::kConverged) return false;
    done = !(best >= stage().fine && best < stage().promising) || at + 1 == std::size(Policy::kRefinement);
    if (done) return true;
    ++at;
    step = stalled = 0;
    best = kInfinity;
    return true;
  }

  bool done = false;

 private:
  std::size_t at = 0;
  int step = 0, stalled = 0;

  const RefineStage& stage() const noexcept { return Policy::kRefinement[at]; }
};

}  // namespace ikgen_runtime
