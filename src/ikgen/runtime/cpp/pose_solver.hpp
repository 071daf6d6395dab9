#pragma once

#include <cmath>
#include <cstddef>

#include "constants.hpp"
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
  // Options without a seed that is no number; with one, free values that are the defaults are the seed's.
  static Options checked(const Options& options) noexcept {
    Options out = options;
    for (int j = 0; j < Arm::kDof && out.seed; ++j)
      if (!(std::abs(out.seed->data()[j]) < kInfinity)) out.seed = nullptr;
    if constexpr (Arm::kFree > 0) {
      const Options plain;
      for (std::size_t k = 0; k < Arm::kFree && out.seed && out.hold_seed; ++k)
        if (out.free[k] == plain.free[k]) out.free[k] = out.seed->data()[Arm::kFreeJoints[k]];
    }
    return out;
  }

  template <int P>
  [[gnu::always_inline]] static void some(const Eigen::Isometry3d* poses, const Options& options,
                                          Solutions* out) noexcept {
    bool exact = true;
    for (int p = 0; p < P; ++p) exact = PoseReading<Arm>::exact(poses[p]) && exact;
    if (!exact) return clean_and_solve(poses, P, options, out);
    Way<Arm>::template solve<P>(poses, options, out);
  }

  // Few poses need it: small code, quickly compiled.
  [[gnu::cold, gnu::noinline]] static void clean_and_solve(const Eigen::Isometry3d* poses, int count,
                                                           const Options& options, Solutions* out) noexcept {
    for (; count > 0; --count, ++poses, ++out) {
      Eigen::Isometry3d clean = *poses;
      if (PoseReading<Arm>::clean(clean)) {
        Way<Arm>::template solve<1>(&clean, options, out);
      } else {
        out->count = 0;
        out->status = Arm::Status::Invalid;
      }
    }
  }
};

}  // namespace ikgen_runtime
