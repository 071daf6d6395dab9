// Right rows among those that are known.
#pragma once

#include "rows/singular_value.hpp"
#include "rows/row_pair.hpp"

namespace ikgen_runtime {

// Arm: as for SingularValue, RowPair and SolutionRows.
template <class Arm> struct RightRows {
  using Policy = typename Arm::Policy;
  using Row = SolutionRows<Arm>;

  // Adds a row, as singular where it is one of a continuum or next to it.
  static void add(const HeldAim<Arm>& aim, RowPlaces<Arm>& out, const double* q, bool marked) noexcept {
    const bool singular = SingularValue<Arm>::below(q, marked ? Policy::kContinuumBelow : Policy::kSingularBelow);
    for (int k = 0; k < out.count && singular; ++k)
      if (Row::flag(out, k) && RowPair<Arm>::between(aim, q, Row::row(out, k))) return;
    Row::add(out, q, singular);
  }

  // The same of one that is marked, in place of those of its continuum that nothing tells from it.
  static void add_instead(const HeldAim<Arm>& aim, RowPlaces<Arm>& out, const double* q) noexcept {
    int kept = 0;
    for (int k = 0; k < out.count; ++k)
      if (!(Row::flag(out, k) && RowPair<Arm>::between(aim, q, Row::row(out, k)))) Row::move(out, k, kept++);
    out.count = kept;
    add(aim, out, q, true);
  }
};

}  // namespace ikgen_runtime
