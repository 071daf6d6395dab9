#pragma once

#include "arrays/lanes.hpp"

namespace ikgen_runtime {

template <int N> struct Sines {
  Lanes<N> cosine, sine;
};

// The nearest whole number, for |x| < 2^51: what is added takes the digits behind the point away.
template <int N, bool H> [[gnu::always_inline]] inline Lanes<N> nearest(const LanesOf<N, H>& x) noexcept {
  constexpr double kShift = 6755399441055744.0;  // 1.5 * 2^52
  return (x + kShift) - kShift;
}

// Cosine and sine to 2e-16, for |x| < 1e5: reduced to at most pi/4 by pi/2 in three parts (Cody & Waite 1980), then
// Taylor's polynomials, whose next terms are below 5e-17 there.
template <int N, bool H> [[gnu::always_inline]] inline Sines<N> sines(const LanesOf<N, H>& x) noexcept {
  const Lanes<N> k = nearest(0.63661977236758134 * x);
  const Lanes<N> r = ((x - k * 1.570796325802803) - k * 9.920935791635221e-10) - k * 5.170182981794105e-19;
  const Lanes<N> z = r * r, z2 = z * z, z4 = z2 * z2;
  const Lanes<N> s = r - r * z * ((1.0 / 6 - z * (1.0 / 120)) + z2 * (1.0 / 5040 - z * (1.0 / 362880)) +
                                  z4 * ((1.0 / 39916800 - z * (1.0 / 6227020800)) + z2 * (1.0 / 1307674368000)));
  const Lanes<N> c = (1.0 - 0.5 * z) + z2 * ((1.0 / 24 - z * (1.0 / 720)) + z2 * (1.0 / 40320 - z * (1.0 / 3628800)) +
                                            z4 * ((1.0 / 479001600 - z * (1.0 / 87178291200)) + z2 * (1.0 / 20922789888000)));
  const Lanes<N> quarter = k - 4.0 * nearest(0.25 * k);  // -2, -1, 0, 1 or 2
  const auto odd = (abs(quarter) > 0.5) & (1.5 > abs(quarter));
  const Lanes<N> a = select(odd, s, c), b = select(odd, c, s);
  return {select((quarter > 0.5) | (-1.5 > quarter), -a, a), select((-0.5 > quarter) | (quarter > 1.5), -b, b)};
}

template <int N, bool H>
[[gnu::always_inline]] inline void turn_to(const LanesOf<N, H>& angle, LanesOf<N, H>& cosine, LanesOf<N, H>& sine) noexcept {
  const Sines<N> of = sines(angle);
  cosine = of.cosine;
  sine = of.sine;
}

// (cosine, sine) turned by an angle of at most 0.1, to 2e-16.
template <int N, bool H> [[gnu::always_inline]] inline Sines<N> turned(const Sines<N>& by, const LanesOf<N, H>& x) noexcept {
  const Lanes<N> z = x * x;
  const Lanes<N> s = x - x * z * ((1.0 / 6 - z * (1.0 / 120)) + z * z * (1.0 / 5040 - z * (1.0 / 362880)));
  const Lanes<N> c = z * ((0.5 - z * (1.0 / 24)) + z * z * (1.0 / 720 - z * (1.0 / 40320)));  // 1 less it
  return {by.cosine - (by.cosine * c + by.sine * s), by.sine - (by.sine * c - by.cosine * s)};
}

}  // namespace ikgen_runtime
