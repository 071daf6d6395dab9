#pragma once

#include <cmath>
#include <cstddef>
#include <type_traits>

#include "arrays/constants.hpp"
#include "arm/held_aim.hpp"
#include "arguments/pose_reading.hpp"

namespace ikgen_runtime {

// Poses as they come. Way<Arm> solves kBatch exact ones at once; Arm: as for Way and PoseReading.
template <class Arm, template <class> class Way> struct PoseSolver {
  using Options = typename Arm::Options;
  using Solutions = typename Arm::Solutions;

  static void solve(const Eigen::Isometry3d* poses, std::ptrdiff_t count, const Options& given,
                    Solutions* out) noexcept {
    constexpr int P = Way<Arm>::kBatch;
    const Checked checked(given);
    const Options& options = checked.options;
    if constexpr (P > 1)
      for (; count >= P; count -= P, poses += P, out += P) some<P>(poses, options, out);
    for (; count > 0; --count, ++poses, ++out) some<1>(poses, options, out);
  }

  static void solve(const Eigen::Isometry3d& pose, const Options& given, Solutions& out) noexcept {
    some<1>(&pose, Checked(given).options, &out);
  }

 private:
  // Options without a seed that is no number, or with one without the turns that doubles cannot tell apart;
  // with one, free values that are the defaults are the seed's.
  struct Checked {
    Options options;
    std::remove_const_t<std::remove_pointer_t<decltype(Options::seed)>> kept;

    explicit Checked(const Options& given) noexcept : options(given) {
      bool remote = false;
      for (int j = 0; j < Arm::kDof && options.seed; ++j) {
        const double value = std::abs(options.seed->data()[j]);
        remote = remote || value > kFarthestSeed;
        if (!(value < kInfinity)) options.seed = nullptr;
      }
      if (remote && options.seed) without_turns();
      if constexpr (Arm::kFree > 0)
        if (options.seed && options.hold_seed) hold_the_seed();
    }
    Checked(const Checked&) = delete;
    Checked& operator=(const Checked&) = delete;

    void hold_the_seed() noexcept {
      const auto plain = Options().free;
      auto own = plain;
      HeldAim<Arm>::values(options.seed->data(), own);
      for (std::size_t k = 0; k < Arm::kFree; ++k)
        if (options.free[k] == plain[k]) options.free[k] = own[k];
    }

    void without_turns() noexcept {
      kept = *options.seed;
      for (int j = 0; j < Arm::kDof; ++j)
        if (Arm::kRevolute[j] && !Arm::kHeld[j] && std::abs(kept[j]) > kFarthestSeed) kept[j] = std::fmod(kept[j], kTurn);
      options.seed = &kept;
    }
  };

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
        out->status = PoseReading<Arm>::refused(*poses);
      }
    }
  }
};

}  // namespace ikgen_runtime
