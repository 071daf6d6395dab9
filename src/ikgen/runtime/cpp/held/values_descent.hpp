// Descent to better rows of a pose by values of several held joints that go together: a compass search (Hooke, Jeeves 1961)
// that looks at the minimum of the quadratic through its costs as well (Winfield 1973), which narrow valleys are followed by.
// Where a sweep finds nothing the next one goes in other directions (Abramson et al. 2009): limits of joints that are not
// held, and folds, run aslant of the values.
#pragma once

#include "rows/row_preference.hpp"

namespace ikgen_runtime {

// Arm: as for RowPreference; Solver: solve(pose, options, out).
template <class Arm, class Solver> struct ValuesDescent {
  static constexpr int kFree = Arm::kFree, kSweeps = 100;
  static constexpr double kLeastStep = 1e-10;  // rad or m
  static constexpr double kNear = 0.5;         // rad or m that a row may be from the one that a step began at
  static constexpr double kFarthest = 4.0;     // steps that the quadratic's minimum may be away
  static constexpr double kRoundOff = 1e-12;   // of how much it bends: less than that is not at all
  static constexpr double kShortest = 0.1;     // of a step, that it makes of the next one
  static constexpr double kLonger = 2.0;       // times a step in directions that have led to something better
  static constexpr double kGolden = 2.399963229728653;  // rad, of which no two multiples are a whole turn apart
  using Held = std::array<double, Arm::kFree>;

  // A row, of infinite cost outside the limits, and the squared distance from what is wanted.
  struct Start {
    double cost = kInfinity, away, q[Arm::kDof];
  };
  struct Point {
    int count = 0;
    Start row[Arm::kMaxSolutions];
  };

  const Eigen::Isometry3d& pose;
  const RowPreference<Arm>& preference;

  // All rows at some values.
  void look(const Held& held, Point& out) const noexcept {
    typename Arm::Options options;
    typename Arm::Solutions found;
    options.limits = false;
    options.free = held;
    Solver::solve(pose, options, found);
    out.count = found.count;
    for (int r = 0; r < found.count; ++r) {
      Start& s = out.row[r];
      std::copy_n(SolutionRows<Arm>::row(found, r), Arm::kDof, s.q);
      s.cost = preference.place(s.q) ? preference.cost(s.q) : kInfinity;
      s.away = 0.0;
      for (int j = 0; j < Arm::kDof; ++j) s.away += (s.q[j] - preference.wanted.data()[j]) * (s.q[j] - preference.wanted.data()[j]);
    }
  }

  // To better rows of the same branch, by steps that get shorter.
  void improve(Start& best, Held step) const noexcept {
    const Held first = step;
    int turns = 0;
    for (int n = 0; n < kSweeps && *std::max_element(step.begin(), step.end()) > kLeastStep && best.cost < kInfinity; ++n) {
      Sweep sweep{best, best, step, Turned(turns), {}, {}, true};
      for (int k = 0; k < kFree; ++k) {
        sweep.up[k] = sweep.take(*this, way(k, 1.0));
        sweep.down[k] = sweep.take(*this, way(k, -1.0));
      }
      double H[kFree][kFree], lowest[kFree];
      for (int a = 0; a < kFree; ++a) {
        for (int b = 0; b < a; ++b) {
          Held both = way(a, 1.0);
          both[static_cast<std::size_t>(b)] = 1.0;
          H[a][b] = sweep.take(*this, both) - sweep.up[a] - sweep.up[b] + best.cost;
        }
        H[a][a] = sweep.up[a] + sweep.down[a] - 2.0 * best.cost;
        lowest[a] = 0.5 * (sweep.down[a] - sweep.up[a]);
      }
      double share = !(sweep.best.cost < best.cost) ? 0.5 : turns > 0 ? kLonger : 1.0;
      if (sweep.whole && minimum(H, lowest)) {
        Held there;
        double longest = 0.0;
        for (int k = 0; k < kFree; ++k) {
          there[static_cast<std::size_t>(k)] = lowest[k];
          longest = std::max(longest, std::abs(lowest[k]));
        }
        const double before = sweep.best.cost;
        sweep.take(*this, there);
        if (sweep.best.cost < before) share = std::min(std::max(longest, kShortest), 1.0);
      }
      turns += sweep.best.cost < best.cost ? 0 : 1;
      best = sweep.best;
      for (std::size_t k = 0; k < step.size(); ++k) step[k] = std::min(step[k] * share, first[k]);
    }
  }

 private:
  // Directions, orthonormal, that differ from one of the turns to the next: the axes, then their reflections about
  // directions spread evenly.
  struct Turned {
    Held mirror = {};
    explicit Turned(int turns) noexcept {
      double square = 0.0;
      for (int k = 0; k < kFree && turns > 0; ++k) {
        const double x = std::cos(kGolden * turns * (k + 1) + k);
        mirror[static_cast<std::size_t>(k)] = x;
        square += x * x;
      }
      for (double& x : mirror) x /= std::sqrt(std::max(square, 1e-300));
    }
    Held of(const Held& way) const noexcept {
      Held out = way;
      double dot = 0.0;
      for (std::size_t k = 0; k < way.size(); ++k) dot += mirror[k] * way[k];
      for (std::size_t k = 0; k < way.size(); ++k) out[k] -= 2.0 * dot * mirror[k];
      return out;
    }
  };

  // Costs at steps around a row, and the best row there; `whole`: whether there was one inside the limits at each.
  struct Sweep {
    const Start middle;
    Start best;
    const Held& step;
    const Turned turned;
    double up[kFree], down[kFree];
    bool whole;

    // That of the row of the same branch a way from it, in steps; infinite where there is none.
    double take(const ValuesDescent& of, const Held& steps) noexcept {
      const Held way = turned.of(steps);
      Held held;
      for (std::size_t k = 0; k < held.size(); ++k) {
        const auto joint = static_cast<std::size_t>(Arm::kFreeJoints[k]);
        const double wanted = middle.q[joint] + way[k] * step[k];
        held[k] = of.preference.options.limits ? std::min(std::max(wanted, Arm::kLower.data()[joint]), Arm::kUpper.data()[joint]) : wanted;
        whole = whole && held[k] == wanted;
      }
      Point there;
      of.look(held, there);
      const Start* nearest = nullptr;
      double least = kNear;
      for (int r = 0; r < there.count; ++r) {
        double gap = 0.0;
        for (int j = 0; j < Arm::kDof; ++j) gap = std::max(gap, std::abs(SolutionRows<Arm>::change(j, middle.q, there.row[r].q)));
        if (!(gap < least)) continue;
        least = gap;
        nearest = &there.row[r];
      }
      whole = whole && nearest && nearest->cost < kInfinity;
      if (!nearest) return kInfinity;
      if (nearest->cost < best.cost) best = *nearest;
      return nearest->cost;
    }
  };

  static Held way(int k, double steps) noexcept {
    Held out = {};
    out[static_cast<std::size_t>(k)] = steps;
    return out;
  }

  // Where a quadratic is least, from minus its slope, as far as it may be; false where it is nowhere.
  static bool minimum(double (&H)[kFree][kFree], double (&lowest)[kFree]) noexcept {
    double most = 0.0;
    for (int k = 0; k < kFree; ++k) most = std::max(most, H[k][k]);
    factor(H);
    if (!definite(H)) return false;
    for (int k = 0; k < kFree; ++k)
      if (!(kRoundOff * most * H[k][k] < 1.0)) return false;
    substitute(H, lowest);
    double longest = 0.0;
    for (const double x : lowest) longest = std::max(longest, std::abs(x));
    for (double& x : lowest) x *= std::min(1.0, kFarthest / std::max(longest, 1e-300));
    return true;
  }
};

}  // namespace ikgen_runtime
