// Solutions on what is a surface of the geometry that was solved, and none of the file's: where two directions hardly move
// the pose, as those of the joints that turn a tool about its own tip. The others take the pose's error away but for as many
// directions (as in near_continuum.hpp); Newton steps of what is left, along the surface, lead to where that vanishes.
#pragma once

#include "rows/singular_value.hpp"
#include "rows/row_pair.hpp"
#include "singular/fold_pair.hpp"

namespace ikgen_runtime {

// Arm: as for FoldPair, SingularValue and RowPair.
template <class Arm> struct NearSurface {
  using Fold = FoldPair<Arm>;
  using Policy = typename Arm::Policy;
  static constexpr int kRoom = 32;

  int count = 0;  // solutions, nearly, no two of them alike
  double found[kRoom][Arm::kDof];

  explicit NearSurface(const HeldAim<Arm>& goal) noexcept : aim(goal) {}

  // Adds those that steps lead to from a configuration that lies on one, of the first few from places all around as well.
  void search(const double* q) noexcept {
    if constexpr (kMoving > 2) {
      if (!SingularValue<Arm>::below(q, kFlat * Policy::kBrokenReach)) return;
      Sample first;
      std::copy_n(q, Arm::kDof, first.q);
      find_plane(PoseError<Arm>(q, aim), first);
      if (!(first.flow < kFlat * Policy::kBrokenReach)) return;
      int turning[2];
      find_turning(first, turning);
      const int places = searched++ < kWide ? kPlaces : 1;
      for (int i = 0; i < places * places; ++i) {
        Sample s = first;
        s.q[turning[0]] += Arm::kPeriod[turning[0]] / kPlaces * (i / kPlaces);
        s.q[turning[1]] += Arm::kPeriod[turning[1]] / kPlaces * (i % kPlaces);
        if (i > 0) find_plane(PoseError<Arm>(s.q, aim), s);
        settle(s);
        descend(s);
      }
    }
  }

 private:
  static constexpr auto kJoints = Fold::kJoints;
  static constexpr int kMoving = Fold::kMoving, kEquations = Fold::kEquations;
  static constexpr int kWide = 4, kPlaces = 4;  // starts around which others are taken, and how many to a turn
  static constexpr int kSteps = 40, kCorrections = 6;
  static constexpr double kFlat = 0.15;  // of where a continuum is followed: farther off the closed form's rows tell all
  static constexpr double kFar = 0.4, kNear = 1e-7;  // rad or m
  static constexpr double kProgress = Policy::kProgress * Policy::kProgress;  // of what is left, squared
  static constexpr double kDamping = 1e-3, kStiffer = 10.0, kLeast = 1e-4;  // of how much what is left grows, squared
  static constexpr double kRoundOff = 1e-30, kSolved = Policy::kArrived * Policy::kArrived;  // of a squared error
  using Vector = typename Fold::Vector;

  HeldAim<Arm> aim;
  int searched = 0;

  // A configuration on the surface, if `on` is set, and two unit directions in it at right angles; the most that one of
  // them moves the pose. What is left of the error there, squared, and by its growth along them a Newton step's equations.
  struct Sample {
    double q[Arm::kDof], flow, left, normal[3], slope[2];
    Vector still[2];
    bool on;
  };

  // Makes directions units at right angles.
  static void straighten(Vector (&still)[2]) noexcept {
    for (int i = 0; i < 2; ++i) {
      const double along = i == 0 ? 0.0 : Fold::dot(still[0], still[1]);
      for (int k = 0; k < kMoving && i > 0; ++k) still[1][k] -= along * still[0][k];
      make_unit(still[i]);
    }
  }

  // The two directions that move the pose least, by inverse iteration.
  static void find_plane(const PoseError<Arm>& at, Sample& s) noexcept {
    double N[kMoving][kMoving];
    Fold::factor_normal(at, N);
    for (int k = 0; k < kMoving; ++k) {
      s.still[0][k] = 1.0 + 0.1 * k;
      s.still[1][k] = k % 2 == 0 ? 1.0 : -0.5;
    }
    for (int i = 0; i < 4; ++i) {
      for (Vector& v : s.still) substitute(N, v);
      straighten(s.still);
    }
    s.flow = 0.0;
    for (const Vector& v : s.still) {
      double square = 0.0;
      for (int e = 0; e < kEquations; ++e) {
        const double x = Fold::flow_of(at, e, v);
        square += x * x;
      }
      s.flow = std::max(s.flow, std::sqrt(square));
    }
  }

  // Two joints whose values tell places of the surface apart: that which it moves most, and what it moves most beside.
  static void find_turning(const Sample& s, int (&turning)[2]) noexcept {
    int first = 0, second = 0;
    double most = -1.0;
    for (int a = 0; a < kMoving; ++a)
      for (int b = 0; b < a; ++b) {
        const bool turn = Arm::kPeriod[kJoints[a]] > 0.0 && Arm::kPeriod[kJoints[b]] > 0.0;
        const double area = std::abs(s.still[0][a] * s.still[1][b] - s.still[0][b] * s.still[1][a]);
        if (!(turn && area > most)) continue;
        most = area;
        first = a;
        second = b;
      }
    turning[0] = kJoints[first];
    turning[1] = kJoints[second];
  }

  // Goes onto the surface, by steps across its directions, which turn to where less moves the pose.
  void settle(Sample& s) const noexcept {
    s.on = false;
    for (int i = 0; i < kCorrections && !s.on; ++i) {
      const PoseError<Arm> at(s.q, aim);
      const auto others = Fold::template split<2>(at, s.still);
      const typename Fold::Taken taken(others, at.error, others.flow[0], others.flow[1]);
      double farthest = 0.0;
      for (int k = 0; k < kMoving; ++k) {
        s.q[kJoints[k]] += std::min(std::max(taken.going[k][0], -kFar), kFar);
        farthest = std::max(farthest, std::abs(taken.going[k][0]));
        for (int j = 0; j < 2; ++j) s.still[j][k] -= taken.going[k][1 + j];
      }
      straighten(s.still);
      s.on = farthest < kNear;
      s.left = s.normal[0] = s.normal[1] = s.normal[2] = s.slope[0] = s.slope[1] = 0.0;
      for (const auto& row : taken.rest) {
        s.left += row[0] * row[0];
        s.normal[0] += row[1] * row[1];
        s.normal[1] += row[1] * row[2];
        s.normal[2] += row[2] * row[2];
        s.slope[0] += row[1] * row[0];
        s.slope[1] += row[2] * row[0];
      }
    }
  }

  // Damped Newton steps along the surface (Marquardt 1963), to where nothing is left or a few leave hardly less.
  void descend(Sample& now) noexcept {
    if (!now.on) return;
    int stalled = 0;
    double damping = kDamping * (now.normal[0] + now.normal[2]);
    for (int i = 0; i < kSteps && now.left > kRoundOff && stalled < Policy::kPatience && !known(now); ++i) {
      const double a = now.normal[0] + damping, b = now.normal[1], c = now.normal[2] + damping;
      const double determinant = std::max(a * c - b * b, 1e-300);
      double x = (c * now.slope[0] - b * now.slope[1]) / determinant;
      double y = (a * now.slope[1] - b * now.slope[0]) / determinant;
      const double length = std::sqrt(x * x + y * y), share = length > kFar ? kFar / length : 1.0;
      x *= share;
      y *= share;
      Sample next = now;
      for (int k = 0; k < kMoving; ++k) next.q[kJoints[k]] += x * now.still[0][k] + y * now.still[1][k];
      settle(next);
      const bool better = next.on && next.left < now.left;
      stalled = next.on && next.left < kProgress * now.left ? 0 : stalled + 1;
      damping = better ? damping / kStiffer : std::max(kStiffer * damping, kLeast * (now.normal[0] + now.normal[2]));
      if (better) now = next;
    }
    if (now.left < kSolved && !known(now) && count < kRoom) std::copy_n(now.q, Arm::kDof, found[count++]);
  }

  // Whether one is next to a solution that was found.
  bool known(const Sample& s) const noexcept {
    bool some = false;
    for (int k = 0; k < count && !some && s.left < kSolved; ++k) some = RowPair<Arm>::within(Policy::kNeighbouring, s.q, found[k]);
    return some;
  }
};

}  // namespace ikgen_runtime
