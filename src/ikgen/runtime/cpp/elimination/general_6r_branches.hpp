#pragma once

#include "elimination/general_6r_roots.hpp"

namespace ikgen_runtime {

// --- general_6r: from theta_3 to all six angles, in lanes -------------------------------------------

namespace elimination {

struct Six {  // cosines and sines of the six joints, base to tip
  Wide c[6], s[6];
};

using WideFrame = FrameOf<Wide>;

inline WideFrame widen(const Frame& a) noexcept {
  WideFrame out;
  for (Index i = 0; i < 3; ++i) {
    for (Index j = 0; j < 3; ++j) out.R[i][j] = spread<kWide>(a.R[i][j]);
    out.p[i] = spread<kWide>(a.p[i]);
  }
  return out;
}

inline Pair unit(const Wide& c, const Wide& s) noexcept {
  const Wide over = 1.0 / sqrt(c * c + s * s + 1e-300);
  return {c * over, s * over};
}

// Null vector x of the matrix of half angles, of any length: inverse iteration with A^T A = L L^T, A^T = L Q. One
// pass is as good as the ratio of the two smallest singular values squared.
inline void null_vector(const Wide (&A)[6][6], Wide (&x)[6]) noexcept {
  Wide transposed[1][6][6], over[6];
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) transposed[0][i][j] = A[j][i];
  WideReflected h[1][6];
  triangulate<0, 1>(1, transposed, h);
  const auto& rows = transposed[0];
  for (int i = 0; i < 6; ++i) {
    over[i] = i < 5 ? h[0][i].alpha : rows[5][5];
    const Wide size = max(abs(over[i]), 1e-20);
    over[i] = 1.0 / select(over[i] > 0.0, size, -size);
    x[i] = spread<kWide>(i % 2 == 0 ? 1.0 + 0.37 * i : 1.0 - 0.37 * i);
  }
  for (int i = 0; i < 6; ++i) {
    x[i] = x[i] * over[i];
    for (int j = i + 1; j < 6; ++j) x[j] = x[j] - rows[j][i] * x[i];
  }
  for (int i = 5; i >= 0; --i) {
    x[i] = x[i] * over[i];
    for (int j = 0; j < i; ++j) x[j] = x[j] - rows[i][j] * x[i];
  }
}

// theta_4 and theta_5 from the null vector.
template <class Source>
inline void inner_angles(const Source& source, const Pair& three, Pair& four, Pair& five) noexcept {
  Wide A[1][6][9], bases[1][3][9], K[6][6], x[6];
  WideReflected unused[1][6];
  fill(source, three.c, three.s, A[0]);
  null_bases(1, A, bases, unused);
  const auto& basis = bases[0];
  half_angles(basis, K);
  null_vector(K, x);
  const Wide first = x[0] * x[0] + x[1] * x[1] + x[2] * x[2], second = x[3] * x[3] + x[4] * x[4] + x[5] * x[5];
  const auto upper = first > second;
  Wide y[3], w[9];
  for (int i = 0; i < 3; ++i) y[i] = select(upper, x[i], x[3 + i]);
  for (int i = 0; i < 9; ++i) w[i] = basis[0][i] * y[0] + basis[1][i] * y[1] + basis[2][i] * y[2];
  four = unit(w[3] * w[0] + w[4] * w[1] + w[5] * w[2], w[6] * w[0] + w[7] * w[1] + w[8] * w[2]);
  Wide z[3];
  for (int i = 0; i < 3; ++i) z[i] = w[i] + four.c * w[3 + i] + four.s * w[6 + i];
  const Wide sign = select(z[0] > 0.0, spread<kWide>(1.0), spread<kWide>(-1.0));
  five = unit(sign * z[1], sign * z[2]);
}

// theta_1, linearly, and theta_2 from the invariants of R2^-1 ... , as in `complete`.
inline void outer_angles(const Equations& eq, const WideFrame& U, Pair& one, Pair& two) noexcept {
  const Wide l[3] = {U.R[0][2], U.R[1][2], U.R[2][2]};
  const auto& p = U.p;
  const Wide pp = p[0] * p[0] + p[1] * p[1] + p[2] * p[2], pl = p[0] * l[0] + p[1] * l[1] + p[2] * l[2];
  Wide v[3][4];
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    v[i][0] = l[i];
    v[i][1] = p[i];
    v[i][2] = p[j] * l[k] - p[k] * l[j];
    v[i][3] = pp * l[i] - 2.0 * pl * p[i];
  }
  Wide h[6] = {v[2][0], v[2][1], v[2][2], v[2][3], pp, pl};
  for (Index i = 0; i < 6; ++i) h[i] = h[i] - eq.right(8 + i, 0);
  reflect_turns(eq, h);
  const Wide y = h[1] * (1.0 / eq.r11);
  one = unit((h[0] - eq.r01 * y) * (1.0 / eq.r00), y);
  Wide c = spread<kWide>(0.0), s = c;
  for (Index i = 0; i < 4; ++i) {
    const Wide x1 = eq.right(i, 0) + eq.right(i, 1) * one.c + eq.right(i, 2) * one.s;
    const Wide y1 = eq.right(4 + i, 0) + eq.right(4 + i, 1) * one.c + eq.right(4 + i, 2) * one.s;
    c = c + x1 * v[0][i] + y1 * v[1][i];
    s = s + y1 * v[0][i] - x1 * v[1][i];
  }
  two = unit(c, s);
}

// R_4 C_4 ... and the like: the frame before it, turned, then the constant.
inline WideFrame pass(WideFrame a, const Pair& angle, const Frame& constant) noexcept {
  rotate(a, angle.c, angle.s);
  return compose(a, constant);
}

// All six angles from the inner three and the loop's frame U behind them, C2 R3 C3 R4 C4 R5 C5.
inline Six close_loop(const Loop& loop, const Equations& eq, const WideFrame& U, Pair (&z)[6]) noexcept {
  outer_angles(eq, U, z[0], z[1]);
  WideFrame Y = pass(widen(loop.C[5]), z[0], loop.C[0]);
  rotate(Y, z[1].c, z[1].s);
  Wide x[2][2];  // of Y U, whose inverse is R6
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j) x[i][j] = Y.R[i][0] * U.R[0][j] + Y.R[i][1] * U.R[1][j] + Y.R[i][2] * U.R[2][j];
  z[5] = unit(x[0][0] + x[1][1], x[0][1] - x[1][0]);
  Six out;
  for (Index i = 0; i < 6; ++i) {
    out.c[loop.order[i]] = z[i].c;
    out.s[loop.order[i]] = loop.reverse ? -z[i].s : z[i].s;
  }
  return out;
}

// All six angles of a solution from the first that is known.
inline Six complete(const Loop& loop, const Equations& eq, const Pencil& pencil, const Pair& three) noexcept {
  Pair z[6];
  z[2] = three;
  inner_angles(pencil, three, z[3], z[4]);
  WideFrame U = pass(widen(loop.C[1]), z[2], loop.C[2]);
  U = pass(pass(U, z[3], loop.C[3]), z[4], loop.C[4]);
  return close_loop(loop, eq, U, z);
}

}  // namespace elimination
}  // namespace ikgen_runtime
