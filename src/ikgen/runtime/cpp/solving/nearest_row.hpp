// The configuration whose pose is nearest to one that is asked for: what is least is |p - p'|^2 / size^2 + chord^2, the
// chord that of the rotation, direction or heading that the task reads. Damped Gauss-Newton steps inside the limits
// (Levenberg 1944, Marquardt 1963), from many starts; those that come nearest in a few steps are followed to the end.
#pragma once

#include <algorithm>
#include <cmath>

#include "arrays/constants.hpp"
#include "arm/motion_chain.hpp"
#include "arm/pose_entries.hpp"

namespace ikgen_runtime {

// What a configuration's entries are off those of a pose, and their slope by the joints that move.
template <class Arm> struct PoseChords {
  static constexpr int kCount = PoseEntries<Arm>::kCount;
  double error[kCount], slope[kCount][Arm::kDof], cost = 0.0;

  // t: the pose's matrix, columns first.
  PoseChords(const double* q, const double* t) noexcept {
    double J[6][Arm::kDof], rows[3][4];
    const Frame T = MotionChain<Arm>::forward(q, J);
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 4; ++c) rows[r][c] = t[4 * c + r];
    PoseEntries<Arm>::error(rows, T, error);
    PoseEntries<Arm>::slope(T, J, slope);
    for (int i = 0; i < kCount; ++i) {
      const double weight = Arm::kRead[i][1] == 3 ? 1.0 : turn();
      error[i] *= weight;
      cost += error[i] * error[i];
      for (int j = 0; j < Arm::kDof; ++j) slope[i][j] *= Arm::kHeld[j] ? 0.0 : weight;
    }
  }

  // A turn by x moves the nine entries of a rotation by sqrt(8) sin(x / 2).
  static double turn() noexcept {
    int turned = 0;
    for (const auto& entry : Arm::kRead) turned += entry[1] < 3 ? 1 : 0;
    return turned == 9 ? std::sqrt(0.5) : 1.0;
  }

  // m and rad; single entries are sines of angles to the base's planes.
  static void off_by(const double* q, const double* t, double* off) noexcept {
    const PoseChords at(q, t);
    double f[16], length = 0.0, chord = 0.0, angles = 0.0;
    by_columns(MotionChain<Arm>::forward(q), f);
    for (int i = 0; i < kCount; ++i) {
      const auto [r, c] = Arm::kRead[i];
      (c == 3 ? length : chord) += at.error[i] * at.error[i];
      if (c == 3 || Arm::Columns::has(c)) continue;
      const double gap = std::asin(std::clamp(f[4 * c + r], -1.0, 1.0)) - std::asin(std::clamp(t[4 * c + r], -1.0, 1.0));
      angles += gap * gap;
    }
    off[0] = std::sqrt(length) * Arm::kSize;
    off[1] = angles > 0.0 ? std::sqrt(angles) : 2.0 * std::asin(std::min(0.5 * std::sqrt(chord), 1.0));
  }
};

