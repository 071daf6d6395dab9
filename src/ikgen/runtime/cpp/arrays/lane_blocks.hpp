#pragma once

#include "arrays/lanes.hpp"

namespace ikgen_runtime {

// The solution of V d = e in lanes, 6 x 6, by elimination of 3 x 3 blocks: those of the last three columns and rows first.
template <int N> struct LaneBlocks {
  using Pack = Lanes<N>;
  Pack V[6][6];
  Pack pivot;  // how far a column of a block is at least from the span of its others

  [[gnu::always_inline]] void factor() noexcept {
    Pack block[3][3], most = spread<N>(0.0);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) block[i][j] = V[3 + i][3 + j];
    invert(block, last, most);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) share[i][j] = last[i][0] * V[3][j] + last[i][1] * V[4][j] + last[i][2] * V[5][j];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        block[i][j] = V[i][j] - (V[i][3] * share[0][j] + V[i][4] * share[1][j] + V[i][5] * share[2][j]);
    invert(block, first, most);
    pivot = 1.0 / sqrt(most);
  }

  // d, which takes all of e away.
  [[gnu::always_inline]] void solve(Pack (&e)[6], Pack (&d)[6]) const noexcept {
    Pack y[3], r[3];
    for (int i = 0; i < 3; ++i) y[i] = last[i][0] * e[3] + last[i][1] * e[4] + last[i][2] * e[5];
    for (int i = 0; i < 3; ++i) r[i] = e[i] - (V[i][3] * y[0] + V[i][4] * y[1] + V[i][5] * y[2]);
    for (int i = 0; i < 3; ++i) d[i] = first[i][0] * r[0] + first[i][1] * r[1] + first[i][2] * r[2];
    for (int i = 0; i < 3; ++i) d[3 + i] = y[i] - (share[i][0] * d[0] + share[i][1] * d[1] + share[i][2] * d[2]);
    for (Pack& x : e) x = spread<N>(0.0);
  }

 private:
  // The inverses of the block and of what its elimination leaves, and how its columns share in the others.
  Pack last[3][3], first[3][3], share[3][3];

  // By cofactors; most: the largest square of a row's length so far.
  [[gnu::always_inline]] static void invert(const Pack (&A)[3][3], Pack (&out)[3][3], Pack& most) noexcept {
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      for (int r = 0; r < 3; ++r) {
        const int s = (r + 1) % 3, t = (r + 2) % 3;
        out[i][r] = A[s][j] * A[t][k] - A[t][j] * A[s][k];
      }
    }
    const Pack inverse = 1.0 / (A[0][0] * out[0][0] + A[1][0] * out[0][1] + A[2][0] * out[0][2]);
    for (int i = 0; i < 3; ++i) {
      for (int r = 0; r < 3; ++r) out[i][r] = out[i][r] * inverse;
      most = max(most, out[i][0] * out[i][0] + out[i][1] * out[i][1] + out[i][2] * out[i][2]);
    }
  }
};

}  // namespace ikgen_runtime
