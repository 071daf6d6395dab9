#pragma once

#include "held/held_sample.hpp"
#include "held/row_preference.hpp"

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
  static constexpr int N = kNative;
  double measured = kInfinity, singular[Sample::kLanes];  // of the sample at that value

  void measure(const Sample& s) noexcept {
    measured = s.held;
    int lanes[Sample::kLanes + N], count = 0;
    for (int l = 0; l < s.lanes; ++l)
      if (s.inside(l)) lanes[count++] = l;
    std::fill_n(lanes + count, N, 0);
    for (int k = 0; k < count; k += N) {
      double values[N];
      Lanes<N> q[Arm::kDof];
      for (int j = 0; j < Arm::kDof; ++j) {
        for (int i = 0; i < N; ++i) values[i] = s.q[j][lanes[k + i]];
        q[j] = load<N>(values);
      }
      store(-LeastSingularValue<Arm, N>::of(q), values);
      for (int i = 0; i < N && k + i < count; ++i) singular[lanes[k + i]] = values[i];
    }
  }
};

}  // namespace ikgen_runtime
