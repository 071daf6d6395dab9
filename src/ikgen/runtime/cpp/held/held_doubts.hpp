// Whether something may happen unseen between two samples of the rows over the held joint's values, by second differences
// of joint values and of what is under square roots.
#pragma once

#include "held/branch_links.hpp"

namespace ikgen_runtime {

// The sample beyond an end of a cell, if there is one, and the links between.
template <class Arm> struct BesideCell {
  const HeldSample<Arm>* sample;
  const BranchLinks<Arm>* links;
};

// Of a cell between two samples and what is beside it. Arm: as for BranchLinks.
template <class Arm> struct HeldDoubts {
  using Sample = HeldSample<Arm>;
  using Links = BranchLinks<Arm>;
  using Beside = BesideCell<Arm>;
  static constexpr int N = Sample::kPack;
  static constexpr double kSafety = 4.0, kSmooth = 0.05, kLeast = 1e-5, kNarrow = 1e-3, kRoundOff = 1e-12;

  const JointBounds<Arm>& bounds;
  double range;  // of the held joint's values
  const Beside &down, &up;
  const Sample &a, &b;
  const Links& links;
  double width = b.held - a.held, below = down.sample ? a.held - down.sample->held : 1.0,
         above = up.sample ? up.sample->held - b.held : 1.0;

  bool any() const noexcept {
    const bool narrow = width > kLeast * range, wide = width > kNarrow * range;
    if (!narrow) return false;
    bool ending = false, beginning = false;
    const int lanes = std::max(a.lanes, b.lanes);
    for (int l = 0; l < lanes; ++l) {
      if (a.real[l] && links.next[l] < 0) {
        ending = true;
        const int p = down.sample ? down.links->origin[l] : -1;
        if (near_limit(a, l, p < 0 ? kInfinity : Sample::gap(*down.sample, p, a, l), below)) return true;
      }
      if (b.real[l] && links.origin[l] < 0) {
        beginning = true;
        const int n = up.sample ? up.links->next[l] : -1;
        if (near_limit(b, l, n < 0 ? kInfinity : Sample::gap(b, l, *up.sample, n), above)) return true;
      }
      if (Arm::kGuarded && links.next[l] >= 0 && links.next[l] != l) return true;
    }
    if ((ending || beginning) && (wide || (ending && beginning))) return true;
    for (int at = 0; at < lanes; at += N)
      if (in_lanes(at, wide)) return true;
    return false;
  }

 private:
  // Whether a row that comes to its end within the width may cross a limit on its way, by how far it moved before.
  bool near_limit(const Sample& s, int lane, double moved, double beside) const noexcept {
    if (!bounds.count) return false;
    return std::abs(s.off[lane]) < moved * kSafety * std::sqrt(width * (width + beside)) / beside || moved == kInfinity;
  }

  // Lanes that go on, and the lanes beside that they come from and go on as.
  struct Ways {
    bool own = true;  // all in their own lanes
    int origin[N], next[N];
    Mask<N> go, comes, goes;
  };

  Ways ways(int at) const noexcept {
    Ways w;
    double go[N], comes[N], goes[N];
    for (int i = 0; i < N; ++i) {
      const int l = at + i, k = links.next[l], p = k >= 0 && down.sample ? down.links->origin[l] : -1;
      const int n = k >= 0 && up.sample ? up.links->next[k] : -1;
      go[i] = k >= 0 ? 1.0 : 0.0;
      comes[i] = p >= 0 ? 1.0 : 0.0;
      goes[i] = n >= 0 ? 1.0 : 0.0;
      w.origin[i] = p >= 0 ? p : l;
      w.next[i] = k >= 0 ? k : l;
      w.own = w.own && w.origin[i] == l && w.next[i] == l;
    }
    w.go = load<N>(go) > 0.5;
    w.comes = load<N>(comes) > 0.5;
    w.goes = load<N>(goes) > 0.5;
    return w;
  }

  // Values of the lanes that these are beside.
  static Lanes<N> picked(const double* values, const int (&lane)[N], bool own, int at) noexcept {
    if (own) return load<N>(values + at);
    double out[N];
    for (int i = 0; i < N; ++i) out[i] = values[lane[i]];
    return load<N>(out);
  }

  bool in_lanes(int at, bool wide) const noexcept {
    const Ways w = ways(at);
    Mask<N> dead = load<N>(kNone) > 0.5;
    if (any_of(w.go) && bends(w, at, dead)) return true;
    return Arm::kFolds > 0 && at < Arm::kLanes && hides_fold(at, dead, wide);
  }

  static constexpr double kNone[N] = {};
  static bool any_of(const Mask<N>& m) noexcept { return !all(!m); }

  // How far a curve may be from a straight line in the cell, by its second differences.
  Lanes<N> arch(const Lanes<N>& slope, const Lanes<N>& before, const Mask<N>& comes, const Lanes<N>& after,
                const Mask<N>& goes) const noexcept {
    const Lanes<N> down_by = select(comes, abs(slope - before * (1.0 / below)) * (1.0 / (width + below)), 0.0);
    const Lanes<N> up_by = select(goes, abs(after * (1.0 / above) - slope) * (1.0 / (width + above)), 0.0);
    return max(down_by, up_by) * (kSafety * width * width / 4.0);
  }

  // Whether a row turns off the straight line, or may cross limits more than once in the cell; `dead`: it is outside
  // all over it.
  bool bends(const Ways& w, int at, Mask<N>& dead) const noexcept {
    Lanes<N> off[Arm::kDof], moved[Arm::kDof], most = spread<N>(0.0);
    for (int j = 0; j < Arm::kDof; ++j) {
      if (Arm::kHeld[j]) continue;
      moved[j] = load<N>(links.moved[j] + at);
      const Lanes<N> before = down.sample ? picked(down.links->moved[j], w.origin, w.own, at) : moved[j];
      const Lanes<N> after = up.sample ? picked(up.links->moved[j], w.next, w.own, at) : moved[j];
      off[j] = select(w.comes | w.goes, arch(moved[j] * (1.0 / width), before, w.comes, after, w.goes), abs(moved[j]));
      most = max(most, select(w.go, off[j], 0.0));
    }
    if (any_of(most > kSmooth)) return true;
    Lanes<N> crossings = spread<N>(0.0);
    for (int i = 0; i < bounds.count; ++i) {
      const int j = bounds.joint[i];
      const Lanes<N> x = bounds.offset(i, load<N>(a.q[j] + at)), y = Sample::within(j, x + moved[j]);
      const double reach = bounds.half[i] + Arm::Policy::kLimitTolerance;  // of rows that are taken as inside
      const Lanes<N> left = reach - abs(x), right = reach - abs(y), slack = off[j] + kRoundOff;
      const auto remote = (0.0 > x * y) & (abs(x) + abs(y) > (Arm::kPeriod[j] > 0.0 ? 0.5 * Arm::kPeriod[j] : kInfinity));
      const auto opposite = (0.0 > x * y) & (!remote);
      dead = dead | (w.go & (-slack > left) & (-slack > right) & (!opposite));
      const auto clear = (left > slack) & (right > slack) & (!remote);
      const auto once = (!(left * right > 0.0)) & (abs(left - right) > 4.0 * slack);
      crossings = crossings + select(clear, 0.0, select(once, 1.0, 2.0));
    }
    return any_of(w.go & (!dead) & (crossings > 1.5));
  }

  // Whether two rows may come and go in the cell, or go and come: of a rounded arm, in a wide one, also where it is not
  // margins that keep them away.
  bool hides_fold(int at, const Mask<N>& dead, bool wide) const noexcept {
    double real[N], same[N];
    for (int i = 0; i < N; ++i) {
      real[i] = a.real[at + i] ? 1.0 : 0.0;
      same[i] = a.real[at + i] == b.real[at + i] ? 1.0 : 0.0;
    }
    const Mask<N> is_real = load<N>(real) > 0.5, none = load<N>(kNone) > 0.5, every = !none;
    Mask<N> both = every, some = wide && Arm::kRounded ? every : none, dips = none;
    for (int k = 0; k < Arm::kFolds; ++k) {
      const Lanes<N> x = load<N>(a.fold[k] + at), y = load<N>(b.fold[k] + at);
      const Lanes<N> before = down.sample ? x - load<N>(down.sample->fold[k] + at) : x;
      const Lanes<N> after = up.sample ? load<N>(up.sample->fold[k] + at) - y : y;
      const Lanes<N> off = arch((y - x) * (1.0 / width), before, down.sample ? every : none, after, up.sample ? every : none);
      both = both & (max(x, y) + off > 0.0);
      some = some | (!(min(x, y) > 0.0));
      dips = dips | (0.0 > min(x, y) - off);
    }
    return any_of((load<N>(same) > 0.5) & (!dead) & ((is_real & dips) | ((!is_real) & both & some)));
  }
};

}  // namespace ikgen_runtime
