// Rows that are hardly outside the limits: near singularities the pose does not tell that.
#pragma once

#include "newton/newton_refinement.hpp"
#include "rows/solution_rows.hpp"

namespace ikgen_runtime {

// Arm: as for NewtonRefinement and SolutionRows.
template <class Arm> struct LimitRows {
  using Aim = HeldAim<Arm>;
  using Options = typename Arm::Options;
  using Policy = typename Arm::Policy;
  using Refinement = NewtonRefinement<Arm>;
  using Row = SolutionRows<Arm>;

  // Leaves the rows that can be placed. One that is hardly outside takes Newton steps first; if it stays there its other
  // joints do, and what is outside, all or one joint, is put on the limits.
  template <class Out> static void place_all(const Aim& aim, const Options& options, Out& out) noexcept {
    Out given = out;
    out.count = 0;
    int hardly = 0;
    for (int k = 0; k < given.count; ++k) {
      double q[Arm::kDof];
      std::copy_n(Row::row(given, k), Arm::kDof, q);
      const typename Row::Place where = Row::placed(q, options);
      if (where == Row::Place::Hardly) Row::move(given, k, hardly++);
      if (where != Row::Place::Inside) continue;
      std::copy_n(q, Arm::kDof, Row::row(out, out.count));
      Row::flag(out, out.count++) = Row::flag(given, k);
    }
    for (int k = 0; k < hardly; ++k) take(aim, options, Row::row(given, k), Row::flag(given, k), out);
  }

 private:
  template <class Out> static void take(const Aim& aim, const Options& options, double* q, bool singular, Out& out) noexcept {
    double on_limits[Arm::kDof];
    std::copy_n(q, Arm::kDof, on_limits);
    Row::placed(on_limits, options);
    if (Refinement::refine(q, aim) && Row::place(q, options)) return Row::add(out, q, singular);
    // How far each joint is outside depends on how far along a direction that hardly moves the pose: all on limits stay
    // there, or one alone.
    int count = 0;
    for (int j = 0; j < Arm::kDof; ++j) count += is_on_limit(j, on_limits);
    for (int alone = -1; alone < (count > 1 ? Arm::kDof : 0); ++alone) {
      if (alone >= 0 && !is_on_limit(alone, on_limits)) continue;
      double row[Arm::kDof];
      bool still[Arm::kDof];
      std::copy_n(on_limits, Arm::kDof, row);
      for (int j = 0; j < Arm::kDof; ++j) still[j] = alone < 0 ? is_on_limit(j, on_limits) : j == alone;
      if (Refinement::error_after(row, aim, still) < Policy::kExact && Row::place(row, options))
        return Row::add(out, row, singular);
    }
  }

  static bool is_on_limit(int j, const double* q) noexcept {
    return q[j] == Arm::kLower.data()[j] || q[j] == Arm::kUpper.data()[j];
  }
};

}  // namespace ikgen_runtime
