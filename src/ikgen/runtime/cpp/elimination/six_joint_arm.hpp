#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "elimination/general_6r_candidate.hpp"
#include "elimination/general_6r_solutions.hpp"

namespace ikgen_runtime {

// --- an elimination of six joints for an arm, its held joints at given values --------------------------

namespace elimination {

inline constexpr double kNearlySingular = 1e-3;  // smallest singular value of the slope, lengths over the arm's

// Which row goes before others where a continuum gives too many: 0 a regular one, 1 one right to round-off, 2 the rest.
template <class Frames>
inline int crowd_class(const Frames& F, const Frame& T, const Turning& turning, const double (&values)[6]) noexcept {
  const State at = residual(F, T, values, turning);
  double square = 0.0;
  for (const double e : still_of(at).flow) square += e * e;
  return square >= kNearlySingular * kNearlySingular ? 0 : at.worst < kExactly ? 1 : 2;
}

// How far apart two rows are, whole turns aside.
inline double row_gap(const Solution& a, const Solution& b) noexcept {
  double out = 0.0;
  for (Index i = 0; i < 6; ++i) {
    const double gap = std::abs(a.q[i] - b.q[i]);
    out = std::max(out, std::min(gap, std::abs(2.0 * kPi - gap)));
  }
  return out;
}

// Leaves at most so many rows, in their order: where a continuum gives more, its samples go, but for those that are the
// farthest from all that are kept, so that none crowds out others.
template <class Frames>
inline void leave_most(const Frames& F, const Frame& T, const Turning& turning, int most, Solutions& found) noexcept {
  int rank[kRoom], kept = 0;
  double gap[kRoom];
  bool stays[kRoom] = {};
  for (int k = 0; k < found.count; ++k) {
    rank[k] = crowd_class(F, T, turning, found.rows[static_cast<Index>(k)].q);
    gap[k] = 1e300;
  }
  for (int level = 0; level < 3; ++level)
    while (kept < most) {
      int best = -1;
      for (int k = 0; k < found.count; ++k)
        if (rank[k] == level && !stays[k] && (best < 0 || (level > 0 && gap[k] > gap[best]))) best = k;
      if (best < 0) break;
      stays[best] = true;
      ++kept;
      for (int k = 0; k < found.count; ++k)
        gap[k] = std::min(gap[k], row_gap(found.rows[static_cast<Index>(k)], found.rows[static_cast<Index>(best)]));
    }
  const int count = found.count;
  found.count = 0;
  for (int k = 0; k < count; ++k)
    if (stays[k]) found.rows[static_cast<Index>(found.count++)] = found.rows[static_cast<Index>(k)];
}

// Upper rows of a transform, its lengths over the plan's.
template <class Plan>
inline Frame scaled_frame(const double (&x)[12]) noexcept {
  Frame out;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) out.R[r][c] = x[4 * r + c];
    out.p[r] = x[4 * r + 3] * (1.0 / Plan::kLength);
  }
  return out;
}

template <class Plan, class Frames = Chain, int N>
inline Frames chain_of(const double (&F)[N][12]) noexcept {
  Frames out;
  for (std::size_t n = 0; n < std::size_t{N}; ++n) out[n] = scaled_frame<Plan>(F[n]);
  return out;
}

}  // namespace elimination

// Arm: kMotions, in order along the chain, each with `joint` and `revolute`; kFrames, the upper rows of the
// constants around them; kHeld by joint; kMaxSolutions; Plan, with kLength (m), a typical size of the arm. Six
// joints are not held. Method::solve<Plan>(chain, pose, turning, found): the elimination, for the chain of their axes,
// which are six unless Frames has room for more; false where it can't tell whether there are solutions.
template <class Arm, class Method, class Frames = elimination::Chain>
struct SixJointArm {
  static constexpr std::size_t kCount = sizeof(Arm::kMotions) / sizeof(Arm::kMotions[0]);
  static constexpr int kFrames = sizeof(Frames) / sizeof(Frame);
  using Plan = typename Arm::Plan;

  // The chain of the moving axes, the held joints' values (cosine and sine, or a distance) merged into it.
  static void merge(const double* held, double (&F)[kFrames][12]) noexcept {
    Frame frame = constant(0);
    int n = 0;
    for (std::size_t i = 0; i < kCount; ++i) {
      const auto& motion = Arm::kMotions[i];
      if (!is_held(motion.joint)) {
        write(frame, F[n++]);
        frame = constant(i + 1);
        continue;
      }
      frame = motion.revolute ? rotated(frame, held[0], held[1]) : slid(frame, held[0]);
      held += motion.revolute ? 2 : 1;
      frame = compose(frame, constant(i + 1));
    }
    write(frame, F[n]);
  }

  // Per solution the cosine and sine of every moving joint's angle, or its length; how many, as in Roots. x: the pose by
  // rows, then the held values.
  template <std::size_t N>
  static int branches(const double* x, double (&roots)[Arm::kMaxSolutions][N]) noexcept {
    double F[kFrames][12], T[12];
    merge(x + 12, F);
    for (int i = 0; i < 12; ++i) T[i] = x[i];
    elimination::Solutions found;
    found.count = 0;
    const elimination::Turning turns = turning();
    const Frames chain = elimination::chain_of<Plan, Frames>(F);
    const Frame aim = elimination::scaled_frame<Plan>(T);
    const bool sure = Method::template solve<Plan>(chain, aim, turns, found);
    elimination::sort_rows(turns, found);
    if (found.count > Arm::kMaxSolutions) elimination::leave_most(chain, aim, turns, Arm::kMaxSolutions, found);
    int count = 0;
    while (count < found.count) {
      write(found.rows[static_cast<std::size_t>(count)], turns, roots[count]);
      ++count;
    }
    return sure ? count : -1 - count;
  }

 private:
  static elimination::Turning turning() noexcept {
    elimination::Turning out{};
    std::size_t place[sizeof(Arm::kHeld)] = {}, n = 0;  // of each joint among those that move
    for (std::size_t j = 0; j < sizeof(Arm::kHeld); ++j) {
      place[j] = n;
      n += Arm::kHeld[j] ? 0 : 1;
    }
    for (const auto& motion : Arm::kMotions)
      if (!is_held(motion.joint)) out[place[motion.joint]] = motion.revolute;
    return out;
  }

  static constexpr bool is_held(int joint) noexcept { return Arm::kHeld[static_cast<std::size_t>(joint)]; }

  static Frame constant(std::size_t i) noexcept {
    Frame out;
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) out.R[r][c] = Arm::kFrames[i][r][c];
      out.p[r] = Arm::kFrames[i][r][3];
    }
    return out;
  }

  static void write(const Frame& frame, double (&to)[12]) noexcept {
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) to[4 * r + c] = frame.R[r][c];
      to[4 * r + 3] = frame.p[r];
    }
  }

  static void write(const elimination::Solution& row, const elimination::Turning& turns, double* to) noexcept {
    for (std::size_t i = 0; i < 6; ++i) {
      *to++ = turns[i] ? row.c[i] : row.q[i] * Plan::kLength;
      if (turns[i]) *to++ = row.s[i];
    }
  }
};

}  // namespace ikgen_runtime
