#pragma once

#include <cmath>
#include <limits>

namespace ikgen_runtime {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kTurn = 2.0 * kPi;
inline constexpr double kFarthestSeed = 1e6;  // rad: neighbouring doubles are 1e-10 apart
inline constexpr double kFarthest = 1e15;  // m: where neighbouring doubles are 0.1 m apart; no arm reaches beyond
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

// An angle without its whole turns, or a gap between two on the shortest way: from -pi to pi.
inline double without_turns(double x, double turn = kTurn) noexcept { return x - turn * std::nearbyint(x / turn); }

}  // namespace ikgen_runtime
