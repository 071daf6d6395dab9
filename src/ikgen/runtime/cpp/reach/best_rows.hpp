// What the best rows of many poses measure.
#pragma once

#include <algorithm>
#include <cstddef>

#include "arrays/lanes.hpp"
#include "reach/row_measures.hpp"

namespace ikgen_runtime {

// Measures rows as many at once as a machine vector holds; keeps the best of each pose. Arm: as for RowMeasures.
template <class Arm> class BestRows {
 public:
  // Numbers a pose, which are 0 where it has no rows.
  BestRows(float* singular_values, float* margins) noexcept : singular_values_(singular_values), margins_(margins) {}

  void add(const double* q, std::size_t pose) noexcept {
    for (int j = 0; j < Arm::kDof; ++j) q_[j][waiting_] = q[j];
    pose_[waiting_] = pose;
    if (++waiting_ == kPack) finish();
  }

  // Measures those that wait; lanes that none waits in repeat the ones before.
  void finish() noexcept {
    Lanes<kPack> q[Arm::kDof];
    for (int j = 0; j < Arm::kDof; ++j) q[j] = load<kPack>(q_[j]);
    double value[kPack], margin[kPack];
    store(RowMeasures<Arm, kPack>::singular_value(q), value);
    store(RowMeasures<Arm, kPack>::margin(q), margin);
    for (int i = 0; i < waiting_; ++i) {
      singular_values_[pose_[i]] = std::max(singular_values_[pose_[i]], static_cast<float>(value[i]));
      margins_[pose_[i]] = std::max(margins_[pose_[i]], static_cast<float>(margin[i]));
    }
    waiting_ = 0;
  }

 private:
  static constexpr int kPack = kNative;
  float *singular_values_, *margins_;
  double q_[Arm::kDof][kPack] = {};
  std::size_t pose_[kPack] = {};
  int waiting_ = 0;
};

}  // namespace ikgen_runtime
