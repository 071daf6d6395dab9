// Where the held joint may be: intervals of its value over which a branch stays inside the limits.
#pragma once

#include "branch_ends.hpp"

namespace ikgen_runtime {

// Follows the branches of a sweep and tells `Record` of their runs inside the limits: open(lane, at, q, branch),
// pass(lane, sample), move(next), close(lane, at, q). Arm: as for HeldSweep.
template <class Arm, class Record> struct BranchFollower {
  using Sample = HeldSample<Arm>;
  static constexpr int kLanes = Sample::kLanes;
  const HeldSweep<Arm>& sweep;
  Record& record;
  int branch[kLanes], branches = 0;
  bool any = false;

  void first(const Sample& s) noexcept {
    for (int l = 0; l < kLanes; ++l) {
      if (!s.real[l]) continue;
      any = true;
      branch[l] = branches++;
      if (s.inside(l)) open(l, s, l, s.held, nullptr);
    }
  }

  void cell(const Sample& a, const Sample& b, const int* next) noexcept {
    LastEnd<Arm> last;
    int carried[kLanes];
    bool begun[kLanes];
    for (int l = 0; l < kLanes; ++l) {
      carried[l] = -1;
      begun[l] = false;
    }
    for (int l = 0; l < kLanes; ++l) {
      if (!a.real[l] || !a.inside(l) || (next[l] >= 0 && b.inside(next[l]))) continue;
      BranchEnd<Arm> end(a, l, b, next[l]);
      end.find(sweep, last);
      record.close(l, end.inner, end.q);
    }
    record.move(next);
    for (int l = 0; l < kLanes; ++l)
      if (next[l] >= 0) carried[next[l]] = l;
    int before[kLanes];
    std::copy_n(branch, kLanes, before);
    for (int k = 0; k < kLanes; ++k) {
      if (!b.real[k]) continue;
      any = true;
      branch[k] = carried[k] >= 0 ? before[carried[k]] : branches++;
      begun[k] = b.inside(k) && !(carried[k] >= 0 && a.inside(carried[k]));
      if (!begun[k]) continue;
      BranchEnd<Arm> end(b, k, a, carried[k]);
      end.find(sweep, last);
      open(k, b, k, end.inner, end.q);
    }
    for (int k = 0; k < kLanes; ++k)
      if (b.inside(k) && !begun[k]) record.pass(k, b);
    if (b.held == sweep.high)
      for (int k = 0; k < kLanes; ++k)
        if (b.inside(k)) {
          double q[Arm::kDof];
          b.row(k, q);
          record.close(k, b.held, q);
        }
  }

 private:
  void open(int lane, const Sample& s, int row, double at, const double* q) noexcept {
    double own[Arm::kDof];
    s.row(row, own);
    record.open(lane, at, q ? q : own, branch[lane]);
    record.pass(lane, s);
  }
};

// Intervals of self_motion, by branch and value. Arm: as for BranchFollower; Intervals, its result.
template <class Arm> struct SelfMotionFinder {
  using Sample = HeldSample<Arm>;
  typename Arm::Intervals& out;
  double start[Sample::kLanes];
  int branch[Sample::kLanes];

  void open(int lane, double at, const double*, int number) noexcept {
    start[lane] = at;
    branch[lane] = number;
  }
  void pass(int, const Sample&) noexcept {}
  void move(const int* next) noexcept {
    double old[Sample::kLanes];
    int numbers[Sample::kLanes];
    std::copy_n(start, Sample::kLanes, old);
    std::copy_n(branch, Sample::kLanes, numbers);
    for (int l = 0; l < Sample::kLanes; ++l)
      if (next[l] >= 0) {
        start[next[l]] = old[l];
        branch[next[l]] = numbers[l];
      }
  }
  void close(int lane, double at, const double*) noexcept {
    if (out.count == Arm::kMaxIntervals) {
      out.complete = false;
      return;
    }
    int k = out.count++;
    auto* list = out.intervals.data();
    for (; k > 0 && (list[k - 1].branch > branch[lane] || (list[k - 1].branch == branch[lane] && list[k - 1].low > start[lane])); --k)
      list[k] = list[k - 1];
    list[k] = {start[lane], at, branch[lane]};
  }

  // Branches without an interval do not count.
  static void number(typename Arm::Intervals& out) noexcept {
    auto* list = out.intervals.data();
    for (int k = 0, last = -1, n = -1; k < out.count; ++k) {
      if (list[k].branch != last) ++n;
      last = list[k].branch;
      list[k].branch = n;
    }
  }

  static void solve(const Eigen::Isometry3d& pose, bool limits, typename Arm::Intervals& out) noexcept {
    out.count = 0;
    out.complete = true;
    const HeldSweep<Arm> sweep(pose, limits);
    SelfMotionFinder finder{out, {}, {}};
    BranchFollower<Arm, SelfMotionFinder> follower{sweep, finder, {}};
    sweep.run(follower);
    number(out);
    out.status = out.count > 0 ? Arm::Status::Ok : follower.any ? Arm::Status::Limits : Arm::Status::Unreachable;
  }
};

}  // namespace ikgen_runtime
