#pragma once

#include <cmath>

#include "elimination/coupled_loop.hpp"
#include "elimination/general_6r_newton.hpp"

namespace ikgen_runtime {

// --- coupled_6r: the loop at many angles of the coupled joint, and its equations ---------------------------

namespace elimination {

// The pair of n times an angle.
inline Pair multiple(const Pair& z, int n) noexcept {
  if (n < 0) return multiple({z.c, -z.s}, -n);
  Pair out = {spread<kWide>(1.0), spread<kWide>(0.0)};
  for (; n > 0; --n) out = times(out, z);
  return out;
}

// Cosines and sines by which axes are ahead of the joint's multiples.
template <class Plan> struct Ahead {
  double c[Plan::kAxes.size()], s[Plan::kAxes.size()];
};
template <class Plan> inline Ahead<Plan> ahead_of() noexcept {
  Ahead<Plan> out;
  for (Index i = 0; i < Plan::kAxes.size(); ++i) {
    out.c[i] = std::cos(Plan::kAxes[i].shift);
    out.s[i] = std::sin(Plan::kAxes[i].shift);
  }
  return out;
}

// Ratios that are no whole numbers have no trigonometric polynomial.
template <class Plan> inline Pair axis_pair(const Ahead<Plan>& ahead, Index i, const Pair& joint) noexcept {
  const Axis axis = Plan::kAxes[i];
  const auto ratio = static_cast<int>(std::nearbyint(axis.ratio));
  return times(multiple(joint, ratio), {spread<kWide>(ahead.c[i]), spread<kWide>(ahead.s[i])});
}

// As for a Chain; an axis counts by its ratio.
template <class Plan>
inline Wide linearize(const CoupledChain<Plan>& F, const Frame& T, const Six& q, Wide (&rows)[6][7]) noexcept {
  constexpr Index axes = Plan::kAxes.size();
  const Ahead<Plan> ahead = ahead_of<Plan>();
  WideFrame X = widen(F[0]);
  Wide z[axes][3], origin[axes][3];
  for (Index i = 0; i < axes; ++i) {
    for (Index r = 0; r < 3; ++r) {
      z[i][r] = X.R[r][2];
      origin[i][r] = X.p[r];
    }
    const Index joint = Plan::kAxes[i].joint;
    X = pass(X, axis_pair<Plan>(ahead, i, {q.c[joint], q.s[joint]}), F[i + 1]);
  }
  const Wide worst = set_errors(T, X, rows);
  for (Index a = 0; a < 6; ++a)
    for (Index j = 0; j < 6; ++j) rows[a][j] = spread<kWide>(0.0);
  for (Index a = 0; a < 3; ++a) {
    const Index m = (a + 1) % 3, n = (a + 2) % 3;
    for (Index i = 0; i < axes; ++i) {
      const Axis axis = Plan::kAxes[i];
      const Wide arm = z[i][m] * (X.p[n] - origin[i][n]) - z[i][n] * (X.p[m] - origin[i][m]);
      rows[a][axis.joint] = rows[a][axis.joint] + axis.ratio * arm;
      rows[3 + a][axis.joint] = rows[3 + a][axis.joint] + axis.ratio * z[i][a];
    }
  }
  return worst;
}

// The loop of coupled_loop but for what the coupled joint turns, and its equations.
template <class Plan> struct CoupledEquations {
  CoupledChain<Plan> F;
  Frame closing;  // what the last link of the five has behind the chain: the pose's inverse
  Ahead<Plan> ahead;
  Loop loop;
  Index start;
  Equations eq;
};

template <class Plan>
inline CoupledEquations<Plan> coupled_equations(const CoupledChain<Plan>& F, const Frame& T,
                                                const std::array<int, 3>& plan) noexcept {
  const Loop loop = coupled_loop(F, T, plan, 0.0);
  return {F, inverse(T), ahead_of<Plan>(), loop, static_cast<Index>(plan[0]), eliminate(loop)};
}

// The links behind the second, third and fourth of the five joints at angles of the coupled one.
template <class Plan>
inline void inner_links(const CoupledEquations<Plan>& of, const Pair& angle, WideFrame (&out)[3]) noexcept {
  WideFrame link[6];
  Index n = 0;
  link[0] = widen(of.F[0]);
  for (Index i = 0; i < Plan::kAxes.size(); ++i) {
    if (Plan::kAxes[i].joint == Plan::kCoupled)
      link[n] = pass(link[n], axis_pair<Plan>(of.ahead, i, angle), of.F[i + 1]);
    else
      link[++n] = widen(of.F[i + 1]);
  }
  link[5] = compose(compose(link[5], of.closing), link[0]);
  for (Index i = 0; i < 3; ++i) {
    const Index k = of.loop.reverse ? (of.start + 4 - i) % 5 : (of.start + 1 + i) % 5;
    out[i] = of.loop.reverse ? inverse(link[(k + 4) % 5 + 1]) : link[k + 1];
  }
}

struct WideInvariants {  // as `invariants`
  Wide x[3][4], pp, pl;
};

inline WideInvariants invariants(const WideFrame& X) noexcept {
  const Wide l[3] = {X.R[0][2], X.R[1][2], X.R[2][2]};
  const auto& p = X.p;
  WideInvariants out;
  out.pp = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
  out.pl = p[0] * l[0] + p[1] * l[1] + p[2] * l[2];
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    out.x[i][0] = l[i];
    out.x[i][1] = p[i];
    out.x[i][2] = p[j] * l[k] - p[k] * l[j];
    out.x[i][3] = out.pp * l[i] - 2.0 * out.pl * p[i];
  }
  return out;
}

// Those of C X from those of X, but for what does not depend on X.
inline WideInvariants moved(const WideFrame& C, const WideInvariants& of) noexcept {
  const auto& t = C.p;
  const Wide tt = t[0] * t[0] + t[1] * t[1] + t[2] * t[2];
  WideInvariants out;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 4; ++k) out.x[i][k] = C.R[i][0] * of.x[0][k] + C.R[i][1] * of.x[1][k] + C.R[i][2] * of.x[2][k];
  const auto& x = out.x;
  const Wide tl = t[0] * x[0][0] + t[1] * x[1][0] + t[2] * x[2][0];
  const Wide tp = t[0] * x[0][1] + t[1] * x[1][1] + t[2] * x[2][1];
  out.pp = of.pp + 2.0 * tp;
  out.pl = of.pl + tl;
  Wide across[3], moment[3];
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    across[i] = t[j] * x[k][0] - t[k] * x[j][0];
    moment[i] = t[j] * x[k][2] - t[k] * x[j][2];
  }
  for (int i = 0; i < 3; ++i) {
    out.x[i][2] = out.x[i][2] + across[i];
    out.x[i][3] = out.x[i][3] - 2.0 * moment[i] + tt * out.x[i][0] - 2.0 * (tl + of.pl) * t[i];
  }
  return out;
}

