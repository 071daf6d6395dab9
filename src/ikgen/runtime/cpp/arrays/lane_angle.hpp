#pragma once

#include "arrays/constants.hpp"
#include "arrays/lanes.hpp"

namespace ikgen_runtime {

// Angle of the vector (x, y) in (-pi, pi], to 3e-16: reduced to |t| <= tan(pi/8), then a polynomial that
// is within 6e-17 of the arctangent there. Not defined where both are 0.
template <class Y, class X, int N = kCommon<Y, X>>
[[gnu::always_inline]] inline Lanes<N> angle(const Y& narrow_y, const X& narrow_x) noexcept {
  const Lanes<N> y = spread<N>(narrow_y), x = spread<N>(narrow_x);
  const auto ax = abs(x), ay = abs(y);
  const auto steep = ay > ax;
  const auto lesser = min(ax, ay), large = max(ax, ay);
  const auto high = lesser > 0.41421356237309503 * large;
  const auto t = select(high, lesser - large, lesser) / select(high, lesser + large, large);
  const auto z = t * t;
  const auto z2 = z * z;
  const auto z4 = z2 * z2;
  const auto low = (-0.3333333333333325 + 0.19999999999898324 * z) + z2 * (-0.1428571426608229 + 0.11111109635603796 * z);
  const auto mid = (-0.09090852527088297 + 0.07691054614825647 * z) + z2 * (-0.06649607953399717 + 0.057362969593526145 * z);
  const auto top = -0.04483218628995374 + 0.022748939747779046 * z;
  const auto first = (t + t * z * (low + z4 * (mid + z4 * top))) + select(high, kPi / 4, 0.0);
  const auto second = select(steep, kPi / 2 - first, first);
  const auto third = select(0.0 > x, kPi - second, second);
  return select(-1.2e-16 * ax > y, -third, third);  // an angle that rounds to -pi is pi
}

}  // namespace ikgen_runtime
