#pragma once

#include "elimination/general_6r_equations.hpp"
#include "arrays/reflections.hpp"

namespace ikgen_runtime {

// --- general_6r: the resultant at many angles side by side ------------------------------------------
// A(theta_3) is the 6x9 matrix of the equations. Its null space has an orthonormal basis (N0; Nc; Ns), 3x3 each;
// a solution is a vector y with Nc y = c4 N0 y and Ns y = s4 N0 y, which by half angles is
//   [[Nc - N0, Ns], [Ns, -(Nc + N0)]] (cos(theta_4/2) y; sin(theta_4/2) y) = 0.
// f = det(A A^T) det [...] depends on the basis not even in sign: a trigonometric polynomial of degree 8 whose
// roots are all solutions' theta_3. Householder's reflections instead of pivoting: no lane waits for another.

namespace elimination {

inline constexpr int kWide = 8;  // lanes, on narrower machines as several vectors, which do not wait for each other
using Wide = Lanes<kWide>;
using WideMask = Mask<kWide>;

#if defined(__AVX512F__) && defined(__AVX512DQ__)
inline unsigned bits(const Mask<8>& m) noexcept { return _mm512_movepi64_mask(reinterpret_cast<__m512i>(m.v)); }
#elif defined(__AVX__)
inline unsigned bits(const Mask<4>& m) noexcept {
  return static_cast<unsigned>(_mm256_movemask_pd(reinterpret_cast<__m256d>(m.v)));
}
#elif defined(__SSE2__)
inline unsigned bits(const Mask<2>& m) noexcept {
  return static_cast<unsigned>(_mm_movemask_pd(reinterpret_cast<__m128d>(m.v)));
}
#endif
// One bit a lane.
template <int N, bool H>
inline unsigned bits(const MaskOf<N, H>& m) noexcept {
  if constexpr (H) {
    return bits(m.lo) | bits(m.hi) << (N / 2);
  } else {
    double flags[N];
    store(m, flags);
    unsigned out = 0;
    for (int l = 0; l < N; ++l) out |= flags[l] > 0.5 ? 1U << l : 0U;
    return out;
  }
}

using WideReflected = Reflected<Wide>;

inline bool any(const WideMask& mask) noexcept { return bits(mask) != 0; }

// R rows of N entries, in G groups of lanes. All groups take each step before any takes the next, and a row is
// reflected as soon as the next step needs it: nothing waits long for square roots.
template <int K, int G, int R, int N>
inline void reflectors(int groups, Wide (&A)[G][R][N], WideReflected (&h)[G][R]) noexcept {
  for (int g = 0; g < groups; ++g) h[g][K] = reflector<K>(A[g][K]);
}

// Rows K.. of A to lower triangular form, but for the last L rows.
template <int K, int L, int G, int R, int N>
inline void triangulate(int groups, Wide (&A)[G][R][N], WideReflected (&h)[G][R]) noexcept {
  if constexpr (K == 0) reflectors<0>(groups, A, h);
  if constexpr (K + 1 < R)
    for (int g = 0; g < groups; ++g) reflect<K>(A[g][K], h[g][K].beta, A[g][K + 1]);
  if constexpr (K + 1 < R - L) reflectors<K + 1>(groups, A, h);
  for (int g = 0; g < groups; ++g)
    for (int i = K + 2; i < R; ++i) reflect<K>(A[g][K], h[g][K].beta, A[g][i]);
  if constexpr (K + 1 < R - L) triangulate<K + 1, L>(groups, A, h);
}

template <int K, int G>
inline void carry_back(int groups, const Wide (&A)[G][6][9], const WideReflected (&h)[G][6],
                       Wide (&basis)[G][3][9]) noexcept {
  for (int g = 0; g < groups; ++g)
    for (auto& n : basis[g]) reflect<K>(A[g][K], h[g][K].beta, n);
  if constexpr (K > 0) carry_back<K - 1>(groups, A, h, basis);
}

inline void fill(const Pencil& p, const Wide& c, const Wide& s, Wide (&A)[6][9]) noexcept {
  for (Index i = 0; i < 6; ++i)
    for (Index j = 0; j < 9; ++j) A[i][j] = p.f(i, j) + c * p.c(i, j) + s * p.s(i, j);
}

// Orthonormal null vectors, and what triangulate says of A's rows, which it makes triangular.
template <int G>
inline void null_bases(int groups, Wide (&A)[G][6][9], Wide (&basis)[G][3][9], WideReflected (&h)[G][6]) noexcept {
  triangulate<0, 0>(groups, A, h);
  for (int g = 0; g < groups; ++g)
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 9; ++j) basis[g][k][j] = spread<kWide>(j == 6 + k ? 1.0 : 0.0);
  carry_back<5>(groups, A, h, basis);
}

// The 6x6 matrix of half angles, by rows.
template <int N>
inline void half_angles(const Wide (&basis)[3][9], Wide (&K)[6][N]) noexcept {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      K[i][j] = basis[j][3 + i] - basis[j][i];
      K[i][3 + j] = K[3 + i][j] = basis[j][6 + i];
      K[3 + i][3 + j] = -(basis[j][3 + i] + basis[j][i]);
    }
}

}  // namespace elimination
}  // namespace ikgen_runtime
