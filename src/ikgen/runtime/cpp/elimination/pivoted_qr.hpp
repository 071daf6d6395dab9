#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "elimination/general_6r_frames.hpp"

namespace ikgen_runtime {

// --- reflections of a small matrix (Householder 1958), columns in order of what is left of them ------------

namespace elimination {

template <Index R, Index C>
struct PivotedQr {
  Mat<R, C> a;                                 // the triangle, columns in the order of `column`
  std::array<std::array<double, R>, C> mirror{};  // unit vectors of the reflections
  std::array<Index, C> column;
  Index rank = 0;

  PivotedQr() noexcept = default;
  explicit PivotedQr(const Mat<R, C>& given) noexcept : a(given) {
    for (Index k = 0; k < C; ++k) column[k] = k;
    double first = 0.0;
    for (Index k = 0; k < C && k < R; ++k) {
      const double size = pivot(k);
      if (k == 0) first = size;
      if (!(size > 1e-10 * first)) return;
      rank = k + 1;
      reflect_columns(k);
    }
  }

  // x to Q^T x, or back to Q x
  void turn(std::array<double, R>& x) const noexcept {
    for (Index k = 0; k < rank; ++k) reflect(mirror[k], x);
  }
  void turn_back(std::array<double, R>& x) const noexcept {
    for (Index k = rank; k-- > 0;) reflect(mirror[k], x);
  }

  // Least squares of several columns; zero where the rank leaves a choice.
  template <Index N> Mat<C, N> solve_all(Mat<R, N> b) const noexcept {
    for (Index k = 0; k < rank; ++k) reflect_rows(mirror[k], 0, b);
    Mat<C, N> x{};
    for (Index k = rank; k-- > 0;) {
      double* row = &x(column[k], 0);
      for (Index n = 0; n < N; ++n) row[n] = b(k, n);
      for (Index j = k + 1; j < rank; ++j)
        for (Index n = 0; n < N; ++n) row[n] -= a(k, j) * x(column[j], n);
      for (Index n = 0; n < N; ++n) row[n] /= a(k, k);
    }
    return x;
  }

  // Least squares; zero where the rank leaves a choice.
  std::array<double, C> solve(std::array<double, R> b) const noexcept {
    turn(b);
    std::array<double, C> x{}, y{};
    for (Index k = rank; k-- > 0;) {
      double sum = b[k];
      for (Index j = k + 1; j < rank; ++j) sum -= a(k, j) * y[j];
      y[k] = sum / a(k, k);
      x[column[k]] = y[k];
    }
    return x;
  }

 private:
  static void reflect(const std::array<double, R>& h, std::array<double, R>& x) noexcept {
    double dot = 0.0;
    for (Index i = 0; i < R; ++i) dot += h[i] * x[i];
    for (Index i = 0; i < R; ++i) x[i] -= 2.0 * dot * h[i];
  }

  // The columns from `from` on.
  template <Index N> static void reflect_rows(const std::array<double, R>& h, Index from, Mat<R, N>& b) noexcept {
    std::array<double, N> dot{};
    for (Index i = 0; i < R; ++i)
      for (Index j = from; j < N; ++j) dot[j] += h[i] * b(i, j);
    for (Index i = 0; i < R; ++i)
      for (Index j = from; j < N; ++j) b(i, j) -= 2.0 * dot[j] * h[i];
  }

  // Brings the largest column left over to place k; its size.
  double pivot(Index k) noexcept {
    std::array<double, C> square{};
    for (Index i = k; i < R; ++i)
      for (Index j = k; j < C; ++j) square[j] += a(i, j) * a(i, j);
    const auto best = static_cast<Index>(std::max_element(square.begin() + k, square.end()) - square.begin());
    for (Index i = 0; i < R; ++i) std::swap(a(i, k), a(i, best));
    std::swap(column[k], column[best]);
    return std::sqrt(square[best]);
  }

  void reflect_columns(Index k) noexcept {
    std::array<double, R>& h = mirror[k];
    double square = 0.0;
    for (Index i = k; i < R; ++i) {
      h[i] = a(i, k);
      square += h[i] * h[i];
    }
    const double norm = std::sqrt(square), size = std::sqrt(2.0 * (square + std::abs(h[k]) * norm));
    h[k] += std::copysign(norm, h[k]);
    for (double& e : h) e = size > 0.0 ? e / size : 0.0;
    reflect_rows(h, k, a);
  }
};

}  // namespace elimination
}  // namespace ikgen_runtime
