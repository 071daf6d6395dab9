#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#if defined(__AVX__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace ikgen_runtime {

inline constexpr double kPi = 3.14159265358979323846;

// --- lanes: the branches of the solution side by side ---------------------------------------------
// A pack holds N doubles, N a power of two, in one machine vector, or as two halves where it is wider.
// An operation on packs of different widths repeats the narrower one.

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

template <int N, bool Halved> struct LanesOf;
template <int N> using Lanes = LanesOf<N, (N > kNative)>;
template <int N> struct LanesOf<N, false> { typename Machine<N>::Vector v; };
template <int N> struct LanesOf<N, true> { Lanes<N / 2> lo, hi; };

template <int N, bool Halved> struct MaskOf;
template <int N> using Mask = MaskOf<N, (N > kNative)>;
template <int N> struct MaskOf<N, false> { typename Machine<N>::Flags v; };
template <int N> struct MaskOf<N, true> { Mask<N / 2> lo, hi; };

template <class T> inline constexpr int kWidth = 0;
template <> inline constexpr int kWidth<double> = 1;
template <int N, bool H> inline constexpr int kWidth<LanesOf<N, H>> = N;
template <int N, bool H> inline constexpr int kWidth<MaskOf<N, H>> = N;

// Width of an operation on packs, or on a pack and a number.
template <class A, class B, class = std::enable_if_t<(kWidth<A> > 0 && kWidth<B> > 0) &&
                                                     (std::is_class_v<A> || std::is_class_v<B>)>>
inline constexpr int kCommon = kWidth<A> > kWidth<B> ? kWidth<A> : kWidth<B>;

// What the language has no operators for, or no good ones, on one machine vector.
[[gnu::always_inline]] inline double root(double x) noexcept { return std::sqrt(x); }
template <class V> [[gnu::always_inline]] inline V larger(V x, V y) noexcept { return x > y ? x : y; }
template <class V> [[gnu::always_inline]] inline V smaller(V x, V y) noexcept { return x > y ? y : x; }
template <class V> [[gnu::always_inline]] inline auto above(V x, V y) noexcept { return x > y; }
template <class F, class V> [[gnu::always_inline]] inline V chosen(F flags, V x, V y) noexcept { return flags ? x : y; }
[[gnu::always_inline]] inline bool inverted(bool flags) noexcept { return !flags; }
template <class F> [[gnu::always_inline]] inline F inverted(F flags) noexcept { return ~flags; }
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
[[gnu::always_inline]] inline Machine<2>::Vector root(Machine<2>::Vector x) noexcept { return {std::sqrt(x[0]), std::sqrt(x[1])}; }
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

// f applied to each machine vector of the packs.
template <class R, class F, class A, class... B>
[[gnu::always_inline]] inline R each(const F& f, const A& a, const B&... b) noexcept {
  if constexpr (kWidth<A> > kNative) {
    using Half = decltype(R::lo);
    return {each<Half>(f, a.lo, b.lo...), each<Half>(f, a.hi, b.hi...)};
  } else {
    return {f(a.v, b.v...)};
  }
}

// (x, x): a machine vector twice as long.
template <class Twice, class V> [[gnu::always_inline]] inline Twice doubled(const V& x) noexcept {
#if defined(__clang__) || __GNUC__ >= 12
  if constexpr (sizeof(Twice) == 32) return __builtin_shufflevector(x, x, 0, 1, 0, 1);
  if constexpr (sizeof(Twice) == 64) return __builtin_shufflevector(x, x, 0, 1, 2, 3, 0, 1, 2, 3);
#endif
  Twice out;
  std::memcpy(&out, &x, sizeof(x));
  std::memcpy(reinterpret_cast<char*>(&out) + sizeof(x), &x, sizeof(x));
  return out;
}

template <int N> [[gnu::always_inline]] inline Lanes<N> spread(double x) noexcept {
  if constexpr (N > kNative) {
    return {spread<N / 2>(x), spread<N / 2>(x)};
  } else if constexpr (N > 1) {
    return {x - typename Machine<N>::Vector{}};
  } else {
    return {x};
  }
}

