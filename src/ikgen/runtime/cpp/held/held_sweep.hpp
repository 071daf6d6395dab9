// Rows of a pose over the values of the held joint, followed from one value to the next. Cells between samples are
// halved until nothing can happen in them unseen.
#pragma once

#include "held/held_doubts.hpp"

namespace ikgen_runtime {

// Arm: as for HeldSample; kGuarded, whether its margins are all that makes rows come and go. Visit: first(sample),
// cell(before, a, b, links, after): links.next[lane], the lane of b that each of a goes on as, -1 for none; before and
// after, the samples beyond; fine, how many cells narrower than kNarrow were halved.
template <class Arm> struct HeldSweep {
  using Sample = HeldSample<Arm>;
  using Links = BranchLinks<Arm>;
  using Beside = BesideCell<Arm>;
  static constexpr int kCells = Arm::kGuarded ? 64 : 512;
  static constexpr double kFixed = 1e-9;  // a joint with no more range is pinned, and has one cell, which is not halved
  // Of cells narrower than kNarrow so many are halved, a share of them anywhere and the others as the range is swept. Where
  // rounding leaves rows at some values and none at others, as with a stretched elbow, there is always more to see.
  static constexpr int kFine = 64 * Arm::kMaxSolutions;
  static constexpr double kAnywhere = 0.25;

  const Eigen::Isometry3d& pose;
  JointBounds<Arm> bounds;
  double low = -kPi, high = kPi;

  HeldSweep(const Eigen::Isometry3d& T, bool limits) noexcept : pose(T), bounds(limits) {
    if constexpr (!Arm::kArmAngle) hold_joint(limits);
  }

  // The rows at a value; with `margins_only` they may have lost digits where margins tell which are real.
  Sample at(double held, bool margins_only = false) const noexcept { return Sample(pose, held, bounds, margins_only); }

  template <class Visit> void run(Visit& visit) const noexcept {
    Sample window[4];  // before, lower end, upper end, after; a ring
    Links links[4];    // from each to the next
    const int cells = fixed() ? 1 : kCells;
    window[1] = at(low);
    window[2] = at(value(1, cells));
    links[1] = Links(window[1], window[2]);
    visit.first(window[1]);
    for (int k = 0; k < cells; ++k) {
      const Sample &a = window[(k + 1) % 4], &b = window[(k + 2) % 4];
      const Beside before = {k > 0 ? &window[k % 4] : nullptr, &links[k % 4]};
      Beside after = {nullptr, nullptr};
      if (k + 2 <= cells) {
        window[(k + 3) % 4] = at(value(k + 2, cells));
        links[(k + 2) % 4] = Links(b, window[(k + 3) % 4]);
        after = {&window[(k + 3) % 4], &links[(k + 2) % 4]};
      }
      cell(before, a, b, links[(k + 1) % 4], after, visit);
    }
  }

 private:
  bool fixed() const noexcept { return !(high - low > kFixed); }

  double value(int k, int cells) const noexcept { return k == cells ? high : low + (high - low) * k / cells; }

  // The range of the held joint.
  void hold_joint(bool limits) noexcept {
    constexpr int j = Arm::kFreeJoints[0];
    const double lower = Arm::kLower.data()[j], upper = Arm::kUpper.data()[j];
    const bool bounded = upper - lower < kInfinity;
    if (Arm::kPeriod[j] > 0.0 && !(limits && bounded)) {
      low = -0.5 * Arm::kPeriod[j];
      high = -low;
      return;
    }
    const double remote = bounded ? kInfinity : reach();
    low = std::max(lower, -remote);
    high = std::min(upper, remote);
  }

  // How far a slide without limits is looked at: the arm's lengths from the pose.
  double reach() const noexcept {
    double remote = pose.translation().norm();
    for (const auto& F : Arm::kFrames) remote += std::sqrt(F[0][3] * F[0][3] + F[1][3] * F[1][3] + F[2][3] * F[2][3]);
    for (int j = 0; j < Arm::kDof; ++j)
      if (!(Arm::kPeriod[j] > 0.0) && Arm::kUpper.data()[j] - Arm::kLower.data()[j] < kInfinity)
        remote += std::max(std::abs(Arm::kLower.data()[j]), std::abs(Arm::kUpper.data()[j]));
    return remote;
  }

  template <class Visit>
  void cell(const Beside& before, const Sample& a, const Sample& b, const Links& links, const Beside& after,
            Visit& visit) const noexcept {
    const double width = b.held - a.held, share = kAnywhere + (1.0 - kAnywhere) * (a.held - low) / (high - low);
    const bool narrow = !(width > HeldDoubts<Arm>::kNarrow * (high - low));
    if (fixed() || (narrow && visit.fine > share * kFine) ||
        !HeldDoubts<Arm>{bounds, high - low, before, after, a, b, links}.any())
      return visit.cell(before, a, b, links, after);
    visit.fine += narrow;
    const Sample middle = at(0.5 * (a.held + b.held));
    const Links up(a, middle), on(middle, b);
    cell(before, a, middle, up, {&b, &on}, visit);
    cell({&a, &up}, middle, b, on, after, visit);
  }
};

}  // namespace ikgen_runtime
