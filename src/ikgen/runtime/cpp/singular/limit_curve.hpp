// Where a continuum that the arm has goes on inside the limits.
#pragma once

#include "arm/joint_bounds.hpp"
#include "newton/newton_refinement.hpp"
#include "singular/right_rows.hpp"
#include "singular/near_continuum.hpp"

namespace ikgen_runtime {

// Arm: as for NearContinuum.
template <class Arm> struct LimitCurve {
  using Aim = HeldAim<Arm>;
  using Curve = NearContinuum<Arm>;
  using Options = typename Arm::Options;
  using Passed = typename Curve::Passed;
  using Policy = typename Arm::Policy;
  using Row = SolutionRows<Arm>;

  // Adds a row inside of the continuum through a solution, if samples of it, or what lies beside the least outside, are,
  // and no row stands for it.
  static void add(const Aim& aim, const Options& options, const double* start, RowPlaces<Arm>& out) noexcept {
    Passed passed;
    Curve curve(aim);
    if (curve.trace(start, passed) != Curve::Kind::Whole) return;
    double off[Passed::kSamples];
    const int count = passed.count = std::min(curve.passing, static_cast<int>(Passed::kSamples));
    for (int k = 0; k < out.count; ++k)
      if (Row::flag(out, k) && curve.passes(passed, Row::row(out, k))) return;
    for (int k = 0; k < count; ++k) off[k] = outside(passed.sample[k].q);
    for (int k = 0; k < count; ++k) {
      const bool before = !passed.first[k], after = k + 1 < count && !passed.first[k + 1];
      if ((before && off[k - 1] < off[k]) || (after && off[k + 1] < off[k])) continue;
      const double beside = std::min(before ? off[k - 1] : kInfinity, after ? off[k + 1] : kInfinity);
      if (!(off[k] + beside < kWay * Policy::kTryStep)) continue;
      const Bracket bracket{passed.sample + k, before, after};
      if (bracket.take(curve, aim, options, out)) return;
    }
  }

 private:
  static constexpr double kGolden = 0.6180339887498949, kPart = 0.5;  // of Policy::kLimitTolerance
  static constexpr double kWay = 1.2;  // of Policy::kTryStep: by so much joints move from one sample to the next at most
  static constexpr int kHalvings = 40;

  // The most by which a joint is outside its limits, whole turns aside; 0 inside.
  static double outside(const double* q) noexcept { return std::max(JointBounds<Arm>(true).outside(q), 0.0); }

  // A sample, and whether there is one before it and one after it.
  struct Bracket {
    const typename Curve::Sample* middle;
    bool before, after;

    // The row at a share of the way to the sample after it, or before it where that is negative.
    double at(Curve& curve, double share, double* q) const noexcept {
      typename Curve::Sample s = *middle;
      if (share > 0.0) s = curve.part(middle[0], middle[1], share);
      if (share < 0.0) s = curve.part(middle[-1], middle[0], 1.0 + share);
      std::copy_n(s.q, Arm::kDof, q);
      return outside(q);
    }

    // Adds the row that is least outside (golden section; Kiefer 1953), if that is inside; whether it is.
    bool take(Curve& curve, const Aim& aim, const Options& options, RowPlaces<Arm>& out) const noexcept {
      double low = before ? -1.0 : 0.0, high = after ? 1.0 : 0.0, q[Arm::kDof], other[Arm::kDof];
      double left = high - kGolden * (high - low), right = low + kGolden * (high - low);
      if (settles(at(curve, 0.0, q), q, aim, options, out)) return true;
      double here = at(curve, left, q), there = at(curve, right, other);
      for (int i = 0; i < kHalvings && std::min(here, there) > kPart * Policy::kLimitTolerance; ++i) {
        if (here < there) {
          high = right;
          right = left;
          there = here;
          std::copy_n(q, Arm::kDof, other);
          here = at(curve, left = high - kGolden * (high - low), q);
        } else {
          low = left;
          left = right;
          here = there;
          std::copy_n(other, Arm::kDof, q);
          there = at(curve, right = low + kGolden * (high - low), other);
        }
      }
      return settles(std::min(here, there), here < there ? q : other, aim, options, out);
    }

    static bool settles(double off, double* q, const Aim& aim, const Options& options, RowPlaces<Arm>& out) noexcept {
      if (!(off < Policy::kLimitTolerance && NewtonRefinement<Arm>::refine(q, aim) && Row::place(q, options))) return false;
      RightRows<Arm>::add(aim, out, q, true);
      return true;
    }
  };
};

}  // namespace ikgen_runtime