template <int N, int M, bool H> [[gnu::always_inline]] inline Lanes<N> spread(const LanesOf<M, H>& x) noexcept {
  if constexpr (N == M) {
    return x;
  } else if constexpr (N > kNative) {
    return {spread<N / 2>(x), spread<N / 2>(x)};
  } else if constexpr (M == 1) {
    return spread<N>(x.v);
  } else {
    return {doubled<typename Machine<N>::Vector>(spread<N / 2>(x).v)};
  }
}

template <int N, int M, bool H> [[gnu::always_inline]] inline Mask<N> spread(const MaskOf<M, H>& x) noexcept {
  if constexpr (N == M) {
    return x;
  } else if constexpr (N > kNative) {
    return {spread<N / 2>(x), spread<N / 2>(x)};
  } else if constexpr (M == 1) {
    return {typename Machine<N>::Flags{} - (x.v ? 1 : 0)};
  } else {
    return {doubled<typename Machine<N>::Flags>(spread<N / 2>(x).v)};
  }
}

// +1 in the first half of the lanes, -1 in the second: the two branches of a level.
template <int N> [[gnu::always_inline]] inline Lanes<N> signs() noexcept {
  if constexpr (N > kNative) {
    return {spread<N / 2>(1.0), spread<N / 2>(-1.0)};
  } else {
    typename Machine<N>::Vector v{};
    for (int i = 0; i < N; ++i) v[i] = i < N / 2 ? 1.0 : -1.0;
    return {v};
  }
}

template <class A, class B, int N = kCommon<A, B>>
[[gnu::always_inline]] inline Lanes<N> operator+(const A& a, const B& b) noexcept {
  return each<Lanes<N>>([](auto x, auto y) { return x + y; }, spread<N>(a), spread<N>(b));
}
template <class A, class B, int N = kCommon<A, B>>
[[gnu::always_inline]] inline Lanes<N> operator-(const A& a, const B& b) noexcept {
  return each<Lanes<N>>([](auto x, auto y) { return x - y; }, spread<N>(a), spread<N>(b));
}
template <class A, class B, int N = kCommon<A, B>>
[[gnu::always_inline]] inline Lanes<N> operator*(const A& a, const B& b) noexcept {
  return each<Lanes<N>>([](auto x, auto y) { return x * y; }, spread<N>(a), spread<N>(b));
}
template <class A, class B, int N = kCommon<A, B>>
[[gnu::always_inline]] inline Lanes<N> operator/(const A& a, const B& b) noexcept {
  return each<Lanes<N>>([](auto x, auto y) { return x / y; }, spread<N>(a), spread<N>(b));
}
template <class A, class B, int N = kCommon<A, B>>
[[gnu::always_inline]] inline Mask<N> operator>(const A& a, const B& b) noexcept {
  return each<Mask<N>>([](auto x, auto y) { return above(x, y); }, spread<N>(a), spread<N>(b));
}
template <class A, class B, int N = kCommon<A, B>>
[[gnu::always_inline]] inline Mask<N> operator&(const A& a, const B& b) noexcept {
  return each<Mask<N>>([](auto x, auto y) -> decltype(x) { return x & y; }, spread<N>(a), spread<N>(b));
}
template <class A, class B, int N = kCommon<A, B>>
[[gnu::always_inline]] inline Mask<N> operator|(const A& a, const B& b) noexcept {
  return each<Mask<N>>([](auto x, auto y) -> decltype(x) { return x | y; }, spread<N>(a), spread<N>(b));
}
template <int N, bool H> [[gnu::always_inline]] inline Mask<N> operator!(const MaskOf<N, H>& a) noexcept {
  return each<Mask<N>>([](auto x) { return inverted(x); }, a);
}
template <int N, bool H> [[gnu::always_inline]] inline Lanes<N> operator-(const LanesOf<N, H>& a) noexcept {
  return each<Lanes<N>>([](auto x) { return -x; }, a);
}

