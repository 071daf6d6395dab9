// Good rows over a grid of several held joints' values, each made better by a compass search (Hooke, Jeeves 1961).
#pragma once

#include "held/row_preference.hpp"
#include "held/slide_range.hpp"

namespace ikgen_runtime {

// Arm: as for RowPreference; Solver: as for PathStep.
template <class Arm, class Solver> struct HeldGridSearch {
  static constexpr int kStarts = 32, kPoints = 4096, kHalvings = 30;

  struct Start {
    double cost = kInfinity, q[Arm::kDof];
  };

  const Eigen::Isometry3d& pose;
  const RowPreference<Arm>& preference;
  bool real = false;
  double low[Arm::kFree], high[Arm::kFree];
  Start starts[kStarts];

  static void solve(const Eigen::Isometry3d& pose, const RowPreference<Arm>& preference, typename Arm::Solutions& out) noexcept {
    HeldGridSearch search{pose, preference, false, {}, {}, {}};
    const int count = search.bound();
    search.scan(count);
    out.count = 0;
    for (Start& s : search.starts) search.improve(s, count);
    std::sort(search.starts, search.starts + kStarts, [](const Start& a, const Start& b) { return a.cost < b.cost; });
    for (const Start& s : search.starts)
      if (s.cost < kInfinity) SolutionRows<Arm>::add(out, s.q, RankLoss<Arm>::below(s.q, Arm::Policy::kRankLoss));
    out.status = out.count > 0 ? Arm::Status::Ok : search.real ? Arm::Status::Limits : Arm::Status::Unreachable;
  }

 private:
  // The ranges of the held joints, and how many values each takes. A turn, or a metre to either side, is looked at where
  // there are no limits; a slide as far as the pose can be reached from.
  int bound() noexcept {
    for (int k = 0; k < Arm::kFree; ++k) {
      const int j = Arm::kFreeJoints[static_cast<std::size_t>(k)];
      const double middle = preference.wanted.data()[j];
      low[k] = Arm::kLower.data()[j];
      high[k] = Arm::kUpper.data()[j];
      if (Arm::kRevolute[j] && !(preference.options.limits && high[k] - low[k] < kInfinity)) {
        low[k] = -kPi;
        high[k] = kPi;
      }
      const SlideRange<Arm> range(pose.translation().data(), j);
      const double nearby = std::min(std::max(range.low, low[k]), high[k]), remote = std::min(std::max(range.high, low[k]), high[k]);
      low[k] = nearby;
      high[k] = remote;
      if (!(low[k] > -kInfinity)) low[k] = std::min(high[k], middle) - 1.0;
      if (!(high[k] < kInfinity)) high[k] = std::max(low[k], middle) + 1.0;
    }
    return std::max(3, static_cast<int>(std::pow(kPoints, 1.0 / Arm::kFree) + 1e-9));
  }

  void scan(int count) noexcept {
    int index[Arm::kFree] = {};
    for (int k = 0; k < Arm::kFree;) {
      std::array<double, Arm::kFree> free;
      for (int i = 0; i < Arm::kFree; ++i) free[static_cast<std::size_t>(i)] = low[i] + (high[i] - low[i]) * index[i] / (count - 1);
      look(free, [this](const Start& s) {
        int worst = 0;
        for (int i = 1; i < kStarts; ++i)
          if (starts[i].cost > starts[worst].cost) worst = i;
        if (s.cost < starts[worst].cost) starts[worst] = s;
      });
      for (k = 0; k < Arm::kFree && ++index[k] == count; ++k) index[k] = 0;
    }
  }

  // Shows all rows at some values.
  template <class Take> void look(const std::array<double, Arm::kFree>& free, const Take& take) noexcept {
    typename Arm::Options options;
    typename Arm::Solutions found;
    options.limits = false;
    options.free = free;
    Solver::solve(pose, options, found);
    real = real || found.count > 0;
    for (int r = 0; r < found.count; ++r) {
      Start s;
      std::copy_n(SolutionRows<Arm>::row(found, r), Arm::kDof, s.q);
      if (!preference.place(s.q)) continue;
      s.cost = preference.cost(s.q);
      take(s);
    }
  }

  void improve(Start& best, int count) noexcept {
    double step[Arm::kFree];
    for (int k = 0; k < Arm::kFree; ++k) step[k] = 0.5 * (high[k] - low[k]) / (count - 1);
    for (int n = 0; n < kHalvings && best.cost < kInfinity; ++n) {
      bool moved = false;
      for (int k = 0; k < 2 * Arm::kFree; ++k) {
        std::array<double, Arm::kFree> free;
        for (std::size_t i = 0; i < free.size(); ++i) free[i] = best.q[Arm::kFreeJoints[i]];
        free[static_cast<std::size_t>(k / 2)] += k % 2 == 0 ? step[k / 2] : -step[k / 2];
        const Start from = best;
        look(free, [&](const Start& s) {
          double gap = 0.0;
          for (int j = 0; j < Arm::kDof; ++j) gap = std::max(gap, std::abs(s.q[j] - from.q[j]));
          if (gap > 0.5 || !(s.cost < best.cost)) return;
          best = s;
          moved = true;
        });
      }
      for (double& x : step) x *= moved ? 1.0 : 0.5;
    }
  }
};

}  // namespace ikgen_runtime
