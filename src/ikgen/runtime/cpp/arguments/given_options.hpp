#pragma once

#include <cmath>
#include <cstddef>

#include "arrays/constants.hpp"
#include "arm/held_aim.hpp"

namespace ikgen_runtime {

// A copy of a seed without the turns that doubles cannot tell apart: it may lie where rows are written. Arm: kDof,
// kPeriod, kHeld, Joints.
template <class Arm> struct GivenSeed {
  typename Arm::Joints values;
  bool there;  // and all numbers

  explicit GivenSeed(const typename Arm::Joints* seed) noexcept : there(seed != nullptr) {
    for (int j = 0; j < Arm::kDof && there; ++j) {
      const double value = seed->data()[j];
      const bool remote = Arm::kPeriod[j] > 0.0 && !Arm::kHeld[j] && std::abs(value) > kFarthestSeed;
      values.data()[j] = remote ? std::fmod(value, Arm::kPeriod[j]) : value;
      there = std::abs(value) < kInfinity;
    }
  }
  GivenSeed(const GivenSeed&) = delete;
  GivenSeed& operator=(const GivenSeed&) = delete;

  const typename Arm::Joints* seed() const noexcept { return there ? &values : nullptr; }
};

// Options with such a seed; with one, free values that are the defaults are the seed's. Arm: as for GivenSeed; Options.
template <class Arm> struct GivenOptions {
  using Options = typename Arm::Options;
  GivenSeed<Arm> given;
  Options options;
  bool valid = true;  // the free values are numbers

  explicit GivenOptions(const Options& from) noexcept : given(from.seed), options(from) {
    options.seed = given.seed();
    if constexpr (Arm::kFree > 0) {
      if (options.seed && options.hold_seed) hold_the_seed();
      for (const double value : options.free) valid = valid && std::abs(value) < kInfinity;
    }
  }

 private:
  void hold_the_seed() noexcept {
    const auto plain = Options().free;
    auto own = plain;
    HeldAim<Arm>::values(options.seed->data(), own);
    for (std::size_t k = 0; k < Arm::kFree; ++k)
      if (options.free[k] == plain[k]) options.free[k] = own[k];
  }
};

}  // namespace ikgen_runtime
