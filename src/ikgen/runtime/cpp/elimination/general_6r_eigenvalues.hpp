#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "elimination/general_6r_equations.hpp"

namespace ikgen_runtime {

// --- general_6r: eigenvalues of a real matrix ------------------------------------------------------
// Hessenberg form by elimination, then Francis' double shifts (the algorithms elmhes and hqr of Wilkinson &
// Reinsch 1971).

namespace elimination {

template <Index N>
inline void hessenberg(Mat<N, N>& a) noexcept {
  for (Index m = 1; m + 1 < N; ++m) {
    Index best = m;
    for (Index i = m + 1; i < N; ++i)
      if (std::abs(a(i, m - 1)) > std::abs(a(best, m - 1))) best = i;
    if (best != m) {
      for (Index j = m - 1; j < N; ++j) std::swap(a(best, j), a(m, j));
      for (Index i = 0; i < N; ++i) std::swap(a(i, best), a(i, m));
    }
    const double x = a(m, m - 1);
    if (x == 0.0) continue;
    for (Index i = m + 1; i < N; ++i) {
      const double y = a(i, m - 1) / x;
      if (y == 0.0) continue;
      for (Index j = m; j < N; ++j) a(i, j) -= y * a(m, j);
      for (Index k = 0; k < N; ++k) a(k, m) += y * a(k, i);
    }
  }
}

// The first column of a double-shift sweep, scaled: where the sweep may begin, and with what.
struct Bulge {
  Index row;
  double p, q, r;
};

template <Index N>
inline Bulge begin_sweep(const Mat<N, N>& a, Index l, Index n, double x, double y, double w) noexcept {
  Index m = n - 2;
  for (;; --m) {
    const double z = a(m, m), rr = x - z, ss = y - z;
    double p = (rr * ss - w) / a(m + 1, m) + a(m, m + 1), q = a(m + 1, m + 1) - z - rr - ss, r = a(m + 2, m + 1);
    const double s = std::abs(p) + std::abs(q) + std::abs(r) + 1e-300;
    p /= s;
    q /= s;
    r /= s;
    if (m == l) return {m, p, q, r};
    const double u = std::abs(a(m, m - 1)) * (std::abs(q) + std::abs(r));
    const double v = std::abs(p) * (std::abs(a(m - 1, m - 1)) + std::abs(z) + std::abs(a(m + 1, m + 1)));
    if (u <= 1e-16 * v) return {m, p, q, r};
  }
}

// The reflection of the sweep at row k, on both sides.
template <Index N>
inline void chase(Mat<N, N>& a, Index l, Index n, const Bulge& at, double s) noexcept {
  const Index k = at.row;
  const bool last = k == n - 1;
  const double p = at.p + s, x = p / s, y = at.q / s, z = at.r / s, q = at.q / p, r = at.r / p;
  for (Index j = k; j <= n; ++j) {
    const double t = a(k, j) + q * a(k + 1, j) + (last ? 0.0 : r * a(k + 2, j));
    a(k, j) -= t * x;
    a(k + 1, j) -= t * y;
    if (!last) a(k + 2, j) -= t * z;
  }
  const Index end = std::min(n, k + 3);
  for (Index i = l; i <= end; ++i) {
    const double t = x * a(i, k) + y * a(i, k + 1) + (last ? 0.0 : z * a(i, k + 2));
    a(i, k) -= t;
    a(i, k + 1) -= t * q;
    if (!last) a(i, k + 2) -= t * r;
  }
}

// One double-shift sweep on rows and columns l..n of the Hessenberg matrix.
template <Index N>
inline void francis(Mat<N, N>& a, Index l, Index n, double x, double y, double w) noexcept {
  Bulge at = begin_sweep(a, l, n, x, y, w);
  const Index m = at.row;
  for (Index i = m + 2; i <= n; ++i) {
    a(i, i - 2) = 0.0;
    if (i > m + 2) a(i, i - 3) = 0.0;
  }
  for (Index k = m; k < n; ++k) {
    double scale = 1.0;
    at.row = k;
    if (k != m) {
      at.p = a(k, k - 1);
      at.q = a(k + 1, k - 1);
      at.r = k == n - 1 ? 0.0 : a(k + 2, k - 1);
      scale = std::abs(at.p) + std::abs(at.q) + std::abs(at.r);
      if (scale == 0.0) continue;
      at.p /= scale;
      at.q /= scale;
      at.r /= scale;
    }
    const double s = std::copysign(std::sqrt(at.p * at.p + at.q * at.q + at.r * at.r), at.p);
    if (s == 0.0) continue;
    if (k != m)
      a(k, k - 1) = -s * scale;
    else if (l != m)
      a(k, k - 1) = -a(k, k - 1);
    chase(a, l, n, at, s);
  }
}

// The last row n that is not yet split off begins a block at the row returned.
template <Index N>
inline Index block_start(Mat<N, N>& a, Index n, double norm) noexcept {
  for (Index l = n; l > 0; --l) {
    const double s = std::abs(a(l - 1, l - 1)) + std::abs(a(l, l));
    if (std::abs(a(l, l - 1)) > 2.3e-16 * s + 1e-17 * norm) continue;
    a(l, l - 1) = 0.0;
    return l;
  }
  return 0;
}

// Eigenvalues n - 1 and n of a 2x2 block with diagonal y, x and product w of the others.
inline void split_pair(double x, double y, double w, double shift, Complex* out) noexcept {
  const double p = 0.5 * (y - x), d = p * p + w, z = std::sqrt(std::abs(d));
  if (d >= 0.0) {
    const double big = p + std::copysign(z, p);
    out[0] = x + shift + big;
    out[1] = big != 0.0 ? x + shift - w / big : x + shift;
  } else {
    out[0] = Complex(x + shift + p, z);
    out[1] = Complex(x + shift + p, -z);
  }
}

// False where 60 sweeps do not separate one.
template <Index N>
inline bool eigenvalues(Mat<N, N>& a, std::array<Complex, N>& out) noexcept {
  hessenberg(a);
  double norm = 0.0, shift = 0.0;
  for (Index i = 0; i < N; ++i)
    for (Index j = i > 0 ? i - 1 : 0; j < N; ++j) norm += std::abs(a(i, j));
  Index size = N;
  for (int sweeps = 0; size > 0;) {
    const Index n = size - 1, l = block_start(a, n, norm);
    double x = a(n, n);
    if (l + 1 >= n) {
      if (l == n)
        out[n] = x + shift;
      else
        split_pair(x, a(n - 1, n - 1), a(n, n - 1) * a(n - 1, n), shift, &out[n - 1]);
      size = l;
      sweeps = 0;
      continue;
    }
    double y = a(n - 1, n - 1), w = a(n, n - 1) * a(n - 1, n);
    if (sweeps == 60 || !(std::abs(x) < 1e300)) return false;
    if (sweeps % 10 == 9) {  // exceptional shift
      shift += x;
      for (Index i = 0; i <= n; ++i) a(i, i) -= x;
      const double s = std::abs(a(n, n - 1)) + std::abs(a(n - 1, n - 2));
      x = y = 0.75 * s;
      w = -0.4375 * s * s;
    }
    ++sweeps;
    francis(a, l, n, x, y, w);
  }
  return true;
}

}  // namespace elimination
}  // namespace ikgen_runtime