// Arm: as for PoseChords; kLower, kUpper, kFreeJoints, Options.
template <class Arm> struct NearestRow {
  using Options = typename Arm::Options;
  using Chords = PoseChords<Arm>;
  static constexpr int kStarts = 256, kFollowed = 16, kSteps = 80;
  static constexpr int kFirstSteps = 12;  // of each start: where they begin tells little of where they lead
  static constexpr int kFewSteps = 4;     // of each start where a row takes the pose, or none is wanted
  static constexpr double kLeast = 1e-10, kFirst = 1e-3, kMost = 1e10;  // damping of a step
  static constexpr double kFinest = 1e-15;  // of one along directions in which the pose hardly moves
  static constexpr double kLongest = 0.5;     // rad or m: step of a joint
  static constexpr double kRoundOff = 1e-16;  // over what is least: a step that gains less ends the descent
  static constexpr double kStanding = 1e-6;   // over what is least and not 0: a step that gains less ends it

  // t: the pose's matrix, columns first; inside: whether limits hold; enough: as for descend; first: steps of each start;
  // flat: whether they go on along directions in which the pose hardly moves. What is least there.
  [[gnu::cold, gnu::noinline]] static double find(const double* t, const Options& options, bool inside, double enough,
                                                  int first, double* best, bool flat = false, int starts = kStarts) noexcept {
    double rows[kFollowed][Arm::kDof], costs[kFollowed], q[Arm::kDof], root = 2.0;
    for (int k = 0; k < 40; ++k) root = std::pow(1.0 + root, 1.0 / (Arm::kDof + 1));
    int kept = 0;
    for (int i = -1; i < starts; ++i) {
      if (i >= 0) start(i, root, options, inside, q);
      for (int j = 0; i < 0 && j < Arm::kDof; ++j) {
        double low, high;
        bounds(j, inside, &low, &high);
        q[j] = std::clamp(options.seed ? options.seed->data()[j] : 0.0, low, high);
      }
      hold(options, q);
      const double cost = descend(t, inside, enough, q, first);
      int at = std::min(kept, kFollowed - 1);
      if (kept == kFollowed && !(cost < costs[at])) continue;
      for (; at > 0 && costs[at - 1] > cost; --at) {
        costs[at] = costs[at - 1];
        std::copy_n(rows[at - 1], Arm::kDof, rows[at]);
      }
      costs[at] = cost;
      std::copy_n(q, Arm::kDof, rows[at]);
      kept = std::min(kept + 1, kFollowed);
    }
    double least = kInfinity;
    for (int k = 0; k < kept; ++k) {
      std::copy_n(rows[k], Arm::kDof, q);
      const double cost = descend(t, inside, enough, rows[k]);
      take_better(rows[k], flat ? descend(t, inside, enough, rows[k], kSteps, kFinest) : cost, best, least);
      if (flat) take_better(q, descend(t, inside, enough, q, kSteps, kFinest), best, least);
    }
    return least;
  }

  // Puts joints between their limits, on the turn that is nearest to the middle, where steps may begin.
  static void put_inside(double* q) noexcept {
    for (int j = 0; j < Arm::kDof; ++j) {
      const double low = Arm::kLower.data()[j], high = Arm::kUpper.data()[j], middle = 0.5 * (low + high);
      if (Arm::kHeld[j]) continue;
      if (Arm::kPeriod[j] > 0.0 && std::isfinite(middle)) q[j] = middle + without_turns(q[j] - middle, Arm::kPeriod[j]);
      q[j] = std::clamp(q[j], low, high);
    }
  }

  // Steps from q; what is least where they end: where one that is hardly damped gains a share of that which is not
  // enough. floor: least damping of a step.
  static double descend(const double* t, bool limits, double enough, double* q, int steps = kSteps,
                        double floor = kLeast) noexcept {
    double damping = kFirst;
    Chords at(q, t);
    for (int i = 0; i < steps && damping < kMost; ++i) {
      double trial[Arm::kDof];
      std::copy_n(q, Arm::kDof, trial);
      const double gain = step(at, limits, damping, trial);
      const bool last = !(gain > enough * at.cost || damping > kFirst);
      const Chords there(trial, t);
      const bool better = there.cost < at.cost;
      damping = std::clamp(damping * (better ? 0.2 : 8.0), floor, kMost);
      if (better) {
        at = there;
        std::copy_n(trial, Arm::kDof, q);
      }
      if (last) break;
    }
    return at.cost;
  }

  static void hold(const Options& options, double* q) noexcept {
    for (std::size_t k = 0; k < Arm::kFreeJoints.size(); ++k) q[Arm::kFreeJoints[k]] = options.free[k];
  }

 private:
  static void take_better(const double* q, double cost, double* best, double& least) noexcept {
    if (!(cost < least)) return;
    least = cost;
    std::copy_n(q, Arm::kDof, best);
  }

  // The range of a joint that steps are clipped to, or of `half` to each side of 0 and beyond.
  static void bounds(int j, bool limits, double* low, double* high) noexcept {
    *low = limits ? Arm::kLower.data()[j] : -kInfinity;
    *high = limits ? Arm::kUpper.data()[j] : kInfinity;
  }

  // The start i of those that fill the limits evenly: Kronecker's sequence by powers of the root of x^(n + 1) = x + 1
  // (Roberts 2018).
  static void start(int i, double root, const Options& options, bool inside, double* q) noexcept {
    double step = 1.0;
    for (int j = 0; j < Arm::kDof; ++j) {
      step /= root;
      double low, high, whole;
      bounds(j, inside, &low, &high);
      const double half = Arm::kPeriod[j] > 0.0 ? 0.5 * Arm::kPeriod[j] : Arm::kSize;
      const double centre = std::clamp(0.0, low + half, std::max(high - half, low + half));
      low = std::max(low, centre - half);
      high = std::min(high, centre + half);
      q[j] = low + std::modf(0.5 + (i + 1) * step, &whole) * (high - low);
    }
    hold(options, q);
  }

  // One step, in which joints at a limit that it would pass stay; what linear equations have it gain.
  static double step(const Chords& at, bool limits, double damping, double* q) noexcept {
    double V[Chords::kCount][Arm::kDof], push[Arm::kDof], x[Arm::kDof], low[Arm::kDof], high[Arm::kDof], gain = 0.0;
    bool stuck[Arm::kDof];
    transposed_times(at.slope, at.error, push);
    for (int j = 0; j < Arm::kDof; ++j) {
      bounds(j, limits, low + j, high + j);
      stuck[j] = Arm::kHeld[j] || (q[j] <= low[j] && push[j] < 0.0) || (q[j] >= high[j] && push[j] > 0.0);
      for (int e = 0; e < Chords::kCount; ++e) V[e][j] = stuck[j] ? 0.0 : at.slope[e][j];
    }
    least_squares(V, at.error, damping, x);
    for (int j = 0; j < Arm::kDof; ++j) {
      gain += push[j] * x[j];
      if (!stuck[j]) q[j] = std::clamp(q[j] + std::clamp(x[j], -kLongest, kLongest), low[j], high[j]);
    }
    return gain;
  }
};

}  // namespace ikgen_runtime
