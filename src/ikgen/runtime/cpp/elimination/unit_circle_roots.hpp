#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "elimination/general_6r_equations.hpp"

namespace ikgen_runtime {

// --- roots of a trigonometric polynomial of any degree ---------------------------------------------------
// All roots z of sum c_k z^k at once, by the iteration of Ehrlich (1967) and Aberth (1973).

namespace elimination {

// Without the library's care for infinities: where there is one, the result is none either.
inline Complex product(Complex a, Complex b) noexcept {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}
inline Complex reciprocal(Complex z) noexcept { return std::conj(z) / std::norm(z); }

// p(z) / p'(z), by powers of 1 / z outside the unit circle so that nothing overflows; 0 where p(z) is round-off of its
// terms (Adams 1967), as it is all around roots that lie together. size: of the coefficients.
template <Index N>
inline Complex newton_ratio(const std::array<Complex, N>& c, const std::array<double, N>& size, Complex z) noexcept {
  constexpr double round_off = 1e-15;
  const bool outside = std::norm(z) > 1.0;
  const Complex w = outside ? reciprocal(z) : z;
  const double radius = std::sqrt(std::norm(w));
  Complex value = outside ? c[0] : c[N - 1], slope = 0.0;
  double terms = outside ? size[0] : size[N - 1];
  for (Index k = 1; k < N; ++k) {
    const Index at = outside ? k : N - 1 - k;
    slope = product(slope, w) + value;
    value = product(value, w) + c[at];
    terms = terms * radius + size[at];
  }
  if (std::norm(value) < round_off * round_off * terms * terms) return 0.0;
  if (!outside) return product(value, reciprocal(slope));
  const Complex rest = static_cast<double>(N - 1) * value - product(w, slope);
  return product(value, reciprocal(product(w, rest)));
}

template <Index N>
inline std::array<Complex, N - 1> polynomial_roots(const std::array<Complex, N>& c) noexcept {
  std::array<Complex, N - 1> z;
  for (Index i = 0; i + 1 < N; ++i) {  // radii on both sides, lest roots on the circle be met in pairs
    const double angle = 2.0 * kPi * static_cast<double>(i) / static_cast<double>(N - 1) + 0.4;
    z[i] = std::polar(i % 3 == 0 ? 1.1 : i % 3 == 1 ? 0.95 : 0.8, angle);
  }
  std::array<double, N> size;
  for (Index k = 0; k < N; ++k) size[k] = std::sqrt(std::norm(c[k]));
  std::array<bool, N - 1> still{};
  for (int round = 0; round < 60; ++round) {
    bool all = true;
    for (Index i = 0; i + 1 < N; ++i) {
      if (still[i]) continue;
      const Complex ratio = newton_ratio(c, size, z[i]);
      if (!(std::norm(ratio) < 1e300)) continue;
      Complex sum = 0.0;
      for (Index j = 0; j + 1 < N; ++j)
        if (j != i && z[j] != z[i]) sum += reciprocal(z[i] - z[j]);
      const Complex step = product(ratio, reciprocal(1.0 - product(ratio, sum)));
      if (!(std::norm(step) < 1e300)) continue;
      z[i] -= step;
      still[i] = std::norm(step) < 1e-30 * std::norm(z[i]);
      all = all && still[i];
    }
    if (all) break;
  }
  return z;
}

// How often a function is looked at closely, and where rounding may move the roots of the whole circle's polynomial, or may
// have made real ones complex (rad).
constexpr Index kLooks = 8;
struct Unsure {
  Index count = 0;
  std::array<double, 2 * kLooks> angle;

