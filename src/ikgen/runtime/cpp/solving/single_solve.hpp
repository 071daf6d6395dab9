#pragma once

#include "solving/careful_solve.hpp"

namespace ikgen_runtime {

// Poses one by one, every row with care. Arm: as for CarefulSolve.
template <class Arm> struct SingleSolve {
  static constexpr int kBatch = 1;

  template <int P>
  static void solve(const Eigen::Isometry3d* pose, const typename Arm::Options& options,
                    typename Arm::Solutions* out) noexcept {
    RowPlaces<Arm> found;
    CarefulSolve<Arm>::solve(*pose, options, found, *out);
  }
};

}  // namespace ikgen_runtime
