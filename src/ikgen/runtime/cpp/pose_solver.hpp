#pragma once

#include <cmath>
#include <cstddef>

#include "pose_reading.hpp"

namespace ikgen_runtime {

// Poses as they come. Way<Arm> solves kBatch exact ones at once; Arm: as for Way and PoseReading.
template <class Arm, template <class> class Way> struct PoseSolver {
  using Options = typename Arm::Options;
  using Solutions = typename Arm::Solutions;

  static void solve(const Eigen::Isometry3d* poses, std::ptrdiff_t count, const Options& given,
                    Solutions* out) noexcept {
    constexpr int P = Way<Arm>::kBatch;
    const Options options = checked(given);
    if constexpr (P > 1)
      for (; count >= P; count -= P, poses += P, out += P) some<P>(poses, options, out);
    for (; count > 0; --count, ++poses, ++out) some<1>(poses, options, out);
  }

  static void solve(const Eigen::Isometry3d& pose, const Options& given, Solutions& out) noexcept {
    some<1>(&pose, checked(given), &out);
  }

 private:
  // Options without a seed that is no number.
  static Options checked(const Options& options) noexcept {
    Options out = options;
    for (int j = 0; j < Arm::kDof && out.seed; ++j)
      if (!(std::abs(out.seed->data()[j]) < kInfinity)) out.seed = nullptr;
    return out;
  }

  template <int P> static void some(const Eigen::Isometry3d* poses, const Options& options, Solutions* out) noexcept {
    bool exact = true;
    for (int p = 0; p < P; ++p) exact = PoseReading<Arm>::exact(poses[p]) && exact;
    if (exact) {
      Way<Arm>::template solve<P>(poses, options, out);
    } else {
      for (int p = 0; p < P; ++p) clean_and_solve(poses[p], options, out[p]);
    }
  }

  // Few poses need it: small code, quickly compiled.
  [[gnu::cold, gnu::noinline]] static void clean_and_solve(const Eigen::Isometry3d& pose, const Options& options,
                                                           Solutions& out) noexcept {
    Eigen::Isometry3d clean = pose;
    if (PoseReading<Arm>::exact(pose) || PoseReading<Arm>::clean(clean)) {
      Way<Arm>::template solve<1>(&clean, options, &out);
    } else {
      out.count = 0;
      out.status = Arm::Status::Invalid;
    }
  }
};

}  // namespace ikgen_runtime
