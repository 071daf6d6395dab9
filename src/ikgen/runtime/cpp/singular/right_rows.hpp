// Right rows among those that are known.
#pragma once

#include "rows/row_pair.hpp"
#include "rows/singular_value.hpp"
#include "singular/curve_samples.hpp"

namespace ikgen_runtime {

// Arm: as for CurveSamples, SingularValue and RowPair.
template <class Arm> struct RightRows {
  using Policy = typename Arm::Policy;
  using Row = SolutionRows<Arm>;

  // Adds a row, as singular where it is one of a continuum or next to it.
  static void add(const HeldAim<Arm>& aim, RowPlaces<Arm>& out, const double* q, bool marked) noexcept {
    const bool singular = SingularValue<Arm>::below(q, marked ? Policy::kContinuumBelow : Policy::kSingularBelow);
    for (int k = 0; k < out.count && singular; ++k)
      if (Row::flag(out, k) && between(aim, q, Row::row(out, k))) return;
    Row::add(out, q, singular);
  }

  // The same of one that is marked, in place of those of its continuum that nothing tells from it.
  static void add_instead(const HeldAim<Arm>& aim, RowPlaces<Arm>& out, const double* q) noexcept {
    int kept = 0;
    for (int k = 0; k < out.count; ++k)
      if (!(Row::flag(out, k) && between(aim, q, Row::row(out, k)))) Row::move(out, k, kept++);
    out.count = kept;
    add(aim, out, q, true);
  }

 private:
  // Whether nothing tells two rows near each other apart: the pose is theirs between them too, on the straight way or on a
  // curve beside that.
  static bool between(const HeldAim<Arm>& aim, const double* a, const double* b) noexcept {
    using Curve = CurveSamples<Arm>;
    if (!RowPair<Arm>::within(Policy::kNeighbouring, a, b)) return false;
    double middle[Arm::kDof];
    for (int j = 0; j < Arm::kDof; ++j) middle[j] = a[j] + 0.5 * Row::change(j, a, b);
    const double off = PoseError<Arm>(middle, aim).largest();
    return off < Policy::kHalfway || (off < Policy::kArrived && Curve::is_solution(Curve(aim).at(middle)));
  }
};

}  // namespace ikgen_runtime