// (1, c, s) of invariants from those at three equidistant angles.
inline void to_trig(const WideInvariants (&v)[3], WideInvariants (&out)[3]) noexcept {
  constexpr double third = 1.0 / 3.0, half = 2.0 / 3.0 * kS3[1];
  const auto set = [&](const Wide& x, const Wide& y, const Wide& z, Wide& f, Wide& c, Wide& s) {
    const Wide both = y + z;
    f = third * (x + both);
    c = third * (2.0 * x - both);
    s = half * (y - z);
  };
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 4; ++k)
      set(v[0].x[i][k], v[1].x[i][k], v[2].x[i][k], out[0].x[i][k], out[1].x[i][k], out[2].x[i][k]);
  set(v[0].pp, v[1].pp, v[2].pp, out[0].pp, out[1].pp, out[2].pp);
  set(v[0].pl, v[1].pl, v[2].pl, out[0].pl, out[1].pl, out[2].pl);
}

// The part of invariants that a turn about z leaves, multiplies with its cosine, and with its sine.
inline void turned_parts(const WideInvariants& of, WideInvariants (&out)[3]) noexcept {
  const Wide none = spread<kWide>(0.0);
  for (int k = 0; k < 4; ++k) {
    const Wide x = of.x[0][k], y = of.x[1][k];
    for (int i = 0; i < 3; ++i) out[i].x[0][k] = out[i].x[1][k] = out[i].x[2][k] = none;
    out[0].x[2][k] = of.x[2][k];
    out[1].x[0][k] = x;
    out[1].x[1][k] = y;
    out[2].x[0][k] = -y;
    out[2].x[1][k] = x;
  }
  out[0].pp = of.pp;
  out[0].pl = of.pl;
  out[1].pp = out[1].pl = out[2].pp = out[2].pl = none;
}

// A column of A from the invariants in its monomial: of E, whose G is one, rows 0-3 take z, p.p and p.l, the others
// x and y.
inline void set_column(const Equations& eq, const WideInvariants& of, int column, Wide (&A)[6][9]) noexcept {
  for (Index i = 0; i < 4; ++i) {
    Wide sum = eq.E(i, 12) * of.pp + eq.E(i, 13) * of.pl;
    for (Index k = 0; k < 4; ++k) sum = sum + eq.E(i, 8 + k) * of.x[2][k];
    A[i][column] = sum;
  }
  for (Index i = 4; i < 6; ++i) {
    Wide sum = eq.E(i, 0) * of.x[0][0] + eq.E(i, 4) * of.x[1][0];
    for (Index k = 1; k < 4; ++k) sum = sum + eq.E(i, k) * of.x[0][k] + eq.E(i, 4 + k) * of.x[1][k];
    A[i][column] = sum;
  }
}

// The six equations at angles of the coupled joint, as `fill` of a Pencil.
template <class Plan>
inline void fill(const CoupledEquations<Plan>& of, const Wide& c, const Wide& s, Wide (&A)[6][9]) noexcept {
  WideFrame C[3];
  inner_links(of, {c, s}, C);
  WideInvariants at[3], five[3], four[3];
  for (int j = 0; j < 3; ++j) {
    WideFrame X = C[1];
    rotate(X, spread<kWide>(kC3[j]), spread<kWide>(kS3[j]));
    at[j] = invariants(compose(X, C[2]));
  }
  to_trig(at, five);
  const auto& t = C[0].p;
  for (int b = 0; b < 3; ++b) {
    turned_parts(five[b], four);
    for (int a = 0; a < 3; ++a) {
      WideInvariants x = moved(C[0], four[a]);
      if (a == 0 && b == 0) {
        for (int i = 0; i < 3; ++i) x.x[i][1] = x.x[i][1] + t[i];
        x.pp = x.pp + (t[0] * t[0] + t[1] * t[1] + t[2] * t[2]);
      }
      set_column(of.eq, x, 3 * a + b, A);
    }
  }
  for (Index i = 0; i < 6; ++i) A[i][0] = A[i][0] + of.eq.E(i, 14);
}

}  // namespace elimination
}  // namespace ikgen_runtime
