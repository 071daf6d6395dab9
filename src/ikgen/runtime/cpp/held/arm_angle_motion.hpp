// Intervals of the arm angle in closed form from the joint limits (Shimizu et al. 2008). What the shoulder's joints carry
// turns with the arm angle about the line from shoulder to wrist: a joint is on a limit where an axis that turns so
// makes a given angle with one that stays, at no more than two arm angles.
#pragma once

#include "held/arm_angle.hpp"
#include "held/self_motion.hpp"

namespace ikgen_runtime {

// Arm: as for BranchFollower and ElbowPlane, with seven revolute joints, of exact geometry.
template <class Arm> struct BranchMotion<Arm, true> {
  using Sample = HeldSample<Arm>;
  static constexpr int kElbow = 3, kMost = 2 * 2 * 2 * Arm::kDof;
  static constexpr double kStretched = 1e-4;  // distance of the elbow from the line, over the upper arm
  static constexpr double kAligned = 1e-9;    // 1 less the cosine between the outer axes of shoulder or wrist

  // Passes a sample of each of Record::kCells cells. Where joints come to a singularity on the way the branches
  // are followed: samples tell more there.
  template <class Record> static bool follow(const HeldSweep<Arm>& sweep, Record& record) noexcept {
    double ends[kMost + Record::kCells + 1];
    int count = 0;
    if (!find_ends(sweep, ends, count)) return BranchMotion<Arm, false>::follow(sweep, record);
    for (int k = 0; k <= Record::kCells; ++k) ends[count++] = sweep.low + (sweep.high - sweep.low) * k / Record::kCells;
    std::sort(ends, ends + count);
    return tell(sweep, ends, count, record);
  }

 private:
  static bool find_ends(const HeldSweep<Arm>& sweep, double* ends, int& count) noexcept {
    const Sample at = sweep.at(0.0);
    for (int l = 0; l < at.lanes; ++l) {
      bool seen = !at.real[l];
      for (int k = 0; k < l; ++k) seen = seen || (at.real[k] && std::abs(at.q[kElbow][k] - at.q[kElbow][l]) < 1e-6);
      if (seen) continue;
      double q[Arm::kDof];
      at.row(l, q);
      if (count + 4 * Arm::kDof > kMost || !Turn(sweep.pose, q).add_ends(sweep.bounds, ends, count)) return false;
    }
    return true;
  }

  // The axes of a row at arm angle 0, and the line.
  struct Turn {
    double axis[Arm::kDof][3], line[3], q[Arm::kDof];
    bool stretched;

    Turn(const Eigen::Isometry3d& pose, const double* row) noexcept {
      std::copy_n(row, Arm::kDof, q);
      double J[6][Arm::kDof];
      MotionChain<Arm>::forward(q, J);
      for (int j = 0; j < Arm::kDof; ++j)
        for (int r = 0; r < 3; ++r) axis[j][r] = J[3 + r][j];
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
          const double limit = bounds.middle[i] + side * (bounds.half[i] + 0.5 * Arm::Policy::kLimitTolerance);
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
      if (!(size > 0.0 && std::abs(wanted - c) <= size)) return;
      const double half = std::acos((wanted - c) / size);
      ends[count++] = shortest(at + half);
      ends[count++] = shortest(at - half);
    }
  };

  // Runs of cells between ends in the middle of which a lane is inside; whether there are rows.
  template <class Record>
  static bool tell(const HeldSweep<Arm>& sweep, const double* ends, int count, Record& record) noexcept {
    bool open[Sample::kLanes] = {}, any = false;
    for (int k = 0; k + 1 < count; ++k) {
      if (ends[k + 1] - ends[k] < 1e-12) continue;
      const Sample s = sweep.at(0.5 * (ends[k] + ends[k + 1]));
      bool changes = false;
      for (int l = 0; l < Arm::kLanes; ++l) {
        any = any || s.real[l];
        changes = changes || s.inside(l) != open[l];
      }
      if (changes) {
        const Sample cut = sweep.at(ends[k]);
        for (int l = 0; l < Arm::kLanes; ++l) {
          double q[Arm::kDof];
          cut.row(l, q);
          if (s.inside(l) && !open[l]) record.open(l, ends[k], q, l, false);
          if (!s.inside(l) && open[l]) record.close(l, ends[k], q, false);
        }
      }
      for (int l = 0; l < Arm::kLanes; ++l) {
        open[l] = s.inside(l);
        if (open[l]) record.pass(l, s);
      }
    }
    const Sample last = sweep.at(sweep.high);
    for (int l = 0; l < Arm::kLanes; ++l) {
      double q[Arm::kDof];
      last.row(l, q);
      if (open[l]) record.close(l, sweep.high, q, false);
    }
    return any;
  }
};

}  // namespace ikgen_runtime
