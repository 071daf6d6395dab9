#pragma once

#include <array>
#include <cmath>
#include <complex>

#include "elimination/general_6r_runs.hpp"
#include "elimination/tall_null_plane.hpp"

namespace ikgen_runtime {

// --- one run of an elimination by half angles of both angles beside the hidden one --------------------------

namespace elimination {

// The solutions that roots lead to, once each.
struct TallSolutions {
  Index count = 0;
  std::array<std::array<Complex, 3>, 64> each;

  void add(const std::array<Complex, 3>& z) noexcept {
    constexpr double same = 1e-6;  // rounding moves roots with two solutions by less
    for (Index i = 0; i < count; ++i)
      if (std::abs(each[i][0] - z[0]) + std::abs(each[i][1] - z[1]) + std::abs(each[i][2] - z[2]) < same) return;
    if (count < each.size()) each[count++] = z;
  }
};

// As run_hidden_angle has it, by half angles of both angles beside the hidden one. Each real root has to lead to a
// solution of the equations, as no other counts; two of one root that lie apart are no halves of a double one.
template <class Equations, class Complete>
inline Spectrum run_both_half_angles(const Chain& F, const Frame& T, const Turning& turning, const Loop& loop,
                                     bool reverse, const Equations& eq, const Complete& complete,
                                     Solutions& out) noexcept {
  constexpr double accept = 0.03;  // rad: imaginary part of roots that candidates come from
  constexpr double solved = 1e-7;  // of the equations' size: what a solution that keeps half its digits leaves of them
  Spectrum roots;
  roots.real = -1;
  const TallResultant M = lift_both(make_pencil(eq.E, eq.left));
  TallRoots found;
  if (!find_tall_roots(eq.E, eq.left, M, found)) return roots;
  TallSolutions sure;
  int halves = 0, quarters = 0;
  roots.simple = true;
  for (const Complex& e : found.t) {
    const Root root = root_of(e, found.node);
    if (!(root.off < accept)) continue;
    const Complex z3(std::cos(root.angle), std::sin(root.angle));
    const Tall at = M.at(z3.real(), z3.imag());
    const TallQr qr(at);
    const NullPlane plane = null_plane(qr);
    if (plane.least > (solved + root.off) * M.size) continue;  // of the combination alone
    const TallPairs pairs = pairs_in(qr, plane);
    TallSolutions led;
    for (Index j = 0; j < pairs.count; ++j) {
      if (left_over(at, pairs.z4[j], pairs.z5[j]) < solved * M.size) led.add({z3, pairs.z4[j], pairs.z5[j]});
      const Vector t = complete(root.angle, pairs.z4[j], pairs.z5[j]);
      Vector q;
      for (Index n = 0; n < 6; ++n) q[loop.order[n]] = reverse ? -t[n] : t[n];
      add_refined(F, T, turning, q, roots, out);
    }
    const bool real = root.off < kReal || led.count > 1;
    for (Index i = 0; i < led.count && real; ++i) sure.add(led.each[i]);
    roots.simple = roots.simple && real && led.count > 0;
    halves += (real ? led.count == 0 : root.off < kHalf) ? 1 : 0;
    quarters += !real && root.off < kQuarter ? 1 : 0;
  }
  roots.count = static_cast<int>(sure.count);
  roots.perhaps = roots.count + halves;
  roots.doubtful = halves > 0 || quarters >= 4 || !found.sharp;
  if (found.ranked) roots.real = roots.count;
  return roots;
}

}  // namespace elimination
}  // namespace ikgen_runtime
