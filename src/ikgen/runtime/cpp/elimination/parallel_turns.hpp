#pragma once

#include "elimination/general_6r_branches.hpp"
#include "elimination/parallel_resultant.hpp"

namespace ikgen_runtime {

// --- parallel_6r: from theta_6 to all six angles, in lanes --------------------------------------------

namespace elimination {

// The point of two lines on the circle.
inline Pair fifth(const ParallelCurves<Parallel::kPlain>& of) noexcept {
  Wide x[3];
  cross(of.line, of.second, x);
  const Wide sign = select(x[0] > 0.0, spread<kWide>(1.0), spread<kWide>(-1.0));
  return unit(sign * x[1], sign * x[2]);
}

// The one of the line's points on the circle that is nearer to the conic.
template <Parallel Kind> inline Pair fifth(const ParallelCurves<Kind>& of) noexcept {
  const auto& l = of.line;
  const auto& q = of.Q;
  const Wide square = l[1] * l[1] + l[2] * l[2] + 1e-300, over = 1.0 / square, half = sqrt(square - l[0] * l[0]);
  const Pair a = {-over * (l[0] * l[1] + half * l[2]), over * (half * l[1] - l[0] * l[2])};
  const Pair b = {over * (half * l[2] - l[0] * l[1]), -over * (half * l[1] + l[0] * l[2])};
  const auto off = [&](const Pair& z) {
    return abs(q[0] + z.c * (2.0 * q[1] + q[3] * z.c + 2.0 * q[4] * z.s) + z.s * (2.0 * q[2] + q[5] * z.s));
  };
  const auto first = off(b) > off(a);
  return {select(first, a.c, b.c), select(first, a.s, b.s)};
}

// The parallel axes' direction n; sign: which of two, where z_1, z_4 and D leave both.
template <Parallel Kind>
inline void direction(const ParallelLinks& of, const Wide (&z)[3], const Wide (&y)[3], const Wide (&D)[3],
                      const Wide& sign, Wide (&n)[3]) noexcept {
  Wide yD[3], Dz[3], turn = sign;
  cross(z, y, n);
  cross(y, D, yD);
  cross(D, z, Dz);
  if constexpr (Kind == Parallel::kMeeting) {
    for (int i = 0; i < 3; ++i) n[i] = of.c1 * yD[i] + of.c3 * Dz[i] + of.d * n[i];
    turn = dot(z, yD);
  } else if constexpr (Kind == Parallel::kUpright) {
    const Wide k = dot(D, D) + (of.a1 * of.a1 + of.a3 * of.a3 - of.a2 * of.a2) - (2.0 * of.a1 * of.a3) * dot(z, y);
    turn = k * (of.a3 * dot(n, yD) + of.a1 * dot(n, Dz));
  }
  const Wide over = 1.0 / sqrt(dot(n, n) + 1e-300), scale = select(turn > 0.0, over, -over);
  for (int i = 0; i < 3; ++i) n[i] = n[i] * scale;
}

// The angle about z from the second of two directions to the first.
inline Pair between(const Wide& x, const Wide& y, const Wide& from_x, const Wide& from_y) noexcept {
  return unit(x * from_x + y * from_y, y * from_x - x * from_y);
}

inline Wide seen(const WideFrame& a, int column, const Wide (&v)[3]) noexcept {
  return a.R[0][column] * v[0] + a.R[1][column] * v[1] + a.R[2][column] * v[2];
}

// The four angles about the parallel axes from their direction n and the other two.
inline Six complete(const Loop& loop, double side, const Wide (&n)[3], const Pair& five, const Pair& six) noexcept {
  const auto& C = loop.C;
  const auto one = [](double x) { return spread<kWide>(x); };
  Pair t[6];
  t[4] = five;
  t[5] = six;
  const WideFrame first = pass(widen(C[4]), six, C[5]), fourth = pass(widen(kIdentity), {five.c, -five.s}, inverse(C[3]));
  t[0] = between(seen(first, 0, n), seen(first, 1, n), one(C[0].R[0][2]), one(C[0].R[1][2]));
  t[3] = between(one(side * C[2].R[2][0]), one(side * C[2].R[2][1]), seen(fourth, 0, n), seen(fourth, 1, n));
  const WideFrame second = pass(first, t[0], C[0]), third = pass(fourth, {t[3].c, -t[3].s}, inverse(C[2]));
  const Wide gap[3] = {third.p[0] - second.p[0], third.p[1] - second.p[1], third.p[2] - second.p[2]};
  t[1] = between(seen(second, 0, gap), seen(second, 1, gap), one(C[1].p[0]), one(C[1].p[1]));
  const WideFrame now = pass(second, t[1], C[1]);
  const Wide x[3] = {third.R[0][0], third.R[1][0], third.R[2][0]}, y[3] = {third.R[0][1], third.R[1][1], third.R[2][1]};
  t[2] = unit(seen(now, 0, x) + seen(now, 1, y), seen(now, 1, x) - seen(now, 0, y));
  Six out;
  for (Index i = 0; i < 6; ++i) {
    out.c[loop.order[i]] = t[i].c;
    out.s[loop.order[i]] = loop.reverse ? -t[i].s : t[i].s;
  }
  return out;
}

// All six angles of solutions from the last of the loop.
template <Parallel Kind>
inline Six complete(const Loop& loop, const ParallelLoop& p, const Pair& six, const Wide& sign) noexcept {
  const ParallelProducts x = products(p, six.c, six.s);
  const Pair five = fifth(curves<Kind>(p, x));
  Wide y[3], D[3], n[3];
  y[0] = five.c * p.z4[0] + five.s * p.z4[1];
  y[1] = five.c * p.z4[1] - five.s * p.z4[0];
  y[2] = spread<kWide>(p.z4[2]);
  D[0] = five.c * p.o4[0] + five.s * p.o4[1] - x.o[0];
  D[1] = five.c * p.o4[1] - five.s * p.o4[0] - x.o[1];
  D[2] = p.o4[2] - x.o[2];
  direction<Kind>(p.of, x.z, y, D, sign, n);
  return complete(loop, p.of.side, n, five, six);
}

}  // namespace elimination
}  // namespace ikgen_runtime
