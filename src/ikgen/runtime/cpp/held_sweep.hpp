// Rows of a pose over the values of the held joint, followed from one value to the next. Cells between samples are
// halved until nothing can happen in them unseen, by second differences of joint values and of what is under square
// roots.
#pragma once

#include "held_sample.hpp"

namespace ikgen_runtime {

// Arm: as for HeldSample; kGuarded, whether its margins are all that makes rows come and go. Visit: first(sample),
// cell(before, a, b, links, after): links.next[lane], the lane of b that each of a goes on as, -1 for none; before and
// after, the samples beyond.
template <class Arm> struct HeldSweep {
  using Sample = HeldSample<Arm>;
  static constexpr int kLanes = Sample::kLanes, kCells = Arm::kGuarded ? 64 : 512;
  static constexpr double kSafety = 4.0, kSmooth = 0.05, kLeast = 1e-5, kNarrow = 1e-3, kRoundOff = 1e-12;

  // The rows that are nearest to each other at two values: next[lane], origin[lane], -1 for none.
  struct Links {
    int next[kLanes], origin[kLanes];

    Links() = default;
    Links(const Sample& a, const Sample& b) noexcept {
      bool plain = Arm::kGuarded;
      lanes = std::max(a.lanes, b.lanes);
      std::fill(next + lanes, next + kLanes, -1);
      std::fill(origin + lanes, origin + kLanes, -1);
      for (int l = 0; l < lanes; ++l) {
        next[l] = a.real[l] && b.real[l] && Sample::gap(a, l, b, l) < 0.3 ? l : -1;
        origin[l] = next[l];
        plain = plain && (next[l] >= 0 || (!a.real[l] && !b.real[l]));
      }
      if (!plain) search(a, b);
    }

   private:
    int lanes;

    [[gnu::cold, gnu::noinline]] void search(const Sample& a, const Sample& b) noexcept {
      for (int l = 0; l < lanes; ++l) {
        origin[l] = -1;
        next[l] = nearest(a, l, b);
      }
      for (int l = 0; l < lanes; ++l)
        if (next[l] >= 0 && nearest(b, next[l], a) != l) next[l] = -1;
      for (int l = 0; l < lanes; ++l)
        if (next[l] >= 0) origin[next[l]] = l;
    }

    static int nearest(const Sample& a, int lane, const Sample& b) noexcept {
      double q[Arm::kDof];
      a.row(lane, q);
      return a.real[lane] ? b.nearest(q) : -1;
    }
  };

  // The sample beyond an end of a cell, if there is one, and the links between.
  struct Beside {
    const Sample* sample;
    const Links* links;
  };

  const Eigen::Isometry3d& pose;
  JointBounds<Arm> bounds;
  double low = -kPi, high = kPi;

  HeldSweep(const Eigen::Isometry3d& T, bool limits) noexcept : pose(T), bounds(limits) {
    if constexpr (!Arm::kArmAngle) hold_joint(limits);
  }

  Sample at(double held) const noexcept { return Sample(pose, held, bounds); }

  template <class Visit> void run(Visit& visit) const noexcept {
    Sample window[4];  // before, lower end, upper end, after; a ring
    Links links[4];    // from each to the next
    window[1] = at(low);
    window[2] = at(value(1));
    links[1] = Links(window[1], window[2]);
    visit.first(window[1]);
    for (int k = 0; k < kCells; ++k) {
      const Sample &a = window[(k + 1) % 4], &b = window[(k + 2) % 4];
      const Beside before = {k > 0 ? &window[k % 4] : nullptr, &links[k % 4]};
      Beside after = {nullptr, nullptr};
      if (k + 2 <= kCells) {
        window[(k + 3) % 4] = at(value(k + 2));
        links[(k + 2) % 4] = Links(b, window[(k + 3) % 4]);
        after = {&window[(k + 3) % 4], &links[(k + 2) % 4]};
      }
      cell(before, a, b, links[(k + 1) % 4], after, visit);
    }
  }

 private:
  double value(int k) const noexcept { return k == kCells ? high : low + (high - low) * k / kCells; }

  // The range of the held joint.
  void hold_joint(bool limits) noexcept {
    constexpr int j = Arm::kFreeJoints[0];
    const double lower = Arm::kLower.data()[j], upper = Arm::kUpper.data()[j];
    const bool bounded = upper - lower < kInfinity;
    if (Arm::kRevolute[j] && !(limits && bounded)) return;
    const double far = bounded ? kInfinity : reach();
    low = std::max(lower, -far);
    high = std::min(upper, far);
  }

  // How far a slide without limits is looked at: the arm's lengths from the pose.
  double reach() const noexcept {
    double far = pose.translation().norm();
    for (const auto& F : Arm::kFrames) far += std::sqrt(F[0][3] * F[0][3] + F[1][3] * F[1][3] + F[2][3] * F[2][3]);
    for (int j = 0; j < Arm::kDof; ++j)
      if (!Arm::kRevolute[j] && Arm::kUpper.data()[j] - Arm::kLower.data()[j] < kInfinity)
        far += std::max(std::abs(Arm::kLower.data()[j]), std::abs(Arm::kUpper.data()[j]));
    return far;
  }

  template <class Visit>
  void cell(const Beside& before, const Sample& a, const Sample& b, const Links& links, const Beside& after,
            Visit& visit) const noexcept {
    if (!doubtful(before, a, b, links, after)) return visit.cell(before, a, b, links, after);
    const Sample middle = at(0.5 * (a.held + b.held));
    const Links up(a, middle), on(middle, b);
    cell(before, a, middle, up, {&b, &on}, visit);
    cell({&a, &up}, middle, b, on, after, visit);
  }

  bool doubtful(const Beside& down, const Sample& a, const Sample& b, const Links& links, const Beside& up) const noexcept {
    const Sample *before = down.sample, *after = up.sample;
    const int* next = links.next;
    const double width = b.held - a.held;
    const bool narrow = width > kLeast * (high - low), wide = width > kNarrow * (high - low);
    if (!narrow) return false;
    bool ending = false, beginning = false;
    const int lanes = std::max(a.lanes, b.lanes);
    for (int l = 0; l < lanes; ++l) {
      if (a.real[l] && next[l] < 0) {
        ending = true;
        const int p = before ? down.links->origin[l] : -1;
        if (near_limit(a, l, p < 0 ? kInfinity : Sample::gap(*before, p, a, l), width, before ? a.held - before->held : 1.0))
          return true;
      }
      if (b.real[l] && links.origin[l] < 0) {
        beginning = true;
        const int n = after ? up.links->next[l] : -1;
        if (near_limit(b, l, n < 0 ? kInfinity : Sample::gap(b, l, *after, n), width, after ? after->held - b.held : 1.0))
          return true;
      }
    }
    if ((ending || beginning) && (wide || (ending && beginning))) return true;
    for (int l = 0; l < lanes; ++l) {
      const int k = next[l];
      bool dead = false;
      if (k >= 0) {
        if (Arm::kGuarded && k != l) return true;
        const int p = before ? down.links->origin[l] : -1, n = after ? up.links->next[k] : -1;
        if (bends(p >= 0 ? before : nullptr, p, a, l, b, k, n >= 0 ? after : nullptr, n, dead)) return true;
      }
      if (hides_fold(before, a, b, after, l, dead, wide)) return true;
    }
    return false;
  }

  // Whether a row that comes to its end within the width may cross a limit on its way, by how far it moved before.
  bool near_limit(const Sample& s, int lane, double moved, double width, double beside) const noexcept {
    if (!bounds.count) return false;
    return std::abs(s.off[lane]) < moved * kSafety * std::sqrt(width * (width + beside)) / beside || moved == kInfinity;
  }

  // Whether a row turns off the straight line, or may cross limits more than once in the cell; `dead`: it is outside
  // all over it.
  bool bends(const Sample* before, int p, const Sample& a, int l, const Sample& b, int k, const Sample* after, int n,
             bool& dead) const noexcept {
    const double width = b.held - a.held;
    double off[Arm::kDof], moved[Arm::kDof];
    bool bent = false;
    for (int j = 0; j < Arm::kDof; ++j) {
      if (Arm::kHeld[j]) continue;
      moved[j] = Sample::change(j, a, l, b, k);
      const double slope = moved[j] / width;
      double second = 0.0;
      if (before) {
        const double beside = a.held - before->held;
        second = std::abs(slope - Sample::change(j, *before, p, a, l) / beside) / (width + beside);
      }
      if (after) {
        const double beside = after->held - b.held;
        second = std::max(second, std::abs(Sample::change(j, b, k, *after, n) / beside - slope) / (width + beside));
      }
      off[j] = before || after ? kSafety * second * width * width / 4.0 : std::abs(moved[j]);
      bent = bent || off[j] > kSmooth;
    }
    if (bent) return true;
    int crossings = 0;
    for (int i = 0; i < bounds.count; ++i) {
      const int j = bounds.joint[i];
      const double x = bounds.offset(i, a.q[j][l]), y = Arm::kRevolute[j] ? shortest(x + moved[j]) : x + moved[j];
      const double reach = bounds.half[i] + Arm::Policy::kLimitTolerance;  // of rows that are taken as inside
      const double left = reach - std::abs(x), right = reach - std::abs(y), slack = off[j] + kRoundOff;
      const bool opposite = x * y < 0.0, far = Arm::kRevolute[j] && std::abs(x) + std::abs(y) > kPi;
      dead = dead || (left < -slack && right < -slack && (!opposite || far));
      if (left > slack && right > slack && !(opposite && far)) continue;
      crossings += left * right <= 0.0 && std::abs(left - right) > 4.0 * slack ? 1 : 2;
    }
    return !dead && crossings > 1;
  }

  // Whether two rows may come and go in the cell, or go and come: of a rounded arm, in a wide one, also where it is not
  // margins that keep them away.
  static bool hides_fold(const Sample* before, const Sample& a, const Sample& b, const Sample* after, int lane, bool dead,
                         bool wide) noexcept {
    if (Arm::kFolds == 0 || lane >= Arm::kLanes || a.real[lane] != b.real[lane] || dead) return false;
    const double width = b.held - a.held;
    bool all = true, some = wide && Arm::kRounded, dips = false;
    for (int k = 0; k < Arm::kFolds; ++k) {
      const double x = a.fold[k][lane], y = b.fold[k][lane], slope = (y - x) / width;
      double second = 0.0;
      if (before) {
        const double beside = a.held - before->held;
        second = std::abs(slope - (x - before->fold[k][lane]) / beside) / (width + beside);
      }
      if (after) {
        const double beside = after->held - b.held;
        second = std::max(second, std::abs((after->fold[k][lane] - y) / beside - slope) / (width + beside));
      }
      const double off = kSafety * second * width * width / 4.0;
      all = all && std::max(x, y) + off > 0.0;
      some = some || x <= 0.0 || y <= 0.0;
      dips = dips || std::min(x, y) - off < 0.0;
    }
    return a.real[lane] ? dips : all && some;
  }
};

}  // namespace ikgen_runtime
