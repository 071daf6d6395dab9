#pragma once

#include "rows/lane_rows.hpp"

namespace ikgen_runtime {

// Rows of a solve, which asks for nothing else.
template <int Dof, int Most, int P> struct SolvedRows : LaneRows<Dof, Most, P> {
  template <int K, class X> [[gnu::always_inline]] void fold(const X&) noexcept {}
};

// Rows of one pose with what is positive where they are real and 0 where two of them meet.
template <int Dof, int Most, int Folds> struct FoldRows : LaneRows<Dof, Most, 1> {
  alignas(64) double margin[Folds > 0 ? Folds : 1][Most];
  template <int K, int N, bool H> [[gnu::always_inline]] void fold(const LanesOf<N, H>& x) noexcept {
    store(spread<Most>(x), margin[K]);
  }
};

}  // namespace ikgen_runtime
