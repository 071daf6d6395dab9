// Which rows of a pose at two values of the held joint are the same branch.
#pragma once

#include "held/held_sample.hpp"

namespace ikgen_runtime {

// The rows that are nearest to each other at two values: next[lane], origin[lane], -1 for none; and by how much each joint
// that moves changes from a lane to the one that it goes on as. Arm: as for HeldSample; kGuarded.
template <class Arm> struct BranchLinks {
  using Sample = HeldSample<Arm>;
  static constexpr int kLanes = Sample::kLanes, N = Sample::kPack;
  static constexpr double kNear = 0.3;
  int next[kLanes], origin[kLanes];
  double moved[Arm::kDof][kLanes];

  BranchLinks() = default;
  BranchLinks(const Sample& a, const Sample& b) noexcept {
    bool plain = Arm::kGuarded;
    lanes = std::max(a.lanes, b.lanes);
    std::fill(next + lanes, next + kLanes, -1);
    std::fill(origin + lanes, origin + kLanes, -1);
    for (int at = 0; at < lanes; at += N) compare(a, b, at);
    for (int l = 0; l < lanes; ++l) {
      next[l] = a.real[l] && b.real[l] && gap[l] < kNear ? l : -1;
      origin[l] = next[l];
      plain = plain && (next[l] >= 0 || (!a.real[l] && !b.real[l]));
    }
    if (!plain) search(a, b);
  }

 private:
  int lanes;
  double gap[kLanes];  // to the row in the same lane

  void compare(const Sample& a, const Sample& b, int at) noexcept {
    Lanes<N> most = spread<N>(0.0);
    for (int j = 0; j < Arm::kDof; ++j) {
      if (Arm::kHeld[j]) continue;
      const Lanes<N> change = Sample::between(j, load<N>(a.q[j] + at), load<N>(b.q[j] + at));
      most = max(most, abs(change));
      store(change, moved[j] + at);
    }
    store(most, gap + at);
  }

  [[gnu::cold, gnu::noinline]] void search(const Sample& a, const Sample& b) noexcept {
    for (int l = 0; l < lanes; ++l) {
      origin[l] = -1;
      next[l] = nearest(a, l, b);
    }
    for (int l = 0; l < lanes; ++l)
      if (next[l] >= 0 && nearest(b, next[l], a) != l) next[l] = -1;
    for (int l = 0; l < lanes; ++l) {
      if (next[l] < 0) continue;
      origin[next[l]] = l;
      for (int j = 0; j < Arm::kDof && next[l] != l; ++j)
        if (!Arm::kHeld[j]) moved[j][l] = Sample::between(j, a.q[j][l], b.q[j][next[l]]);
    }
  }

  static int nearest(const Sample& a, int lane, const Sample& b) noexcept {
    double q[Arm::kDof];
    a.row(lane, q);
    return a.real[lane] ? b.nearest(q) : -1;
  }
};

}  // namespace ikgen_runtime
