#pragma once

#include "rows/solution_rows.hpp"

namespace ikgen_runtime {

// Two rows that are near each other. Arm: as for SolutionRows.
template <class Arm> struct RowPair {
  static bool within(double reach, const double* a, const double* b) noexcept {
    for (int j = 0; j < Arm::kDof; ++j)
      if (!(std::abs(SolutionRows<Arm>::change(j, a, b)) < reach)) return false;
    return true;
  }

  // The largest change of any joint.
  static double farthest(const double* a, const double* b) noexcept {
    double out = 0.0;
    for (int j = 0; j < Arm::kDof; ++j) out = std::max(out, std::abs(SolutionRows<Arm>::change(j, a, b)));
    return out;
  }

  // Whether some row of `rows` is within `reach` of q.
  template <class Out> static bool any_within(double reach, const double* q, Out& rows) noexcept {
    for (int k = 0; k < rows.count; ++k)
      if (within(reach, q, SolutionRows<Arm>::row(rows, k))) return true;
    return false;
  }
};

}  // namespace ikgen_runtime
