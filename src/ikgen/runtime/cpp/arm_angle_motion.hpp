// Intervals of the arm angle in closed form from the joint limits (Shimizu et al. 2008). What the shoulder's joints carry
// turns with the arm angle about the line from shoulder to wrist: a joint is on a limit where an axis that turns so
// makes a given angle with one that stays, at no more than two arm angles.
#pragma once

#include "arm_angle.hpp"
#include "self_motion.hpp"

namespace ikgen_runtime {

// Arm: as for SelfMotionFinder and ElbowPlane, with seven revolute joints, of exact geometry.
template <class Arm> struct ArmAngleMotion {
  using Sample = HeldSample<Arm>;
  static constexpr int kElbow = 3, kMost = 2 * 2 * 2 * Arm::kDof;
  static constexpr double kStretched = 1e-4;  // distance of the elbow from the line, over the upper arm
  static constexpr double kAligned = 1e-9;    // 1 less the cosine between the outer axes of shoulder or wrist

  // False where joints come to a singularity on the way: samples tell more there.
  static bool solve(const Eigen::Isometry3d& pose, bool limits, typename Arm::Intervals& out) noexcept {
    const JointBounds<Arm> bounds(limits);
    const Sample at(pose, 0.0, bounds);
    double ends[kMost + 2] = {-kPi, kPi};
    int count = 2;
    for (int l = 0; l < at.lanes; ++l) {
      bool seen = !at.real[l];
      for (int k = 0; k < l; ++k) seen = seen || (at.real[k] && std::abs(at.q[kElbow][k] - at.q[kElbow][l]) < 1e-6);
      if (seen) continue;
      double q[Arm::kDof];
      at.row(l, q);
      if (count + 4 * Arm::kDof > kMost + 2 || !Turn(pose, q).add_ends(bounds, ends, count)) return false;
    }
    std::sort(ends, ends + count);
    collect(pose, bounds, ends, count, out);
    return true;
  }

 private:
  // The axes of a row at arm angle 0, and the line.
  struct Turn {
    double axis[Arm::kDof][3], line[3], q[Arm::kDof];
    bool stretched;

    Turn(const Eigen::Isometry3d& pose, const double* row) noexcept {
      std::copy_n(row, Arm::kDof, q);
      Frame T = MotionChain<Arm>::first();
      for (int i = 0; i < Arm::kDof; ++i) {
        for (int r = 0; r < 3; ++r) axis[i][r] = Arm::kMotions[i].scale * T.R[r][2];
        MotionChain<Arm>::advance(T, i, q);
      }
      const ElbowPlane<Arm> plane(pose);
      double x, y;
      plane.beside(MotionChain<typename Arm::Elbow>::forward(q).p, x, y);
      stretched = std::hypot(x, y) < kStretched * Arm::kUpperArm;
      cross(plane.x, plane.y, line);
    }

    // Adds the arm angles at which a joint may be on a limit; false at singularities.
    bool add_ends(const JointBounds<Arm>& bounds, double* ends, int& count) const noexcept {
      if (stretched || aligned(0, 2) || aligned(6, 4)) return false;
      for (int i = 0; i < bounds.count; ++i)
        for (const double side : {-1.0, 1.0}) {
          const int j = bounds.joint[i];
          const double limit = bounds.middle[i] + side * (bounds.half[i] + Arm::Policy::kLimitTolerance);
          if (j != kElbow) add_roots(j, limit - q[j], ends, count);
        }
      return true;
    }

    static double dot(const double* a, const double* b) noexcept { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

    // `m` turned about the line, times `n`, is a cos + b sin + c of the arm angle.
    void harmonic(const double* n, const double* m, double& a, double& b, double& c) const noexcept {
      double side[3];
      cross(line, m, side);
      c = dot(n, line) * dot(m, line);
      a = dot(n, m) - c;
      b = dot(n, side);
    }

    // Whether the outer axes of the shoulder, or of the wrist, come to one line.
    bool aligned(int still, int turning) const noexcept {
      double a, b, c;
      harmonic(axis[still], axis[turning], a, b, c);
      return std::hypot(a, b) + std::abs(c) > 1.0 - kAligned;
    }

    static void turned(const double* about, double angle, const double* v, double* out) noexcept {
      double side[3];
      cross(about, v, side);
      const double along = dot(about, v), c = std::cos(angle), s = std::sin(angle);
      for (int r = 0; r < 3; ++r) out[r] = c * v[r] + s * side[r] + (1.0 - c) * along * about[r];
    }

    // Joint j moved by `by` is on its limit. Of three axes that meet, the outer one that stays is axis[still], the one that
    // turns with the arm axis[moving].
    void add_roots(int j, double by, double* ends, int& count) const noexcept {
      const int middle = j < kElbow ? 1 : 5, still = j < kElbow ? 0 : 6, moving = j < kElbow ? 2 : 4;
      double v[3], a, b, c, wanted;
      if (j == middle) {  // the outer axes make the angle that they make there
        turned(axis[j], j < kElbow ? by : -by, axis[moving], v);
        wanted = dot(axis[still], v);
        harmonic(axis[still], axis[moving], a, b, c);
      } else if (j == still) {  // the middle axis stays, at its angle with the one that turns
        turned(axis[j], j < kElbow ? by : -by, axis[middle], v);
        wanted = dot(axis[middle], axis[moving]);
        harmonic(v, axis[moving], a, b, c);
      } else {  // the middle axis turns with the arm, at its angle with the one that stays
        turned(axis[j], j < kElbow ? -by : by, axis[middle], v);
        wanted = dot(axis[middle], axis[still]);
        harmonic(axis[still], v, a, b, c);
      }
      const double size = std::hypot(a, b), at = std::atan2(b, a);
      if (!(std::abs(wanted - c) <= size)) return;
      const double half = std::acos((wanted - c) / size);
      ends[count++] = wrapped(at + half);
      ends[count++] = wrapped(at - half);
    }

    static double wrapped(double angle) noexcept { return angle - kTurn * std::nearbyint(angle / kTurn); }
  };

  // Runs of cells between ends in the middle of which a lane is inside.
  static void collect(const Eigen::Isometry3d& pose, const JointBounds<Arm>& bounds, const double* ends, int count,
                      typename Arm::Intervals& out) noexcept {
    bool open[Sample::kLanes] = {}, any = false;
    double start[Sample::kLanes];
    out.count = 0;
    out.complete = true;
    for (int k = 0; k + 1 < count; ++k) {
      if (ends[k + 1] - ends[k] < 1e-12) continue;
      const Sample s(pose, 0.5 * (ends[k] + ends[k + 1]), bounds);
      for (int l = 0; l < Arm::kLanes; ++l) {
        any = any || s.real[l];
        const bool inside = s.inside(l);
        if (inside && !open[l]) start[l] = ends[k];
        if (!inside && open[l]) add(start[l], ends[k], l, out);
        open[l] = inside;
      }
    }
    for (int l = 0; l < Arm::kLanes; ++l)
      if (open[l]) add(start[l], ends[count - 1], l, out);
    std::sort(out.intervals.data(), out.intervals.data() + out.count, [](const auto& a, const auto& b) noexcept {
      return a.branch < b.branch || (a.branch == b.branch && a.low < b.low);
    });
    SelfMotionFinder<Arm>::number(out);
    out.status = out.count > 0 ? Arm::Status::Ok : any ? Arm::Status::Limits : Arm::Status::Unreachable;
  }

  static void add(double low, double high, int lane, typename Arm::Intervals& out) noexcept {
    if (out.count == Arm::kMaxIntervals) {
      out.complete = false;
      return;
    }
    out.intervals.data()[out.count++] = {low, high, lane};
  }
};

}  // namespace ikgen_runtime
