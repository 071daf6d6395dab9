#pragma once

#include <cstddef>

#include "general_6r.hpp"

namespace ikgen_runtime {

// --- general_6r: the elimination for an arm, its held joints at given values -------------------------

namespace g6 {

inline constexpr double kNearlySingular = 1e-3;  // smallest singular value of the slope, lengths over the arm's

// The least singular value of the chain's slope, from above: inverse iteration.
inline double least_singular(const Chain& F, const double (&angles)[6]) noexcept {
  Vector q;
  for (Index i = 0; i < 6; ++i) q[i] = angles[i];
  const State at = residual(F, F[0], q);
  Vector x = {1.0, -0.7, 0.4, 0.9, -0.3, 0.6};
  double size = 0.0;
  for (int pass = 0; pass < 4; ++pass) {
    double square = 0.0;
    for (const double e : x) square += e * e;
    for (double& e : x) e /= std::sqrt(square) + 1e-300;
    Vector y{};
    for (Index k = 0; k < 6; ++k)
      for (Index i = 0; i < 6; ++i) y[k] += at.J(k, i) * x[i];
    size = 0.0;
    for (const double e : y) size += e * e;
    x = inverse_normal(at, x, 1e-18);
  }
  return std::sqrt(size);
}

}  // namespace g6

// Arm: kMotions, in order along the chain, each with `joint` and `revolute`; kFrames, the upper rows of the
// constants around them; kHeld by joint; kMaxSolutions; Plan, as for general_6r. Six of the motions are not held.
template <class Arm>
struct General6r {
  static constexpr int kCount = sizeof(Arm::kMotions) / sizeof(Arm::kMotions[0]);

  // The chain of the six moving joints, the held ones' values (cosine and sine, or a distance) merged into it.
  static void merge(const double* held, double (&F)[7][12]) noexcept {
    g6::Frame frame = constant(0);
    int n = 0;
    for (int i = 0; i < kCount; ++i) {
      const auto& motion = Arm::kMotions[i];
      if (!Arm::kHeld[motion.joint]) {
        write(frame, F[n++]);
        frame = constant(i + 1);
        continue;
      }
      if (motion.revolute)
        frame = g6::turn(frame, held[0], held[1]);
      else
        for (std::size_t r = 0; r < 3; ++r) frame.p[r] += frame.R(r, 2) * held[0];
      held += motion.revolute ? 2 : 1;
      frame = g6::compose(frame, constant(i + 1));
    }
    write(frame, F[n]);
  }

  // Per solution the cosine and sine of every moving joint's angle; how many. x: the pose by rows, then the held
  // values.
  static int branches(const double* x, double (&roots)[Arm::kMaxSolutions][12]) noexcept {
    double F[7][12], T[12];
    merge(x + 12, F);
    for (int i = 0; i < 12; ++i) T[i] = x[i];
    g6::Solutions found;
    general_6r<typename Arm::Plan>(F, T, found);
    const bool crowded = found.count > Arm::kMaxSolutions;  // samples of a continuum go first
    int count = 0;
    for (int pass = 0; pass < (crowded ? 2 : 1); ++pass)
      for (int k = 0; k < found.count && count < Arm::kMaxSolutions; ++k) {
        const g6::Solution& row = found.rows[static_cast<std::size_t>(k)];
        if (crowded && nearly_singular(F, row) != (pass == 1)) continue;
        for (int i = 0; i < 6; ++i) {
          roots[count][2 * i] = row.c[i];
          roots[count][2 * i + 1] = row.s[i];
        }
        ++count;
      }
    return count;
  }

 private:
  static g6::Frame constant(int i) noexcept {
    g6::Frame out;
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) out.R(r, c) = Arm::kFrames[i][r][c];
      out.p[r] = Arm::kFrames[i][r][3];
    }
    return out;
  }

  static void write(const g6::Frame& frame, double (&to)[12]) noexcept {
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) to[4 * r + c] = frame.R(r, c);
      to[4 * r + 3] = frame.p[r];
    }
  }

  static bool nearly_singular(const double (&F)[7][12], const g6::Solution& row) noexcept {
    return g6::least_singular(chain_of<typename Arm::Plan>(F), row.q) < g6::kNearlySingular;
  }
};

}  // namespace ikgen_runtime
