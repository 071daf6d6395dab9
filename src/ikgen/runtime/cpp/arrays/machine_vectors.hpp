// One machine vector of doubles, and what the language has no operators for, or no good ones, on it.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#if defined(__AVX__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace ikgen_runtime {

#if defined(__AVX512F__)
inline constexpr int kNative = 8;
#elif defined(__AVX__)
inline constexpr int kNative = 4;
#elif defined(__GNUC__)
inline constexpr int kNative = 2;
#else
inline constexpr int kNative = 1;
#endif

template <int N> struct Machine {
#if defined(__GNUC__)
  typedef double Vector __attribute__((vector_size(8 * N)));
  typedef std::int64_t Flags __attribute__((vector_size(8 * N)));
#endif
};
template <> struct Machine<1> {
  using Vector = double;
  using Flags = bool;
};

[[gnu::always_inline]] inline double root(double x) noexcept { return std::sqrt(x); }
template <class V> [[gnu::always_inline]] inline V larger(V x, V y) noexcept { return x > y ? x : y; }
template <class V> [[gnu::always_inline]] inline V smaller(V x, V y) noexcept { return x > y ? y : x; }
template <class V> [[gnu::always_inline]] inline auto above(V x, V y) noexcept { return x > y; }
template <class F, class V> [[gnu::always_inline]] inline V chosen(F flags, V x, V y) noexcept { return flags ? x : y; }
[[gnu::always_inline]] inline bool inverted(bool flags) noexcept { return !flags; }
template <class F> [[gnu::always_inline]] inline F inverted(F flags) noexcept { return ~flags; }
[[gnu::always_inline]] inline bool none(bool flags) noexcept { return !flags; }
template <class F> [[gnu::always_inline]] inline bool none(F flags) noexcept {
  std::int64_t any = 0;
  for (std::size_t i = 0; i < sizeof(F) / sizeof(any); ++i) any |= flags[i];
  return any == 0;
}
#if defined(__SSE2__)
using Vector2 = Machine<2>::Vector;
using Flags2 = Machine<2>::Flags;
[[gnu::always_inline]] inline Vector2 root(Vector2 x) noexcept { return _mm_sqrt_pd(x); }
[[gnu::always_inline]] inline Vector2 larger(Vector2 x, Vector2 y) noexcept { return _mm_max_pd(x, y); }
[[gnu::always_inline]] inline Vector2 smaller(Vector2 x, Vector2 y) noexcept { return _mm_min_pd(x, y); }
[[gnu::always_inline]] inline Flags2 above(Vector2 x, Vector2 y) noexcept {
  return reinterpret_cast<Flags2>(_mm_cmpgt_pd(x, y));
}
[[gnu::always_inline]] inline Vector2 chosen(Flags2 flags, Vector2 x, Vector2 y) noexcept {
  return reinterpret_cast<Vector2>((flags & reinterpret_cast<Flags2>(x)) | (~flags & reinterpret_cast<Flags2>(y)));
}
#elif defined(__GNUC__)
[[gnu::always_inline]] inline Machine<2>::Vector root(Machine<2>::Vector x) noexcept {
  return {std::sqrt(x[0]), std::sqrt(x[1])};
}
#endif
#if defined(__AVX__)
using Vector4 = Machine<4>::Vector;
using Flags4 = Machine<4>::Flags;
[[gnu::always_inline]] inline Vector4 root(Vector4 x) noexcept { return _mm256_sqrt_pd(x); }
[[gnu::always_inline]] inline Vector4 larger(Vector4 x, Vector4 y) noexcept { return _mm256_max_pd(x, y); }
[[gnu::always_inline]] inline Vector4 smaller(Vector4 x, Vector4 y) noexcept { return _mm256_min_pd(x, y); }
[[gnu::always_inline]] inline Flags4 above(Vector4 x, Vector4 y) noexcept {
  return reinterpret_cast<Flags4>(_mm256_cmp_pd(x, y, _CMP_GT_OQ));
}
[[gnu::always_inline]] inline Vector4 chosen(Flags4 flags, Vector4 x, Vector4 y) noexcept {
  return _mm256_blendv_pd(y, x, reinterpret_cast<Vector4>(flags));
}
#endif
#if defined(__AVX512F__)
using Vector8 = Machine<8>::Vector;
[[gnu::always_inline]] inline Vector8 root(Vector8 x) noexcept { return _mm512_maskz_sqrt_pd(0xFF, x); }
#endif

}  // namespace ikgen_runtime
