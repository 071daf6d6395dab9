// Packs of N doubles, N a power of two, in one machine vector, or as two halves where it is wider. An operation
// on packs of different widths repeats the narrower one.
#pragma once

#include <cstring>
#include <type_traits>

#include "arrays/machine_vectors.hpp"

namespace ikgen_runtime {

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

// A number, or a pack that has it in every lane.
template <class X> [[gnu::always_inline]] inline X constant(double x) noexcept {
  if constexpr (std::is_same_v<X, double>) {
    return x;
  } else {
    return spread<kWidth<X>>(x);
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

#define IKGEN_LANES_OPERATION(Pack, name, value) \
  template <class A, class B, int N = kCommon<A, B>> \
  [[gnu::always_inline]] inline Pack<N> name(const A& a, const B& b) noexcept { \
    return each<Pack<N>>([](auto x, auto y) { return value; }, spread<N>(a), spread<N>(b)); \
  }
IKGEN_LANES_OPERATION(Lanes, operator+, x + y)
IKGEN_LANES_OPERATION(Lanes, operator-, x - y)
IKGEN_LANES_OPERATION(Lanes, operator*, x * y)
IKGEN_LANES_OPERATION(Lanes, operator/, x / y)
IKGEN_LANES_OPERATION(Lanes, max, larger(x, y))
IKGEN_LANES_OPERATION(Lanes, min, smaller(x, y))
IKGEN_LANES_OPERATION(Mask, operator>, above(x, y))
IKGEN_LANES_OPERATION(Mask, operator&, static_cast<decltype(x)>(x & y))
IKGEN_LANES_OPERATION(Mask, operator|, static_cast<decltype(x)>(x | y))
#undef IKGEN_LANES_OPERATION
template <int N, bool H> [[gnu::always_inline]] inline Mask<N> operator!(const MaskOf<N, H>& a) noexcept {
  return each<Mask<N>>([](auto x) { return inverted(x); }, a);
}
// Whether the flag is set in every lane.
template <int N, bool H> [[gnu::always_inline]] inline bool all(const MaskOf<N, H>& a) noexcept {
  if constexpr (H) {
    return all(a.lo) && all(a.hi);
  } else {
    return none(inverted(a.v));
  }
}
template <int N, bool H> [[gnu::always_inline]] inline Lanes<N> operator-(const LanesOf<N, H>& a) noexcept {
  return each<Lanes<N>>([](auto x) { return -x; }, a);
}

[[gnu::always_inline]] inline double select(bool which, double a, double b) noexcept { return which ? a : b; }
template <int M, bool H, class A, class B>
[[gnu::always_inline]] inline auto select(const MaskOf<M, H>& m, const A& a, const B& b) noexcept {
  constexpr int K = kWidth<A> > kWidth<B> ? kWidth<A> : kWidth<B>;
  constexpr int N = M > K ? M : K;
  const auto choose = [](auto flags, auto x, auto y) { return chosen(flags, x, y); };
  return each<Lanes<N>>(choose, spread<N>(m), spread<N>(a), spread<N>(b));
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

}  // namespace ikgen_runtime
