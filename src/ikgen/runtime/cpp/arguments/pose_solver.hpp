#pragma once

#include <cstddef>

#include "arguments/given_options.hpp"
#include "arguments/pose_reading.hpp"

namespace ikgen_runtime {

// Poses as they come. Way<Arm> solves kBatch exact ones at once; Arm: as for Way and PoseReading.
template <class Arm, template <class> class Way> struct PoseSolver {
  using Options = typename Arm::Options;
  using Solutions = typename Arm::Solutions;

  static void solve(const Eigen::Isometry3d* poses, std::ptrdiff_t count, const GivenOptions<Arm>& given,
                    Solutions* out) noexcept {
    constexpr int P = Way<Arm>::kBatch;
    const Options& options = given.options;
    if (!given.valid) return refuse(count, out);
    if constexpr (P > 1)
      for (; count >= P; count -= P, poses += P, out += P) some<P>(poses, options, out);
    for (; count > 0; --count, ++poses, ++out) some<1>(poses, options, out);
  }

  static void solve(const Eigen::Isometry3d& pose, const GivenOptions<Arm>& given, Solutions& out) noexcept {
    if (!given.valid) return refuse(1, &out);
    some<1>(&pose, given.options, &out);
  }

 private:
  [[gnu::cold, gnu::noinline]] static void refuse(std::ptrdiff_t count, Solutions* out) noexcept {
    for (; count > 0; --count, ++out) {
      out->count = 0;
      out->status = Arm::Status::Invalid;
    }
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
      Eigen::Isometry3d clean;
      if (PoseReading<Arm>::readable(*poses, clean, *out)) Way<Arm>::template solve<1>(&clean, options, out);
    }
  }
};

}  // namespace ikgen_runtime