  void add(double x) noexcept {
    if (count < angle.size()) angle[count++] = x;
  }
};

// The angles of roots near the unit circle, of a polynomial of degree D with these values at n equidistant nodes from
// `first` on; how many.
template <Index D, Index n, std::size_t most>
inline int circle_roots(const std::array<double, n>& values, double first, double accept,
                        std::array<double, most>& angles, Unsure& unsure) noexcept {
  constexpr double noise = 1e-13;  // of the coefficients, of the largest
  constexpr double off = 0.3;      // rad: imaginary part from which on a root cannot be real
  constexpr double sure = 1e-6, share = 0.25;  // rad, and of its imaginary part, by which rounding may move a root
  std::array<Complex, n> turn;
  for (Index i = 0; i < n; ++i) {
    const double angle = 2.0 * kPi * static_cast<double>(i) / static_cast<double>(n);
    turn[i] = {std::cos(angle), -std::sin(angle)};
  }
  std::array<Complex, 2 * D + 1> c{};
  double largest = 0.0;
  for (Index k = 0; k <= D; ++k) {
    for (Index i = 0; i < n; ++i) c[D + k] += values[i] * turn[k * i % n];
    c[D - k] = std::conj(c[D + k]);
    largest = std::max(largest, std::sqrt(std::norm(c[D + k])));
  }
  int count = 0;
  const auto roots = polynomial_roots(c);
  for (const Complex& z : roots) {
    const double away = std::abs(0.5 * std::log(std::norm(z) + 1e-300)), angle = first + std::arg(z);
    if (away < accept) angles[static_cast<Index>(count++)] = angle;
    if (!(away < off)) continue;
    const double size = std::sqrt(std::norm(z));
    double powers = 0.0, slope = size * std::sqrt(std::norm(c[2 * D]));
    for (Index k = 0; k < c.size(); ++k) powers = powers * size + 1.0;
    for (const Complex& other : roots)
      if (&other != &z) slope *= std::sqrt(std::norm(z - other));
    if (!(noise * largest * powers < slope * std::max(sure, share * away))) unsure.add(angle);
  }
  return count;
}

// Near a crowded angle: how far (rad), and the degree of polynomials of sines and cosines there.
constexpr double kNear = 0.2;
constexpr Index kClose = 20;

// Puts the roots of a function of an angle that lie near `place` in place of those among the first `count` angles; how
// many there are then. From its values at Chebyshev's nodes.
template <class Function, std::size_t most>
inline int look_closely(const Function& of, double place, double accept, std::array<double, most>& angles,
                        int count) noexcept {
  int kept = 0;
  for (int i = 0; i < count; ++i) {
    const double x = angles[static_cast<Index>(i)];
    if (std::abs(std::remainder(x - place, 2.0 * kPi)) > 0.9 * kNear) angles[static_cast<Index>(kept++)] = x;
  }
  constexpr Index n = kClose + 1;
  std::array<double, n> waves{}, last{}, next{}, now{};
  for (Index i = 0; i < n; ++i) {
    const double angle = kPi / static_cast<double>(n) * (static_cast<double>(i) + 0.5);
    const double value = of(place + kNear * std::cos(angle)) / static_cast<double>(n);
    for (Index k = 0; k < n; ++k) waves[k] += (k == 0 ? 1.0 : 2.0) * value * std::cos(static_cast<double>(k) * angle);
  }
  std::array<Complex, n> c{};
  now[0] = 1.0;  // Chebyshev's polynomials by powers, one after the other
  for (Index k = 0; k < n; ++k) {
    for (Index j = 0; j <= k; ++j) c[j] += waves[k] * now[j];
    for (Index j = 0; j < n; ++j) next[j] = (k == 0 ? 1.0 : 2.0) * (j == 0 ? 0.0 : now[j - 1]) - last[j];
    last = now, now = next;
  }
  for (const Complex& x : polynomial_roots(c))
    if (std::abs(x.imag()) < accept / kNear && std::abs(x.real()) <= 1.0)
      angles[static_cast<Index>(kept++)] = place + kNear * x.real();
  return kept;
}

// Roots so close together (rad) that rounding of the whole circle's polynomial may move them far.
constexpr double kBeside = 0.1;

// Looks closely where roots are unsure, and where two or more of the first `count` angles lie together; how many there are
// then.
template <class Function, std::size_t most>
inline int look_where_close(const Function& of, double accept, const Unsure& unsure, std::array<double, most>& angles,
                            int count) noexcept {
  const std::array<double, most> roots = angles;
  std::array<double, kLooks> looked{};
  Index looks = 0;
  const auto apart = [](double a, double b) { return std::abs(std::remainder(a - b, 2.0 * kPi)); };
  const auto look = [&](double place) {
    bool known = looks == kLooks;
    for (Index k = 0; k < looks; ++k) known = known || apart(looked[k], place) <= 0.9 * kNear;
    if (known) return;
    count = look_closely(of, place, accept, angles, count);
    looked[looks++] = place;
  };
  const int given = count;
  for (Index i = 0; i < unsure.count; ++i) look(unsure.angle[i]);
  for (int i = 0; i < given; ++i)
    for (int j = 0; j < given; ++j)
      if (j != i && apart(roots[static_cast<Index>(j)], roots[static_cast<Index>(i)]) < kBeside)
        look(roots[static_cast<Index>(i)]);
  return count;
}

}  // namespace elimination
}  // namespace ikgen_runtime
