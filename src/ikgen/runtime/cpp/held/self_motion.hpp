// Where the held joint may be: intervals of its value over which a branch stays inside the limits.
#pragma once

#include "held/branch_ends.hpp"

namespace ikgen_runtime {

// Follows the branches of a sweep and tells `Record` of their runs inside the limits: open(lane, at, q, branch, fold),
// pass(lane, sample), move(next), close(lane, at, q, fold), `fold` where a branch meets another; rows of ends may have lost
// digits. Arm: as for HeldSweep.
template <class Arm, class Record> struct BranchFollower {
  using Sample = HeldSample<Arm>;
  using End = BranchEnd<Arm>;
  using Links = typename HeldSweep<Arm>::Links;
  using Beside = typename HeldSweep<Arm>::Beside;
  static constexpr int kLanes = Sample::kLanes;
  const HeldSweep<Arm>& sweep;
  Record& record;
  int branch[kLanes], branches = 0, fine = 0;
  bool any = false;

  BranchFollower(const HeldSweep<Arm>& values, Record& to) noexcept : sweep(values), record(to) {}

  void first(const Sample& s) noexcept {
    for (int l = 0; l < s.lanes; ++l) {
      if (!s.real[l]) continue;
      any = true;
      branch[l] = branches++;
      if (s.inside(l)) open(l, s, s.held, nullptr, false);
    }
  }

  void cell(const Beside& before, const Sample& a, const Sample& b, const Links& links, const Beside& after) noexcept {
    const int* next = links.next;
    LastEnd<Arm> last;
    for (int l = 0; l < a.lanes; ++l) {
      if (!a.real[l] || !a.inside(l) || (next[l] >= 0 && b.inside(next[l]))) continue;
      End end(a, l, b, next[l], next, after.sample, next[l] >= 0 && after.sample ? after.links->next[next[l]] : -1, before.sample,
              before.sample ? before.links->origin[l] : -1);
      const bool rough = late[l].waits && ++slivers > kSlivers;
      if (late[l].waits) begin(l, a, rough);
      if (!rough) end.find(sweep, last);
      record.close(l, end.inner, end.q, end.at_fold);
    }
    record.move(next);
    move(a, links, b);
    for (int k = 0; k < b.lanes; ++k) {
      if (!b.real[k]) continue;
      const int l = links.origin[k];
      any = true;
      if (b.inside(k) && !(l >= 0 && a.inside(l))) {
        End end(b, k, a, l, links.origin, before.sample, l >= 0 && before.sample ? before.links->origin[l] : -1, after.sample,
                after.sample ? after.links->next[k] : -1);
        late[k].waits = narrow(end.outer, b.held);
        if (late[k].waits) {
          static_cast<End&>(late[k]) = end;
        } else {
          end.find(sweep, last);
          open(k, b, end.inner, end.q, end.at_fold);
        }
      } else if (b.inside(k)) {
        if (late[k].waits && !narrow(late[k].outer, b.held)) {
          begin(k, b, false);
        } else if (!late[k].waits) {
          record.pass(k, b);
        }
      }
    }
    if (b.held == sweep.high) finish(b);
  }

 private:
  // A beginning that is looked for once the interval is wider than what may be missed.
  struct Late : End {
    bool waits = false;
  };
  Late late[kLanes];
  static constexpr int kSlivers = 2 * Arm::kMaxSolutions;
  int slivers = 0;  // intervals that are that narrow; beyond kSlivers their ends are left where they were seen

  void begin(int lane, const Sample& s, bool rough) noexcept {
    LastEnd<Arm> none;
    if (!rough) late[lane].find(sweep, none);
    late[lane].waits = false;
    open(lane, s, late[lane].inner, late[lane].q, late[lane].at_fold);
  }

  bool narrow(double low, double high) const noexcept {
    constexpr double few = HeldSweep<Arm>::kAnywhere * HeldSweep<Arm>::kFine;
    const double least = fine > few ? HeldDoubts<Arm>::kNarrow : HeldDoubts<Arm>::kLeast;
    return high - low < 4.0 * least * (sweep.high - sweep.low);
  }

  // Branches and beginnings to the lanes in which they go on; rows without one begin branches.
  void move(const Sample& a, const Links& links, const Sample& b) noexcept {
    bool plain = true;
    for (int k = 0; k < b.lanes; ++k) plain = plain && (links.origin[k] == k || !b.real[k]);
    if (plain) return;
    int before[kLanes];
    std::copy_n(branch, kLanes, before);
    bool waiting = false;
    for (int l = 0; l < a.lanes; ++l) waiting = waiting || late[l].waits;
    if (waiting) {
      Late old[kLanes];
      std::copy_n(late, kLanes, old);
      for (int k = 0; k < b.lanes; ++k)
        if (links.origin[k] >= 0) late[k] = old[links.origin[k]];
    }
    for (int k = 0; k < b.lanes; ++k) {
      if (links.origin[k] < 0) late[k].waits = false;
      if (b.real[k]) branch[k] = links.origin[k] >= 0 ? before[links.origin[k]] : branches++;
    }
  }

  void finish(const Sample& s) noexcept {
    for (int k = 0; k < s.lanes; ++k)
      if (s.inside(k)) {
        double q[Arm::kDof];
        s.row(k, q);
        if (late[k].waits) begin(k, s, false);
        record.close(k, s.held, q, false);
      }
  }

  void open(int lane, const Sample& s, double at, const double* q, bool fold) noexcept {
    double own[Arm::kDof];
    s.row(lane, own);
    record.open(lane, at, q ? q : own, Arm::kGuarded ? lane % Arm::kLanes : branch[lane], fold);
    record.pass(lane, s);
  }
};

// Tells a record of all branches, whether there are any. Arm: as for BranchFollower. Where the joint limits alone tell where
// they are inside, at an arm angle of exact geometry, arm_angle_motion.hpp has it.
template <class Arm, bool kFromLimits = Arm::kArmAngle && !Arm::kRounded> struct BranchMotion {
  template <class Record> static bool follow(const HeldSweep<Arm>& sweep, Record& record) noexcept {
    BranchFollower<Arm, Record> follower(sweep, record);
    sweep.run(follower);
    return follower.any;
  }
};

// Intervals of self_motion, by branch and value. Arm: as for BranchMotion; Intervals, its result.
template <class Arm> struct SelfMotionFinder {
  using Sample = HeldSample<Arm>;
  static constexpr int kCells = 1;
  typename Arm::Intervals& out;
  double start[Sample::kLanes];
  int branch[Sample::kLanes];

  void open(int lane, double at, const double*, int number, bool) noexcept {
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
  void close(int lane, double at, const double*, bool) noexcept {
    if (out.count == Arm::kMaxIntervals && !leave_out_narrowest(at - start[lane])) return;
    int k = out.count++;
    auto* list = out.intervals.data();
    for (; k > 0 && (list[k - 1].branch > branch[lane] || (list[k - 1].branch == branch[lane] && list[k - 1].low > start[lane])); --k)
      list[k] = list[k - 1];
    list[k] = {start[lane], at, branch[lane]};
  }

  // Makes room for an interval if there is a narrower one.
  bool leave_out_narrowest(double width) noexcept {
    const auto first = out.intervals.begin(), end = first + out.count;
    const auto narrowest = std::min_element(first, end, [](const auto& a, const auto& b) { return a.high - a.low < b.high - b.low; });
    out.complete = false;
    if (!(narrowest->high - narrowest->low < width)) return false;
    std::copy(narrowest + 1, end, narrowest);
    --out.count;
    return true;
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
    const bool any = BranchMotion<Arm>::follow(sweep, finder);
    if (!Arm::kGuarded) number(out);  // else they are the closed form's
    out.status = out.count > 0 ? Arm::Status::Ok : any ? Arm::Status::Limits : Arm::Status::Unreachable;
  }
};

}  // namespace ikgen_runtime
