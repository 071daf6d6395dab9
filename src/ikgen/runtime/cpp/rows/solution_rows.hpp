#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "arrays/constants.hpp"

namespace ikgen_runtime {

// As Solutions, with room for rows that are outside the limits, or farther from a seed than others.
template <class Arm> struct RowPlaces {
  static constexpr std::size_t kRoom = 2 * Arm::kMaxSolutions;
  int count = 0;
  std::array<typename Arm::Joints, kRoom> q;
  std::array<bool, kRoom> singular;
};

// The rows of one answer. Arm: kDof, kMaxSolutions, kLower, kUpper; kPeriod, how far apart values of a joint
// are that are the same configuration (rad; 0: none are); kHeld, a flag a joint; Options,
// Solutions, Policy. Out: Solutions, or what has its members and more room.
template <class Arm> struct SolutionRows {
  using Options = typename Arm::Options;
  using Policy = typename Arm::Policy;
  template <class Out> static constexpr int kRoom = static_cast<int>(std::tuple_size<decltype(Out::q)>::value);

  template <class Out> static double* row(Out& out, int k) noexcept { return out.q.data()[k].data(); }
  template <class Out> static bool& flag(Out& out, int k) noexcept { return out.singular.data()[k]; }
  template <class Out> static void move(Out& out, int from, int to) noexcept {
    std::copy_n(row(out, from), Arm::kDof, row(out, to));
    flag(out, to) = flag(out, from);
  }

  static bool finite(const double* q) noexcept {
    return std::all_of(q, q + Arm::kDof, [](double x) { return std::isfinite(x); });
  }

  // The change of a joint from one row to another, the shortest way.
  static double change(int j, const double* a, const double* b) noexcept {
    return within_period(j, b[j] - a[j]);
  }

  // A joint's value, or a change of it, within half a period.
  static double within_period(int j, double x) noexcept {
    return Arm::kPeriod[j] > 0.0 ? without_turns(x, Arm::kPeriod[j]) : x;
  }

  // How far a joint is from a value, the shortest way.
  static double beyond(int j, double x, double value) noexcept {
    const double gap = value - x;
    return std::abs(Arm::kHeld[j] ? gap : within_period(j, gap));
  }

  // Whether two rows are the same, whole turns aside; long slides count relative to their length.
  static bool same(const double* a, const double* b) noexcept {
    for (int j = 0; j < Arm::kDof; ++j) {
      double gap = std::abs(a[j] - b[j]);
      if (gap > Policy::kCoincident) gap = std::abs(within_period(j, gap));
      const double bound = Policy::kCoincident * (Arm::kPeriod[j] > 0.0 ? 1.0 : std::max(std::abs(a[j]), 1.0));
      if (!(gap <= bound)) return false;
    }
    return true;
  }

  // Adds a row unless it is there already, or there is no room; where it is of no continuum, one that is makes room.
  template <class Out> static void add(Out& out, const double* q, bool singular) noexcept {
    if (out.count == kRoom<Out> && singular) return;
    for (int k = 0; k < out.count; ++k)
      if (same(q, row(out, k))) return;
    if (out.count == kRoom<Out> && !make_room(out)) return;
    std::copy_n(q, Arm::kDof, row(out, out.count));
    flag(out, out.count) = singular;
    ++out.count;
  }

  // Drops the last row of a continuum; whether there is one.
  template <class Out> [[gnu::cold, gnu::noinline]] static bool make_room(Out& out) noexcept {
    for (int k = out.count - 1; k >= 0; --k) {
      if (!flag(out, k)) continue;
      for (--out.count; k < out.count; ++k) move(out, k + 1, k);
      return true;
    }
    return false;
  }

  // Whether joints have one turn inside the limits, that around 0.
  static constexpr bool one_turn() noexcept {
    for (int j = 0; j < Arm::kDof; ++j) {
      const double low = Arm::kLower.data()[j], high = Arm::kUpper.data()[j], least = Policy::kLimitTolerance;
      const double turn = Arm::kPeriod[j];
      if (turn > 0.0 && !(low > -0.5 * turn && high <= 0.5 * turn && high - low < turn - 2.0 * least)) return false;
    }
    return true;
  }

  // Whether all joint values are inside the limits.
  static bool within(const double* q) noexcept {
    bool in = true;
    for (int j = 0; j < Arm::kDof; ++j) {
      const double low = Arm::kLower.data()[j], high = Arm::kUpper.data()[j];
      in = in & (low <= q[j]) & (q[j] <= high);
    }
    return in;
  }

  enum class Place { Inside, Hardly, Outside };

  // Puts a row on the turns that the seed or the limits ask for, one that is hardly outside on the limits.
  static Place placed(double* q, const Options& options) noexcept {
    if constexpr (one_turn())
      if (options.limits && within(q)) return Place::Inside;
    Place where = Place::Inside;
    const double* seed = options.seed ? options.seed->data() : nullptr;
    for (int j = 0; j < Arm::kDof; ++j) {
      const double low = Arm::kLower.data()[j] - Policy::kLimitTolerance, high = Arm::kUpper.data()[j] + Policy::kLimitTolerance;
      const double turn = Arm::kPeriod[j];
      if (turn > 0.0 && !Arm::kHeld[j]) {
        q[j] += q[j] <= -0.5 * turn ? turn : q[j] > 0.5 * turn ? -turn : 0.0;
        double shift = seed ? turn * std::nearbyint((seed[j] - q[j]) / turn) : 0.0;
        if (options.limits && q[j] + shift < low) shift = turn * std::ceil((low - q[j]) / turn);
        if (options.limits && q[j] + shift > high) shift = turn * std::floor((high - q[j]) / turn);
        q[j] += shift;
      }
      if (!options.limits) continue;
      if (!(low <= q[j] && q[j] <= high)) {
        const double below = beyond(j, q[j], Arm::kLower.data()[j]), above = beyond(j, q[j], Arm::kUpper.data()[j]);
        if (!(std::min(below, above) < Policy::kLimitReach)) return Place::Outside;
        q[j] = below < above ? Arm::kLower.data()[j] : Arm::kUpper.data()[j];
        where = Place::Hardly;
      }
      q[j] = std::min(std::max(q[j], Arm::kLower.data()[j]), Arm::kUpper.data()[j]);
    }
    return where;
  }

  // The same; false where it is outside.
  static bool place(double* q, const Options& options) noexcept { return placed(q, options) == Place::Inside; }

  template <class Out> static void sort_by_distance(Out& out, const double* seed) noexcept {
    sort(out, [seed](const double* q) noexcept {
      double sum = 0.0;
      for (int j = 0; j < Arm::kDof; ++j) sum += (q[j] - seed[j]) * (q[j] - seed[j]);
      return sum;
    });
  }

  // By cost(row), the least first, equal ones as they were.
  template <class Out, class Cost> static void sort(Out& out, const Cost& cost) noexcept {
    const int count = out.count;
    double costs[std::size_t{kRoom<Out>}], rows[std::size_t{kRoom<Out>}][Arm::kDof];
    bool flags[std::size_t{kRoom<Out>}] = {};
    int place[std::size_t{kRoom<Out>}] = {};
    for (int k = 0; k < count; ++k) {
      std::copy_n(row(out, k), Arm::kDof, rows[k]);
      flags[k] = flag(out, k);
      costs[k] = cost(rows[k]);
      place[k] = 0;
      for (int i = 0; i < k; ++i) {
        const int before = costs[k] < costs[i] ? 1 : 0;
        place[i] += before;
        place[k] += 1 - before;
      }
    }
    for (int k = 0; k < count; ++k) {
      std::copy_n(rows[k], Arm::kDof, row(out, place[k]));
      flag(out, place[k]) = flags[k];
    }
  }
};

}  // namespace ikgen_runtime
