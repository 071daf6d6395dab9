#pragma once

#include "elimination/general_6r_null_space.hpp"
#include "elimination/parallel_links.hpp"
#include "arrays/small_matrix.hpp"

namespace ikgen_runtime {

// --- parallel_6r: a polynomial in theta_6 -------------------------------------------------------------
// With D = O_4 - O_1 the products w = z_1.z_4, u = z_1.D, v = z_4.D, r = D.D and e = z_1.(z_4 x D) are bilinear in the
// cosines and sines of theta_5 and theta_6. The parallel axes' distance is a constant, and so are the products of their
// direction n with z_1, z_4 and D: a line and a conic, or two lines, that (cos, sin) of theta_5 lies on.

namespace elimination {

struct ParallelProducts {
  Wide z[3], o[3];                      // z_1 and O_1
  Wide w[3], u[3], v[3], r[3], e[3];    // terms in (1, cos, sin) of theta_5
};

// out += scale * b.Rz(-theta_5) v
inline void add_form(double scale, const Wide (&b)[3], const double (&v)[3], Wide (&out)[3]) noexcept {
  const double x = scale * v[0], y = scale * v[1], z = scale * v[2];
  out[0] = out[0] + b[2] * z;
  out[1] = out[1] + (b[0] * x + b[1] * y);
  out[2] = out[2] + (b[0] * y - b[1] * x);
}

inline ParallelProducts products(const ParallelLoop& p, const Wide& c6, const Wide& s6) noexcept {
  ParallelProducts out;
  const Wide none = spread<kWide>(0.0);
  Wide zo = none, oo = none, moment[3];
  for (int i = 0; i < 3; ++i) {
    out.z[i] = p.z1[i][0] + p.z1[i][1] * c6 + p.z1[i][2] * s6;
    out.o[i] = p.o1[i][0] + p.o1[i][1] * c6 + p.o1[i][2] * s6;
    zo = zo + out.z[i] * out.o[i];
    oo = oo + out.o[i] * out.o[i];
    out.w[i] = out.u[i] = out.v[i] = out.r[i] = out.e[i] = none;
  }
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    moment[i] = out.o[j] * out.z[k] - out.o[k] * out.z[j];
  }
  out.u[0] = -zo;
  out.v[0] = spread<kWide>(p.z4o4);
  out.r[0] = p.o4o4 + oo;
  add_form(1.0, out.z, p.z4, out.w);
  add_form(1.0, out.z, p.o4, out.u);
  add_form(-1.0, out.o, p.z4, out.v);
  add_form(-2.0, out.o, p.o4, out.r);
  add_form(1.0, out.z, p.m4, out.e);
  add_form(-1.0, moment, p.z4, out.e);
  return out;
}

inline Wide dot(const Wide (&a)[3], const Wide (&b)[3]) noexcept { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// adds scale (a b' + b a') / 2 to a symmetric matrix: its entries 00, 01, 02, 11, 12, 22.
inline void add_product(const Wide& scale, const Wide (&a)[3], const Wide (&b)[3], Wide (&Q)[6]) noexcept {
  const Wide x = 0.5 * scale;
  Q[0] = Q[0] + scale * (a[0] * b[0]);
  Q[1] = Q[1] + x * (a[0] * b[1] + a[1] * b[0]);
  Q[2] = Q[2] + x * (a[0] * b[2] + a[2] * b[0]);
  Q[3] = Q[3] + scale * (a[1] * b[1]);
  Q[4] = Q[4] + x * (a[1] * b[2] + a[2] * b[1]);
  Q[5] = Q[5] + scale * (a[2] * b[2]);
}

// a (1, 0, 0)' likewise
inline void add_linear(double scale, const Wide (&a)[3], Wide (&Q)[6]) noexcept {
  Q[0] = Q[0] + scale * a[0];
  Q[1] = Q[1] + (0.5 * scale) * a[1];
  Q[2] = Q[2] + (0.5 * scale) * a[2];
}

// (1, cos, sin) of theta_5 lies on `line` and on the conic Q, or on a second line in its place. Rounding may move the
// coefficients of the former by line_error and those of the other by error (Frobenius' norm); the chain's links, where
// they are not quite of the kind, may move the lines' values at a solution by line_shift and shift, and the conic's by
// a part of error.
template <Parallel Kind> struct ParallelCurves {
  Wide line[3], second[3], Q[6], line_error, error, line_shift, shift;
};

inline constexpr double kParallelRounding = 8e-15;

// takes scale |a z_4 x D + b D x z_1|^2 off.
inline void take_normals(double scale, double a, double b, const ParallelProducts& x, Wide (&Q)[6]) noexcept {
  add_linear(-scale * (a * a + b * b), x.r, Q);
  add_product(spread<kWide>(scale * a * a), x.v, x.v, Q);
  add_product(spread<kWide>(scale * b * b), x.u, x.u, Q);
  add_product(spread<kWide>(-2.0 * scale * a * b), x.u, x.v, Q);
  add_product(spread<kWide>(2.0 * scale * a * b), x.r, x.w, Q);
}

// e = 0 and k^2 = 4 |a3 z_4 x D + a1 D x z_1|^2, k = r + a1^2 + a3^2 - a2^2 - 2 a1 a3 w
inline void upright_curves(const ParallelLoop& p, const ParallelProducts& x,
                           ParallelCurves<Parallel::kUpright>& out) noexcept {
  const ParallelLinks& of = p.of;
  Wide k[3];
  for (int i = 0; i < 3; ++i) {
    out.line[i] = x.e[i];
    k[i] = x.r[i] - (2.0 * of.a1 * of.a3) * x.w[i];
  }
  k[0] = k[0] + (of.a1 * of.a1 + of.a3 * of.a3 - of.a2 * of.a2);
  add_product(spread<kWide>(1.0), k, k, out.Q);
  take_normals(4.0, of.a3, of.a1, x, out.Q);
  const Wide size = 2.0 * sqrt(dot(k, k));
  const double lengths = std::abs(of.a1) + std::abs(of.a3), lengths2 = lengths * lengths;
  out.line_error = spread<kWide>(kParallelRounding * p.volume);
  const double error = 32.0 * kParallelRounding * lengths2 * p.square + p.conic_off;
  out.error = (kParallelRounding * p.square + p.distance_off) * size + error;
  out.line_shift = spread<kWide>(p.volume_off);
}

// e^2 = |c1 z_4 x D + c3 D x z_1 + d z_1 x z_4|^2
inline void add_meeting_conic(const ParallelLinks& of, const ParallelProducts& x, Wide (&Q)[6]) noexcept {
  const double first = 2.0 * of.c1 * of.d, third = 2.0 * of.c3 * of.d;
  add_product(spread<kWide>(1.0), x.e, x.e, Q);
  take_normals(1.0, of.c1, of.c3, x, Q);
  Q[0] = Q[0] - of.d * of.d;
  add_product(spread<kWide>(of.d * of.d), x.w, x.w, Q);
  add_product(spread<kWide>(-first), x.w, x.v, Q);
  add_linear(first, x.u, Q);
  add_product(spread<kWide>(-third), x.u, x.w, Q);
  add_linear(third, x.v, Q);
}

template <Parallel Kind>
inline ParallelCurves<Kind> curves(const ParallelLoop& p, const ParallelProducts& x) noexcept {
  const ParallelLinks& of = p.of;
  ParallelCurves<Kind> out;
  for (Wide& q : out.Q) q = spread<kWide>(0.0);
  if constexpr (Kind == Parallel::kUpright) {
    upright_curves(p, x, out);
    return out;
  }
  for (int i = 0; i < 3; ++i) {
    out.line[i] = x.r[i];
    out.second[i] = x.e[i];
  }
  out.line[0] = out.line[0] - (of.a2 * of.a2 + of.d * of.d);
  out.line_error = spread<kWide>(kParallelRounding * p.square);
  out.line_shift = spread<kWide>(p.distance_off);
  if constexpr (Kind == Parallel::kMeeting) {
    add_meeting_conic(of, x, out.Q);
    out.error = spread<kWide>(2.0 * kParallelRounding * p.volume * p.volume + p.conic_off);
  } else {
    out.error = spread<kWide>(kParallelRounding * p.volume);
    out.shift = spread<kWide>(p.volume_off);
  }
  return out;
}

// f, zero where the curves meet on the circle, and the most that it may be off: of degree 4 in theta_6 for two lines.
inline void resultant(const ParallelCurves<Parallel::kPlain>& of, Wide& f, Wide& blur) noexcept {
  Wide x[3];
  cross(of.line, of.second, x);
  f = x[1] * x[1] + x[2] * x[2] - x[0] * x[0];
  const Wide off = of.line_error * sqrt(dot(of.second, of.second)) + of.error * sqrt(dot(of.line, of.line));
  blur = off * (2.0 * sqrt(dot(x, x)) + off);
}

// Otherwise of degree 8: 2 tr (Q N)^2 - (tr Q N)^2, N the dual of the line's two points on the circle. It is quadratic
// in Q N, and the error of that is at most |N| |dQ| + |Q| |dN| in Frobenius' norm.
template <Parallel Kind> inline void resultant(const ParallelCurves<Kind>& of, Wide& f, Wide& blur) noexcept {
  const auto& l = of.line;
  const auto& q = of.Q;
  const Wide xx = l[0] * l[0], yy = l[1] * l[1], zz = l[2] * l[2];
  const Wide n00 = yy + zz, n01 = -l[0] * l[1], n02 = -l[0] * l[2], n11 = xx - zz, n12 = l[1] * l[2], n22 = xx - yy;
  const Wide N[3][3] = {{n00, n01, n02}, {n01, n11, n12}, {n02, n12, n22}};
  const Wide M[3][3] = {{q[0], q[1], q[2]}, {q[1], q[3], q[4]}, {q[2], q[4], q[5]}};
  Wide G[3][3], sizes[3] = {spread<kWide>(0.0), spread<kWide>(0.0), spread<kWide>(0.0)};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      G[i][j] = M[i][0] * N[0][j] + M[i][1] * N[1][j] + M[i][2] * N[2][j];
      sizes[0] = sizes[0] + M[i][j] * M[i][j];
      sizes[1] = sizes[1] + N[i][j] * N[i][j];
      sizes[2] = sizes[2] + G[i][j] * G[i][j];
    }
  const Wide trace = G[0][0] + G[1][1] + G[2][2];
  const Wide squares = G[0][0] * G[0][0] + G[1][1] * G[1][1] + G[2][2] * G[2][2];
  const Wide mixed = G[0][1] * G[1][0] + G[0][2] * G[2][0] + G[1][2] * G[2][1];
  f = 2.0 * (squares + 2.0 * mixed) - trace * trace;
  const Wide dual_error = 2.9 * sqrt(xx + yy + zz) * of.line_error;
  const Wide off = sqrt(sizes[1]) * of.error + sqrt(sizes[0]) * dual_error;
  blur = off * (9.0 * sqrt(sizes[2]) + 5.0 * off);
}

template <Parallel Kind> inline constexpr int kParallelDegree = Kind == Parallel::kPlain ? 4 : 8;

inline Wide value(const ParallelCurves<Parallel::kPlain>& of, const Wide& line, const Wide& second) noexcept {
  ParallelCurves<Parallel::kPlain> moved = of;
  moved.line[0] = moved.line[0] + line;
  moved.second[0] = moved.second[0] + second;
  Wide f, unused;
  resultant(moved, f, unused);
  return f;
}

template <Parallel Kind> inline Wide value(const ParallelCurves<Kind>& of, const Wide& line) noexcept {
  ParallelCurves<Kind> moved = of;
  moved.line[0] = moved.line[0] + line;
  Wide f, unused;
  resultant(moved, f, unused);
  return f;
}

// The most that the links' shifts change f, next to a polynomial of second degree in them: farthest at a corner.
inline Wide most_shifted(const ParallelCurves<Parallel::kPlain>& of, const Wide& f) noexcept {
  const Wide &a = of.line_shift, &b = of.shift;
  const Wide same = max(abs(value(of, a, b) - f), abs(value(of, -a, -b) - f));
  return max(same, max(abs(value(of, a, -b) - f), abs(value(of, -a, b) - f)));
}

template <Parallel Kind> inline Wide most_shifted(const ParallelCurves<Kind>& of, const Wide& f) noexcept {
  return max(abs(value(of, of.line_shift) - f), abs(value(of, -of.line_shift) - f));
}

// Values at N angles, the most that they may be off by rounding, and by shifts; whether there are any.
template <Parallel Kind, int N>
inline bool parallel_values(const ParallelLoop& p, const double (&c)[N], const double (&s)[N], double (&f)[N],
                            double (&blur)[N], double (&shift)[N]) noexcept {
  static_assert(N % kWide == 0);
  for (int n = 0; n < N; n += kWide) {
    const ParallelCurves<Kind> both = curves<Kind>(p, products(p, load<kWide>(c + n), load<kWide>(s + n)));
    Wide here, off;
    resultant(both, here, off);
    if (p.rounded) store(most_shifted(both, here), shift + n);
    store(here, f + n);
    store(off, blur + n);
  }
  return p.rounded;
}

}  // namespace elimination
}  // namespace ikgen_runtime