template <int M, bool H, class A, class B>
[[gnu::always_inline]] inline auto select(const MaskOf<M, H>& m, const A& a, const B& b) noexcept {
  constexpr int K = kWidth<A> > kWidth<B> ? kWidth<A> : kWidth<B>;
  constexpr int N = M > K ? M : K;
  const auto choose = [](auto flags, auto x, auto y) { return chosen(flags, x, y); };
  return each<Lanes<N>>(choose, spread<N>(m), spread<N>(a), spread<N>(b));
}
template <class A, class B, int N = kCommon<A, B>>
[[gnu::always_inline]] inline Lanes<N> max(const A& a, const B& b) noexcept {
  return each<Lanes<N>>([](auto x, auto y) { return larger(x, y); }, spread<N>(a), spread<N>(b));
}
template <class A, class B, int N = kCommon<A, B>>
[[gnu::always_inline]] inline Lanes<N> min(const A& a, const B& b) noexcept {
  return each<Lanes<N>>([](auto x, auto y) { return smaller(x, y); }, spread<N>(a), spread<N>(b));
}
template <int N, bool H> [[gnu::always_inline]] inline Lanes<N> abs(const LanesOf<N, H>& a) noexcept {
  return max(a, -a);
}

// Square root; 0 below 0.
template <int N, bool H> [[gnu::always_inline]] inline Lanes<N> sqrt(const LanesOf<N, H>& a) noexcept {
  return each<Lanes<N>>([](auto x) { return root(x); }, max(a, 0.0));
}

template <int N, bool H> [[gnu::always_inline]] inline void store(const LanesOf<N, H>& a, double* out) noexcept {
  if constexpr (H) {
    store(a.lo, out);
    store(a.hi, out + N / 2);
  } else {
    std::memcpy(out, &a.v, sizeof(a.v));
  }
}
template <int N> [[gnu::always_inline]] inline Lanes<N> load(const double* in) noexcept {
  if constexpr (N > kNative) {
    return {load<N / 2>(in), load<N / 2>(in + N / 2)};
  } else {
    Lanes<N> out;
    std::memcpy(&out.v, in, sizeof(out.v));
    return out;
  }
}
// 1 where the flag is set, else 0.
template <int N, bool H> [[gnu::always_inline]] inline void store(const MaskOf<N, H>& a, double* out) noexcept {
  store(select(a, 1.0, 0.0), out);
}

// Angle of the vector (x, y) in (-pi, pi], to 3e-16: reduced to |t| <= tan(pi/8), then a polynomial that
// is within 6e-17 of the arctangent there. Not defined where both are 0.
template <class Y, class X, int N = kCommon<Y, X>>
[[gnu::always_inline]] inline Lanes<N> angle(const Y& narrow_y, const X& narrow_x) noexcept {
  const Lanes<N> y = spread<N>(narrow_y), x = spread<N>(narrow_x);
  const auto ax = abs(x), ay = abs(y);
  const auto steep = ay > ax;
  const auto small = min(ax, ay), large = max(ax, ay);
  const auto high = small > 0.41421356237309503 * large;
  const auto t = select(high, small - large, small) / select(high, small + large, large);
  const auto z = t * t;
  const auto z2 = z * z;
  const auto z4 = z2 * z2;
  const auto low = (-0.3333333333333325 + 0.19999999999898324 * z) + z2 * (-0.1428571426608229 + 0.11111109635603796 * z);
  const auto mid = (-0.09090852527088297 + 0.07691054614825647 * z) + z2 * (-0.06649607953399717 + 0.057362969593526145 * z);
  const auto top = -0.04483218628995374 + 0.022748939747779046 * z;
  const auto first = (t + t * z * (low + z4 * (mid + z4 * top))) + select(high, kPi / 4, 0.0);
  const auto second = select(steep, kPi / 2 - first, first);
  const auto third = select(0.0 > x, kPi - second, second);
  return select(-1.2e-16 * ax > y, -third, third);  // an angle that rounds to -pi is pi
}

}  // namespace ikgen_runtime
