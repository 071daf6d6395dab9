#pragma once

#include "held/held_sample.hpp"
#include "rows/row_preference.hpp"

namespace ikgen_runtime {

// What rows of a sample cost; singular values of all that are inside are computed at once. Arm: as for RowPreference and
// HeldSample.
template <class Arm> struct SampleCosts {
  using Sample = HeldSample<Arm>;
  const RowPreference<Arm>& preference;

  explicit SampleCosts(const RowPreference<Arm>& by) noexcept : preference(by) {}

  // Of a row that is inside, in its lane; q: placed.
  double of(const Sample& s, int lane, const double* q) noexcept {
    if (preference.prefer != Arm::Prefer::Dexterous) return preference.cost(q);
    if (s.held != measured) measure(s);
    return singular[lane];
  }

 private:
  double measured = kInfinity, singular[Sample::kLanes];  // of the sample at that value

  void measure(const Sample& s) noexcept {
    measured = s.held;
    double rows[Sample::kLanes][Arm::kDof], values[Sample::kLanes];
    int lanes[Sample::kLanes], count = 0;
    for (int l = 0; l < s.lanes; ++l) {
      if (!s.inside(l)) continue;
      s.row(l, rows[count]);
      lanes[count++] = l;
    }
    LeastSingularValue<Arm, kNative>::of_rows(count, [&](int k) noexcept { return rows[k]; }, values);
    for (int k = 0; k < count; ++k) singular[lanes[k]] = -values[k];
  }
};

}  // namespace ikgen_runtime
