#pragma once

#include "roots/trig_quartic.hpp"

namespace ikgen_runtime {

// The roots as branches, complex pairs with imaginary parts up to x[5] (rad) as one; none where the angle is free.
inline int trig_quartic_wide_branches(const double (&x)[6], double (&roots)[4][2]) noexcept {
  return roots_as_branches(trig_quartic(x[0], x[1], x[2], x[3], x[4], x[5]), roots);
}

}  // namespace ikgen_runtime
