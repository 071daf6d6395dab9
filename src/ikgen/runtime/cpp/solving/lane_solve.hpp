// All rows of a few poses at once, refined if the closed form is of another geometry than the file; poses with rows
// that need care go one by one.
#pragma once

#include "solving/careful_solve.hpp"
#include "solving/compensated_rows.hpp"
#include "rows/lane_placement.hpp"
#include "rows/row_sums.hpp"

namespace ikgen_runtime {

// Arm: as for CarefulSolve; kFarLimits, whether limits leave no room within half a period of 0; kNewton, whether all rows
// are to be refined, then refine<P>.
template <class Arm> struct LaneSolve {
  static constexpr int kBatch = kNative > 2 ? kNative / 2 : 1;  // poses at once
  using Options = typename Arm::Options;
  using Solutions = typename Arm::Solutions;
  using Row = SolutionRows<Arm>;
  template <int P> using Rows = typename Arm::template Rows<P>;

  template <int P> static void solve(const Eigen::Isometry3d* poses, const Options& options, Solutions* out) noexcept {
    const bool bounded = options.limits && !place_later(options);
    const Pose<P> pose = gather<P>(poses);
    const Range range = bounded ? kLimits : kAnywhere;
    Rows<P> rows;
    if constexpr (Arm::kNewton) {
      Arm::branches(pose, typename Arm::Seed(), options.free, kAnywhere, rows);
      Arm::refine(pose, options.free, range, rows);
    } else {
      Arm::branches(pose, typename Arm::Seed(), options.free, range, rows);
    }
    if (place_later(options)) LanePlacement<Arm>::apply(options, rows);
    double sums[std::size_t{Rows<P>::kLanes}] = {};
    if constexpr (Arm::kNewton) RowSums<Arm>::take(rows, sums);
    for (int p = 0; p < P; ++p)
      if (!collect(rows, sums, p, options, out[p])) fall_back(poses[p], options, out[p]);
  }

 private:
  static constexpr Range kLimits = {Arm::kLower.data(), Arm::kUpper.data()};
  static constexpr Range kAnywhere = {kUnbounded<Arm::kDof>.lower, kUnbounded<Arm::kDof>.upper};

  // Few poses need it: small code, quickly compiled.
  [[gnu::cold, gnu::noinline]] static void fall_back(const Eigen::Isometry3d& pose, const Options& options,
                                                     Solutions& out) noexcept {
    RowPlaces<Arm> found;
    if constexpr (Arm::kRounded)
      if (compensate(pose, options, found, out)) return;
    CarefulSolve<Arm>::solve(pose, options, found, out);
  }

  // Whether compensated rows are all that there are, and the limits leave some where a seed may lead to others; else those that
  // are found.
  static bool compensate(const Eigen::Isometry3d& pose, const Options& options, RowPlaces<Arm>& found,
                         Solutions& out) noexcept {
    const HeldAim<Arm> aim(pose, options.free);
    if (!CompensatedRows<Arm>(aim, options).find(found)) return false;
    LimitRows<Arm>::place_all(aim, options, found);
    if (found.count == 0 && options.seed) return false;
    CarefulSolve<Arm>::answer(options, true, found, out);
    return true;
  }

  // Whether rows are placed once they are all found.
  static bool place_later(const Options& options) noexcept { return Arm::kFarLimits || options.seed != nullptr; }

  static void leave_distinct(Solutions& out) noexcept {
    const int count = out.count;
    out.count = 0;
    for (int k = 0; k < count; ++k) {
      double q[Arm::kDof];
      std::copy_n(Row::row(out, k), Arm::kDof, q);
      Row::add(out, q, false);
    }
  }

  // Whether limits leave out a row of pose p that meets another: rounding moves it farther than what is put back.
  template <int P> static bool leaves_out_meeting(const Rows<P>& rows, int p) noexcept {
    bool some = false;
    for (const int row : Arm::kLaneOfRow)
      some = some || (rows.bits(row * P + p) & (kFound | kMeeting)) == kMeeting;
    return some;
  }

  // Copies the found rows of pose p. Whether that is all there is to it: every row is a regular one. sums: RowSums.
  template <int P>
  static bool collect(const Rows<P>& rows, [[maybe_unused]] const double* sums, int p, const Options& options,
                      Solutions& out) noexcept {
    int count = 0, seen = 0;
    bool doubt = false;  // whether rows may have others near them
    [[maybe_unused]] double sum[Arm::kMaxSolutions + 1] = {};
    for (const int row : Arm::kLaneOfRow) {
      const int lane = row * P + p;
      const int bits = rows.bits(lane);
      double* q = Row::row(out, count);
      for (int j = 0; j < Arm::kDof; ++j) q[j] = rows.q[j][lane];
      Row::flag(out, count) = false;
      if constexpr (Arm::kNewton) sum[count] = sums[lane];
      count += bits & kFound;
      seen |= bits;
      doubt = doubt || (bits & (kReal | kDoubt)) == (kReal | kDoubt);
    }
    if (doubt || (seen & (kRough | kHit)) != 0 || (CarefulRows<Arm>::kBesideAnywhere && (seen & kReal) == 0)) return false;
    if ((seen & kMeeting) != 0 && leaves_out_meeting(rows, p)) return false;
    out.count = count;
    bool compared = (seen & kMeeting) != 0;
    if constexpr (Arm::kNewton) compared = !RowSums<Arm>::apart(sum, count);
    if (compared) {
      leave_distinct(out);
      if (Arm::kNewton && out.count < count) return false;  // another may lie there
    }
    if (options.seed) Row::sort_by_distance(out, options.seed->data());
    out.status = out.count > 0 ? Arm::Status::Ok : (seen & kReal) != 0 ? Arm::Status::Limits : Arm::Status::Unreachable;
    return out.count > 0 || !options.seed;
  }
};

}  // namespace ikgen_runtime
