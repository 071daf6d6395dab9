#pragma once

#include "elimination/general_6r_branches.hpp"

namespace ikgen_runtime {

// --- general_6r: Newton's method on the chain, in lanes ---------------------------------------------

namespace elimination {

// What a chain's end X is off the pose, as the last entry of each row; the largest error of an entry.
inline Wide set_errors(const Frame& T, const WideFrame& X, Wide (&rows)[6][7]) noexcept {
  Wide S[3][3], worst = spread<kWide>(0.0);
  for (Index i = 0; i < 3; ++i) {
    for (Index j = 0; j < 3; ++j) {
      S[i][j] = T.R[i][0] * X.R[j][0] + T.R[i][1] * X.R[j][1] + T.R[i][2] * X.R[j][2];
      worst = max(worst, abs(T.R[i][j] - X.R[i][j]));
    }
    rows[i][6] = T.p[i] - X.p[i];
    worst = max(worst, abs(rows[i][6]));
  }
  for (Index a = 0; a < 3; ++a) {
    const Index m = (a + 1) % 3, n = (a + 2) % 3;
    rows[3 + a][6] = 0.5 * (S[n][m] - S[m][n]);
  }
  return worst;
}

// Error at the configuration and the slope by its angles, in rows (slope, error); the largest error of an entry.
inline Wide linearize(const Chain& F, const Frame& T, const Six& q, Wide (&rows)[6][7]) noexcept {
  WideFrame X = widen(F[0]);
  Wide origin[6][3];
  for (Index i = 0; i < 6; ++i) {
    for (Index r = 0; r < 3; ++r) {
      rows[3 + r][i] = X.R[r][2];
      origin[i][r] = X.p[r];
    }
    X = pass(X, {q.c[i], q.s[i]}, F[i + 1]);
  }
  const Wide worst = set_errors(T, X, rows);
  for (Index a = 0; a < 3; ++a) {
    const Index m = (a + 1) % 3, n = (a + 2) % 3;
    for (Index i = 0; i < 6; ++i)
      rows[a][i] = rows[3 + m][i] * (X.p[n] - origin[i][n]) - rows[3 + n][i] * (X.p[m] - origin[i][m]);
  }
  return worst;
}

template <int K>
inline void eliminate_columns(Wide (&columns)[7][6]) noexcept {  // columns K.. of six, and the right side
  if constexpr (K < 6) {
    const WideReflected h = reflector<K>(columns[K]);
    for (int i = K + 1; i < 7; ++i) reflect<K>(columns[K], h.beta, columns[i]);
    columns[K][K] = h.alpha;
    eliminate_columns<K + 1>(columns);
  }
}

// The step that takes the error to zero, at most 0.1 rad in a joint.
inline void newton_step(const Wide (&rows)[6][7], Wide (&x)[6]) noexcept {
  Wide columns[7][6];
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 7; ++j) columns[j][i] = rows[i][j];
  eliminate_columns<0>(columns);
  Wide large = spread<kWide>(1e-300);
  for (int i = 5; i >= 0; --i) {
    x[i] = columns[6][i];
    for (int j = i + 1; j < 6; ++j) x[i] = x[i] - columns[j][i] * x[j];
    x[i] = x[i] / columns[i][i];
    large = max(large, abs(x[i]));
  }
  const Wide scale = select(large > 0.1, 0.1 / large, spread<kWide>(1.0));
  for (Wide& e : x) e = e * scale;
}

struct Errors {
  Wide before, after;
};

inline constexpr double kExact = 1e-13;  // in an entry of the pose, lengths over the arm's

// Newton steps for the lanes that are `live`, at most five.
template <class Frames>
inline Errors newton(const Frames& F, const Frame& T, const WideMask& live, Six& q) noexcept {
  Errors out;
  for (int step = 0;; ++step) {
    Wide rows[6][7], x[6];
    out.after = linearize(F, T, q, rows);
    if (step == 0) out.before = out.after;
    if (step == 5 || !any((out.after > kExact) & (1.0 > out.after) & live)) return out;
    newton_step(rows, x);
    for (int i = 0; i < 6; ++i) {
      const Pair turned = times({q.c[i], q.s[i]}, small_pair(x[i]));
      const Wide n = 1.5 - 0.5 * (turned.c * turned.c + turned.s * turned.s);
      q.c[i] = turned.c * n;
      q.s[i] = turned.s * n;
    }
  }
}

}  // namespace elimination
}  // namespace ikgen_runtime
