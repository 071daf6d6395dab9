#pragma once

#include <cmath>

#include "elimination/general_6r_frames.hpp"

namespace ikgen_runtime {

// --- parallel_6r: a loop whose second and third axes are parallel ------------------------------------

namespace elimination {

// Of the links beside the parallel axes: both; right angles between the axes and no offset; axes that meet.
enum class Parallel { kPlain, kUpright, kMeeting };

// Axes 1 to 4 of a loop, of which 2 and 3 are parallel along the unit vector n, that of axis 2. c1, c3: cosines of the
// angles from axes 1 and 4 to n. a1, a2, a3: distances along the common normals of neighbours, d from the foot of the
// first to that of the last, along n. h1, h4: where on axes 1 and 4 these normals have their feet. side: 1 or -1, axis
// 3's direction along n. tilt: sine between both.
struct ParallelLinks {
  double c1, c3, a1, a2, a3, d, h1, h4, side, tilt;
};

inline ParallelLinks parallel_links(const Loop& loop) noexcept {
  const Frame &first = loop.C[0], &second = loop.C[1], &third = loop.C[2];
  const double nx = first.R[0][2], ny = first.R[1][2], nz = first.R[2][2], s1 = std::sqrt(nx * nx + ny * ny) + 1e-150;
  const double zx = third.R[0][2], zy = third.R[1][2], zz = third.R[2][2], s3 = std::sqrt(zx * zx + zy * zy) + 1e-150;
  const double foot = -(first.p[0] * nx + first.p[1] * ny) / (s1 * s1);  // of the first normal, on axis 2
  ParallelLinks out;
  out.side = second.R[2][2] > 0.0 ? 1.0 : -1.0;
  out.tilt = std::sqrt(second.R[0][2] * second.R[0][2] + second.R[1][2] * second.R[1][2]);
  out.h4 = -(third.p[0] * zx + third.p[1] * zy) / (s3 * s3);
  out.h1 = first.p[2] + foot * nz;
  out.c1 = nz;
  out.c3 = out.side * zz;
  out.a1 = (nx * first.p[1] - ny * first.p[0]) / s1;
  out.a2 = std::sqrt(second.p[0] * second.p[0] + second.p[1] * second.p[1]);
  out.a3 = out.side * (zx * third.p[1] - zy * third.p[0]) / s3;
  out.d = second.p[2] + out.side * (third.p[2] + out.h4 * zz) - foot;
  return out;
}

// z and O: directions of axes 1 and 4, and the feet on them, in the frame between axes 5 and 6. Those of axis 1 are
// terms in (1, cos, sin) of theta_6; those of axis 4, and z x O, are before the turn by -theta_5.
struct ParallelLoop {
  ParallelLinks of;
  double z1[3][3], o1[3][3], z4[3], o4[3], m4[3], z4o4, o4o4;
  // Bounds of changes of r = D.D and e = z_1.(z_4 x D) for each part of a change of z and D, D = O_4 - O_1.
  double square, volume;
  // How far r and e may be off at a solution as the links are not quite of the kind; how far the conic.
  double distance_off, volume_off, conic_off;
  bool rounded;
};

inline void set_turning(const double (&R)[3][3], const double (&v)[3], double (&out)[3][3]) noexcept {
  for (Index i = 0; i < 3; ++i) {
    out[i][0] = R[i][2] * v[2];
    out[i][1] = R[i][0] * v[0] + R[i][1] * v[1];
    out[i][2] = R[i][1] * v[0] - R[i][0] * v[1];
  }
}

inline double length_of(const double (&v)[3]) noexcept { return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]); }

// At a solution e n = c1 z_4 x D + c3 D x z_1 + d z_1 x z_4, and D is the way along the links; axes 2 and 3 reach less
// than the arm's length along themselves.
template <Parallel Kind> inline void set_off(ParallelLoop& p) noexcept {
  const ParallelLinks& of = p.of;
  const double lengths = std::abs(of.a1) + std::abs(of.a3), way = lengths + of.a2 + std::abs(of.d);
  const double volume = (std::abs(of.c1) + std::abs(of.c3)) * way + std::abs(of.d), tilted = of.tilt * (1.0 + way);
  p.distance_off = (of.tilt + (Kind == Parallel::kUpright ? 0.0 : lengths)) * (2.0 * way + lengths);
  p.volume_off = tilted + (Kind == Parallel::kMeeting ? 0.0 : volume);
  p.conic_off = Kind == Parallel::kMeeting ? 2.0 * volume * tilted : 8.0 * square(lengths * p.volume_off);
  p.rounded = p.distance_off + p.volume_off > 1e-14;
}

template <Parallel Kind> inline ParallelLoop parallel_loop(const Loop& loop) noexcept {
  ParallelLoop out;
  out.of = parallel_links(loop);
  const Frame four = inverse(loop.C[3]), &one = loop.C[5], &middle = loop.C[4];
  double z1[3], o1[3];
  for (Index i = 0; i < 3; ++i) {
    z1[i] = one.R[i][2];
    o1[i] = one.p[i] + out.of.h1 * z1[i];
    out.z4[i] = four.R[i][2];
    out.o4[i] = four.p[i] + out.of.h4 * out.z4[i];
  }
  set_turning(middle.R, z1, out.z1);
  set_turning(middle.R, o1, out.o1);
  out.z4o4 = out.o4o4 = 0.0;
  for (Index i = 0; i < 3; ++i) {
    const Index j = (i + 1) % 3, k = (i + 2) % 3;
    out.o1[i][0] += middle.p[i];
    out.m4[i] = out.z4[j] * out.o4[k] - out.z4[k] * out.o4[j];
    out.z4o4 += out.z4[i] * out.o4[i];
    out.o4o4 += out.o4[i] * out.o4[i];
  }
  const double reach = length_of(middle.p) + length_of(o1) + length_of(out.o4);
  out.square = (1.0 + reach) * (1.0 + reach);
  out.volume = 1.0 + 2.0 * reach;
  set_off<Kind>(out);
  return out;
}

}  // namespace elimination
}  // namespace ikgen_runtime
