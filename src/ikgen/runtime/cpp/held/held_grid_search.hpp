// Rows that are better than those beside them on a grid of several held joints' values, each made better by steps of these.
#pragma once

#include "held/slide_range.hpp"
#include "held/values_descent.hpp"
#include "rows/row_pair.hpp"
#include "rows/singular_value.hpp"

namespace ikgen_runtime {

// Arm, Solver: as for ValuesDescent.
template <class Arm, class Solver> struct HeldGridSearch {
  static constexpr int kStarts = 32, kPoints = 10000;
  static constexpr double kEqual = 1e-9;  // costs that differ by less are as good

  // Values on an axis of the grid: as many as all axes together have room for.
  static constexpr int points_of_axis() noexcept {
    for (int n = 3;; ++n) {
      int all = 1;
      for (int k = 0; k < Arm::kFree && all <= kPoints; ++k) all *= n + 1;
      if (all > kPoints) return n;
    }
  }
  static constexpr int kCount = points_of_axis();

  using Descent = ValuesDescent<Arm, Solver>;
  using Held = typename Descent::Held;
  using Point = typename Descent::Point;
  using Start = typename Descent::Start;

  const Descent descent;
  bool real = false;
  double axis[Arm::kFree][kCount], reach = Descent::kNear;  // rad or m: rows at values beside each other so near are of one branch
  Held step;  // half of one
  Start starts[kStarts];

  static void solve(const Eigen::Isometry3d& pose, const RowPreference<Arm>& preference, typename Arm::Solutions& out) noexcept {
    HeldGridSearch search{pose, preference};
    for (int k = 0; k < Arm::kFree; ++k) search.spread(k);
    search.scan();
    for (Start& s : search.starts) search.descent.improve(s, search.step);
    std::stable_sort(search.starts, search.starts + kStarts, [](const Start& a, const Start& b) { return a.cost < b.cost; });
    out.count = 0;
    for (const Start& s : search.starts)
      if (s.cost < kInfinity && !RowPair<Arm>::any_within(Arm::Policy::kNeighbouring, s.q, out))
        SolutionRows<Arm>::add(out, s.q, SingularValue<Arm>::below(s.q, Arm::Policy::kSingularBelow));
    out.status = out.count > 0 ? Arm::Status::Ok : search.real ? Arm::Status::Limits : Arm::Status::Unreachable;
  }

 private:
  HeldGridSearch(const Eigen::Isometry3d& goal, const RowPreference<Arm>& wanted) noexcept : descent{goal, wanted} {}

  // Values of a held joint, evenly over its range, and that nearest to what is wanted. A turn, or a metre to either
  // side, is looked at where there are no limits; a slide as far as the pose can be reached from.
  void spread(int k) noexcept {
    const int j = Arm::kFreeJoints[static_cast<std::size_t>(k)];
    const double middle = descent.preference.wanted.data()[j];
    double low = Arm::kLower.data()[j], high = Arm::kUpper.data()[j];
    if (Arm::kPeriod[j] > 0.0 && !(descent.preference.options.limits && high - low < kInfinity)) {
      low = -0.5 * Arm::kPeriod[j];
      high = -low;
    }
    const SlideRange<Arm> range(descent.pose.translation().data(), j);
    const double nearby = std::min(std::max(range.low, low), high), remote = std::min(std::max(range.high, low), high);
    low = nearby > -kInfinity ? nearby : std::min(remote, middle) - 1.0;
    high = remote < kInfinity ? remote : std::max(low, middle) + 1.0;
    int nearest = 0;
    for (int i = 0; i < kCount; ++i) {
      axis[k][i] = low + (high - low) * i / (kCount - 1);
      if (std::abs(axis[k][i] - middle) < std::abs(axis[k][nearest] - middle)) nearest = i;
    }
    axis[k][nearest] = std::min(std::max(middle, low), high);
    step[static_cast<std::size_t>(k)] = 0.5 * (high - low) / (kCount - 1);
    reach = std::max(reach, Descent::kNear + 2.0 * step[static_cast<std::size_t>(k)]);
  }

  // Line by line along the first axis.
  void scan() noexcept {
    int index[Arm::kFree] = {};
    for (int k = 0; k < Arm::kFree;) {
      Point before, here, after;
      at(index, 0, 0, here);
      for (index[0] = 0; index[0] < kCount; ++index[0]) {
        after.count = 0;
        if (index[0] + 1 < kCount) at(index, 0, 1, after);
        take(index, before, here, after);
        before = here;
        here = after;
      }
      index[0] = 0;
      for (k = 1; k < Arm::kFree && ++index[k] == kCount; ++k) index[k] = 0;
    }
  }

  // The rows at a point of the grid, or some steps along an axis from it.
  void at(const int* index, int along, int steps, Point& out) noexcept {
    Held held;
    for (int k = 0; k < Arm::kFree; ++k) held[static_cast<std::size_t>(k)] = axis[k][index[k] + (k == along ? steps : 0)];
    look(held, out);
  }

  // Keeps, of a point's rows, those that none near them at the points beside is better than, or as good and nearer to what
  // is wanted; of too many the best.
  void take(const int* index, const Point& before, const Point& here, const Point& after) noexcept {
    for (int r = 0; r < here.count; ++r) {
      const Start& s = here.row[r];
      Start* worst = std::max_element(starts, starts + kStarts, [](const Start& a, const Start& b) { return a.cost < b.cost; });
      if (s.cost < worst->cost && !beaten(s, before) && !beaten(s, after) && !beaten_aside(index, s)) *worst = s;
    }
  }
  bool beaten(const Start& s, const Point& by) const noexcept {
    return std::any_of(by.row, by.row + by.count, [&](const Start& other) {
      const double more = other.cost - s.cost;
      return (more < -kEqual || (more <= kEqual && other.away < s.away)) && RowPair<Arm>::within(reach, s.q, other.q);
    });
  }
  bool beaten_aside(const int* index, const Start& s) noexcept {
    Point beside;
    for (int k = 1; k < Arm::kFree; ++k)
      for (const int steps : {-1, 1}) {
        if (index[k] + steps < 0 || index[k] + steps == kCount) continue;
        at(index, k, steps, beside);
        if (beaten(s, beside)) return true;
      }
    return false;
  }

  void look(const Held& held, Point& out) noexcept {
    descent.look(held, out);
    real = real || out.count > 0;
  }
};

}  // namespace ikgen_runtime
