// Lyapunov and Schmidt's reduction (Golubitsky & Schaeffer 1985, I.3): directions that hardly move what is off, the still ones,
// and all others, which take its error away but for as many directions.
#pragma once

#include <algorithm>
#include <cmath>

#include "arrays/lanes.hpp"
#include "arrays/small_matrix.hpp"

namespace ikgen_runtime {

// The slope of an error, split: V by the directions across K still ones, which are units at right angles, and the factors A
// of its normal equations, in which these are stiff; flow: by the still ones.
template <int Rows, int Columns, int K> struct StillSplit {
  double V[Rows][Columns], A[Columns][Columns], flow[K][Rows];

  StillSplit(const double (&slope)[Rows][Columns], const double (*still)[Columns], double shift) noexcept {
    for (int e = 0; e < Rows; ++e) {
      for (int i = 0; i < K; ++i) {
        flow[i][e] = 0.0;
        for (int k = 0; k < Columns; ++k) flow[i][e] += slope[e][k] * still[i][k];
      }
      for (int k = 0; k < Columns; ++k) {
        V[e][k] = slope[e][k];
        for (int i = 0; i < K; ++i) V[e][k] -= flow[i][e] * still[i][k];
      }
    }
    gram_of_columns(V, A);
    for (int a = 0; a < Columns; ++a)
      for (int b = 0; b <= a; ++b)
        for (int i = 0; i < K; ++i) A[a][b] += still[i][a] * still[i][b];
    shift_diagonal(shift, A);
    factor(A);
  }
};

// What directions across some leave of three errors, a column each, and how they go.
template <int Rows, int Columns> struct LeftAcross {
  double rest[Rows][4], going[Columns][4];

  template <int K>
  LeftAcross(const StillSplit<Rows, Columns, K>& others, const double* a, const double* b, const double* c) noexcept {
    Lanes<4> z[Rows], y[Columns];
    for (int e = 0; e < Rows; ++e) {
      const double columns[4] = {a[e], b[e], c[e], 0.0};
      z[e] = load<4>(columns);
    }
    transposed_times(others.V, z, y);
    substitute(others.A, y);
    for (int k = 0; k < Columns; ++k) store(y[k], going[k]);
    for (int e = 0; e < Rows; ++e) {
      for (int k = 0; k < Columns; ++k) z[e] = z[e] - others.V[e][k] * y[k];
      store(z[e], rest[e]);
    }
  }

  // How they go for the first, and how far the fastest joint does.
  double first(double (&across)[Columns]) const noexcept {
    double farthest = 0.0;
    for (int k = 0; k < Columns; ++k) {
      across[k] = going[k][0];
      farthest = std::max(farthest, std::abs(across[k]));
    }
    return farthest;
  }
};

}  // namespace ikgen_runtime
