#pragma once

#include <array>

#include "elimination/hidden_angle_run.hpp"

namespace ikgen_runtime {

// --- general_6r: by the eigenproblem ----------------------------------------------------------------

namespace elimination {

// Adds one plan's solutions for the pose T, with the roots of the pose `aim` next to it.
inline Spectrum run_eigenproblem(const Chain& F, const Frame& T, const Frame& aim, const Turning& turning,
                                 const std::array<int, 3>& plan, Solutions& out) noexcept {
  const Loop loop = make_loop(F, aim, static_cast<Index>(plan[0]), plan[1] != 0);
  const Equations eq = eliminate(loop);
  const auto all = [&](double t3, Complex z4, Complex z5) noexcept { return complete(loop, eq, t3, z4, z5); };
  return run_hidden_angle(F, T, turning, loop, plan, eq, all, out);
}

}  // namespace elimination
}  // namespace ikgen_runtime
