#pragma once

namespace ikgen_runtime {

// A task that reads some entries of the pose, Arm::kRead; of one configuration (X: double), or of those in lanes.
template <class Arm> struct PoseEntries {
  static constexpr int kCount = sizeof(Arm::kRead) / sizeof(Arm::kRead[0]);
  static constexpr bool kPosition = Arm::kRead[0][1] == 3;  // is read

  // t: the rows of the pose; T: the tip's frame. A heading counts by where it points: that of a tool which a rounded
  // file tilts is a little shorter than 1.
  template <class X, class Tip>
  static void error(const X (&t)[3][4], const Tip& T, X* error) noexcept {
    [[maybe_unused]] const X unit = Arm::Columns::template unit<X>(T.R);
    for (int i = 0; i < kCount; ++i) {
      const auto [r, c] = Arm::kRead[i];
      if (c == 3) {
        error[i] = (t[r][3] - T.p[r]) / Arm::kSize;
      } else if constexpr (Arm::Columns::kFlat) {
        error[i] = t[r][c] - T.R[r][c] * unit;
      } else {
        error[i] = t[r][c] - T.R[r][c];
      }
    }
  }

  // J: the tip's geometric Jacobian.
  template <class X, class Tip>
  static void slope(const Tip& T, const X (&J)[6][Arm::kDof], X (*slope)[Arm::kDof]) noexcept {
    for (int i = 0; i < kCount; ++i) {
      const auto [r, c] = Arm::kRead[i];
      const int u = (r + 1) % 3, v = (r + 2) % 3;
      for (int j = 0; j < Arm::kDof; ++j) {
        if (c == 3) {
          slope[i][j] = J[r][j] / Arm::kSize;
        } else {
          slope[i][j] = J[3 + u][j] * T.R[v][c] - J[3 + v][j] * T.R[u][c];
        }
      }
    }
    if constexpr (Arm::Columns::kFlat) turn_only(T, slope);
  }

  // Leaves of a heading's slope what turns it.
  template <class X, class Tip> static void turn_only(const Tip& T, X (*slope)[Arm::kDof]) noexcept {
    for (int j = 0; j < Arm::kDof; ++j) {
      X along{};
      for (int i = 0; i < kCount; ++i)
        if (Arm::kRead[i][1] != 3) along = along + T.R[Arm::kRead[i][0]][Arm::kRead[i][1]] * slope[i][j];
      for (int i = 0; i < kCount; ++i)
        if (Arm::kRead[i][1] != 3) slope[i][j] = slope[i][j] - T.R[Arm::kRead[i][0]][Arm::kRead[i][1]] * along;
    }
  }

  // Adds to the slopes' products what no motion changes, `weight` times: the lengths of unit columns, and the products
  // of two. With more joints than the task fixes freedoms these alone would be lost everywhere.
  template <class X, class Tip> static void fill(const Tip& T, double weight, X (&S)[kCount][kCount]) noexcept {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j <= i; ++j) {
        if (!Arm::Columns::has(i) || !Arm::Columns::has(j)) continue;
        X still[kCount];
        for (int a = 0; a < kCount; ++a) {
          const auto [r, c] = Arm::kRead[a];
          still[a] = c == i ? T.R[r][j] : c == j ? T.R[r][i] : X{};
        }
        for (int a = 0; a < kCount; ++a)
          for (int b = 0; b < kCount; ++b) S[a][b] = S[a][b] + weight * still[a] * still[b];
      }
  }
};

}  // namespace ikgen_runtime
