#pragma once

#include <array>
#include <cmath>

#include "elimination/method_in_runs.hpp"
#include "elimination/revolute_loop.hpp"
#include "elimination/six_joint_arm.hpp"

namespace ikgen_runtime {

// --- two_slides: four revolute joints and two slides, by a trigonometric polynomial of degree 4 -----------
// The rotations of the revolute joints close a spherical quadrilateral. One angle hidden, the opposite one has two
// values, from the cosine, and the two between follow. The lengths of the slides are eliminated by the triple product
// g of their directions and of the loop's displacement without them. It is linear in the angles beside the hidden
// one, whose cosines and sines have the divisor h = 1 - m^2, m the cosine between the axes beside it; so g+ g- h,
// over both values, has degree 4 in the hidden angle: the eight solutions that Raghavan & Roth (1993) count.

namespace elimination {

inline constexpr Index kFourNodes = 16;
inline constexpr double kVanishing = 1e-15;  // value of a polynomial, lengths in the arm's, that is round-off
inline constexpr double kBlurredQuartic = 1e-10;  // another, below which rounding moves roots too far to tell how many
inline constexpr double kLarge = 100.0;  // another, in which roots are lost
inline constexpr double kFoldedQuartic = 1e-5;  // divisor at a root below which other solutions may have the same angle

// The other three angles for a hidden one.
inline Triple beside_hidden(const RevoluteLoop& loop, double c, double s) noexcept {
  const Matrix3<double> A = turned(widened<double>(loop.K[3]), c, s, loop.K[0]);
  Mat<3, 3> M;
  for (Index i = 0; i < 3; ++i)
    for (Index j = 0; j < 3; ++j) M(i, j) = A[j][i];
  return triple(loop.K[1], loop.K[2], M);
}

template <class S>
inline Angles<S> all_angles(const Triple& at, double c, double s, const S& y) noexcept {
  Angles<S> out;
  out.c[0] = c;
  out.s[0] = s;
  complete(at, y, 1, out);
  return out;
}

template <class S>
inline S triple_product(const RevoluteLoop& loop, const Angles<S>& t) noexcept {
  const Gap<S> gap = gap_of(loop, t);
  const Vector3<S>&u = gap.u[0], &v = gap.u[1], &p = gap.p;
  return (u[1] * v[2] - u[2] * v[1]) * p[0] + (u[2] * v[0] - u[0] * v[2]) * p[1] + (u[0] * v[1] - u[1] * v[0]) * p[2];
}

// g+ g- h, and h
inline std::array<double, 2> quartic_value(const RevoluteLoop& loop, double angle) noexcept {
  const double c = std::cos(angle), s = std::sin(angle);
  const Triple at = beside_hidden(loop, c, s);
  const double square = 1.0 - at.x * at.x;
  if (square < 0.0)  // the two are conjugate
    return {std::norm(triple_product(loop, all_angles(at, c, s, Complex(0.0, std::sqrt(-square))))) * at.h, at.h};
  const double y = std::sqrt(square);
  return {triple_product(loop, all_angles(at, c, s, y)) * triple_product(loop, all_angles(at, c, s, -y)) * at.h, at.h};
}

struct QuarticSamples {
  double offset;
  std::array<double, kFourNodes> value;
};

// At nodes of which none has a small divisor.
inline QuarticSamples sample_quartic(const RevoluteLoop& loop) noexcept {
  QuarticSamples out{};
  double best = -1.0;
  for (const double offset : {0.1, 0.19, 0.28, 0.37}) {
    QuarticSamples here{offset, {}};
    double least = 2.0;
    for (Index n = 0; n < kFourNodes; ++n) {
      const std::array<double, 2> at = quartic_value(loop, offset + 2.0 * kPi / kFourNodes * static_cast<double>(n));
      here.value[n] = at[0];
      least = std::min(least, at[1]);
    }
    if (least > best) out = here;
    best = std::max(best, least);
    if (best > 1e-3) break;
  }
  return out;
}

// Of cos(k a) (1 + t^2)^4 and sin(k a) (1 + t^2)^4 the coefficients by powers of t = tan(a / 2).
struct HalfAnglePowers {
  std::array<std::array<double, 9>, 5> c{}, s{};
};

constexpr HalfAnglePowers half_angle_powers() noexcept {
  HalfAnglePowers out;
  for (Index k = 0; k < 5; ++k) {
    std::array<double, 9> re{}, im{};
    re[0] = 1.0;
    for (Index n = 0; n < 8; ++n) {  // times 1 + i t, then 1 + i t and 1 - i t in turn
      const double sign = n < 2 * k || n % 2 == 0 ? 1.0 : -1.0;
      for (Index j = 8; j > 0; --j) {
        const double x = re[j - 1];
        re[j] -= sign * im[j - 1];
        im[j] += sign * x;
      }
    }
    out.c[k] = re;
    out.s[k] = im;
  }
  return out;
}
inline constexpr HalfAnglePowers kHalfAnglePowers = half_angle_powers();

// The roots, about the angle opposite to the node where the polynomial is largest: this is its leading coefficient.
inline Spectrum quartic_roots(const QuarticSamples& at) noexcept {
  Index node = 0;
  for (Index n = 1; n < kFourNodes; ++n)
    if (std::abs(at.value[n]) > std::abs(at.value[node])) node = n;
  const double largest = std::abs(at.value[node]);
  node = (node + kFourNodes / 2) % kFourNodes;
  std::array<double, 9> powers{};
  for (Index k = 0; k < 5; ++k) {
    double a = 0.0, b = 0.0;
    for (Index n = 0; n < kFourNodes; ++n) {
      const double angle = 2.0 * kPi / kFourNodes * static_cast<double>(k * (n + kFourNodes - node) % kFourNodes);
      a += std::cos(angle) * at.value[n];
      b += std::sin(angle) * at.value[n];
    }
    const double weight = (k == 0 ? 1.0 : 2.0) / kFourNodes;
    for (Index j = 0; j < 9; ++j)
      powers[j] += weight * (a * kHalfAnglePowers.c[k][j] + b * kHalfAnglePowers.s[k][j]);
  }
  Spectrum out;
  Mat<8, 8> companion{};
  for (Index i = 0; i < 8; ++i) {
    if (i > 0) companion(i, i - 1) = 1.0;
    companion(i, 7) = -powers[i] / powers[8];
  }
  std::array<Complex, 8> t;
  out.real = -1;
  if (largest < kVanishing)  // every angle is a root
    for (Index i = 0; i < 8; ++i) t[i] = std::tan(kPi / 8 * static_cast<double>(i));
  else if (!eigenvalues(companion, t))
    return out;
  out.real = 0;
  add_angles(t, at.offset + 2.0 * kPi / kFourNodes * static_cast<double>(node), 0.03, out);
  if (largest < kBlurredQuartic || largest > kLarge) out.real = -1;
  return out;
}

inline Spectrum run_two_slides(const Chain& F, const Frame& T, const Frame& aim, const Turning& turning,
                               const std::array<int, 3>& plan, Solutions& out) noexcept {
  const Loop order = make_loop(F, aim, static_cast<Index>(plan[0]), false);
  const RevoluteLoop loop = revolute_loop(order, turning);
  Spectrum roots = quartic_roots(sample_quartic(loop));
  for (int i = 0; i < roots.count; ++i) {
    const double angle = roots.theta[static_cast<Index>(i)], c = std::cos(angle), s = std::sin(angle);
    const Triple at = beside_hidden(loop, c, s);
    if (std::abs(at.h) < kFoldedQuartic) roots.simple = false;
    const double y = std::sqrt(std::max(1.0 - at.x * at.x, 0.0));
    const std::array<Angles<double>, 2> both = {all_angles(at, c, s, y), all_angles(at, c, s, -y)};
    const double g[2] = {std::abs(triple_product(loop, both[0])), std::abs(triple_product(loop, both[1]))};
    for (Index n = 0; n < 2; ++n)  // the one of which it is a root, or both
      if (g[n] <= 1e3 * g[1 - n] + 1e-6) add_refined(F, T, turning, closed<2>(loop, order, both[n]), roots, out);
  }
  return roots;
}

}  // namespace elimination

using TwoSlidesMethod = elimination::InRuns<elimination::run_two_slides>;

// Arm: as for SixJointArm, its Plan with kEigenproblems, of which the first of each is the joint that is hidden.
template <class Arm> struct TwoSlides : SixJointArm<Arm, TwoSlidesMethod> {};

}  // namespace ikgen_runtime
