#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "elimination/general_6r_candidate.hpp"
#include "elimination/general_6r_spectrum.hpp"

namespace ikgen_runtime {

// --- general_6r: runs of eliminations until one finds all that is known --------------------------------

namespace elimination {

inline constexpr double kFarthest = 1e4;  // of a slide, in arm lengths: beyond are those that become parallel

inline constexpr double kSettled = 1e-14;  // error that undamped steps leave, and damped ones where solutions do not meet
inline constexpr double kStalled = 1e-6;  // error where more than two solutions meet: steps get no closer soon

// Adds a candidate of a run if it can be refined; one that is far off shows that the run's roots are not all sharp.
template <class Frames>
inline void add_refined(const Frames& F, const Frame& T, const Turning& turning, Vector q, Spectrum& roots,
                        Solutions& out) noexcept {
  const double before = residual(F, T, q.data(), turning).worst;
  double farthest = 0.0, after = refine_one(F, T, turning, q);
  const bool stalls = after >= kVerified && after < kStalled;
  if (after > kSettled && after < kStalled) after = refine_along(F, T, turning, q);
  for (Index i = 0; i < 6; ++i) farthest = std::max(farthest, turning[i] ? 0.0 : std::abs(q[i]));
  if (farthest < kFarthest && after < kVerified) keep(solution_of(turning, q), out);
  if (farthest < kFarthest && stalls) roots.stalled = true;
  if (!(before <= 1e-5)) roots.simple = false;
}

// A rotation of about so much, and as much of a translation: where right angles make solutions coincide in
// the hidden angle, they come apart at the pose displaced by it, and Newton's method takes them back.
inline Frame displacement(double by) noexcept {
  const double c = std::cos(0.9 * by), s = std::sin(0.9 * by);  // about z
  const double d = std::cos(1.1 * by), e = std::sin(1.1 * by);  // about x
  const Frame out = {{{c, -s * d, s * e}, {s, c * d, -c * e}, {0.0, e, d}}, {0.8 * by, -1.1 * by, 0.6 * by}};
  return out;
}

// How far displaced poses are off. Farther off what more than two solutions that meet become is not real, or far from
// them, but regular ones come apart of which more than two share the hidden angle; closer by an elimination that has no
// rank at the pose leaves no digits.
inline constexpr double kAside[] = {1e-3, 0.03, 1e-6, 1e-8};

// How many of the first rows there are, and whether solutions meet in any. There steps end at few digits, and rows that
// lie close together count as one.
struct Apart {
  int count = 0;
  bool meet = false;
};
template <class Frames>
inline Apart count_apart(const Frames& F, const Frame& T, const Turning& turning, const Solutions& rows, int first) noexcept {
  constexpr double meets = 1e-6, close = 1e-3;  // of the smallest singular value, and rad or arm lengths
  std::array<bool, std::size_t{kRoom}> folds{};
  Apart out;
  for (int k = 0; k < first; ++k) {
    const double* row = rows.rows[static_cast<Index>(k)].q;
    double square = 0.0;
    for (const double e : still_of(residual(F, T, row, turning)).flow) square += e * e;
    bool fresh = folds[static_cast<Index>(k)] = square < meets * meets;
    out.meet = out.meet || fresh;
    for (int i = 0; i < k && fresh; ++i)
      fresh = !(folds[static_cast<Index>(i)] && coincident(row, rows.rows[static_cast<Index>(i)].q, close));
    out.count += fresh || !folds[static_cast<Index>(k)] ? 1 : 0;
  }
  return out;
}

// Whether a run found all that was known, the first so many rows, and no more, where solutions meet.
template <class Frames>
inline bool same_apart(const Frames& F, const Frame& T, const Turning& turning, const Solutions& mine,
                       const Solutions& all, int known) noexcept {
  const Apart now = count_apart(F, T, turning, all, all.count);
  return now.meet && count_apart(F, T, turning, mine, mine.count).count == now.count &&
         count_apart(F, T, turning, all, known).count == now.count;
}

inline constexpr int kSure = 3;  // runs that have to find none where there is none: to both sides, by the next elimination

// Adds all solutions of a pose to those that are known: Run(F, T, aim, turning, plan, found) gives those of a plan,
// with the roots of the pose `aim` beside. One run of the first plan is enough where its roots are real, as many as
// solutions, and each a solution to many digits. Otherwise more runs follow, with the pose displaced to either side, by
// the next elimination and with the pose displaced by less, until one finds all that is known and no more, an even number,
// none of it stalls near another, and one of the pose itself tells; where solutions meet the next elimination has to find
// as many that lie apart, as one alone may miss the same of a crowd twice, and so where there are fewer than the first had
// roots that may be real, or than a displaced pose has: what solutions have in common may be what it hides, and what is
// singular its roots. False where there may be more than was found: no run settles it; or where there may be some though
// none was found: an elimination of the pose itself lost its rank, or has roots, real ones or some that may be.
template <auto Run, class Frames, std::size_t N>
inline bool solve_in_runs(const Frames& F, const Frame& T, const Turning& turning,
                          const std::array<std::array<int, 3>, N>& plans, Solutions& out) noexcept {
  const int given = out.count;
  int least = -1, perhaps = 0, number = 0;
  bool ranked = true, doubtful = false;  // no elimination of the pose itself lost its rank; one has roots in doubt
  for (const double by : kAside) {
    const Frame there = displacement(by), back = inverse(there);
    for (const std::array<int, 3>& plan : plans)
      for (const Frame* shift : {static_cast<const Frame*>(nullptr), &there, &back}) {
        if (!shift && by != kAside[0]) continue;  // known by now
        Solutions mine;
        const Frame aim = shift ? compose(T, *shift) : T;
        const Spectrum roots = Run(F, T, aim, turning, plan, mine);
        if (!shift) {
          least = std::max(least, roots.real);
          perhaps = std::max(perhaps, roots.perhaps);
          ranked = ranked && roots.real >= 0;
        }
        doubtful = doubtful || (shift ? roots.real > 0 : roots.doubtful);
        const int known = out.count;
        for (int k = 0; k < mine.count; ++k) keep(mine.rows[static_cast<Index>(k)], out);
        if (out.count == kRoom) return true;  // of a continuum
        const bool alone = number == 0 && given <= mine.count && roots.simple && out.count == roots.real && out.count > 0;
        const bool even = out.count % 2 == 0, again = number > 0 && !roots.stalled;
        const bool others = number > 2;  // the next elimination's runs have begun
        const bool beside = shift && !others && out.count < roots.real;  // has roots that may be of more
        const bool told = !beside && (out.count >= perhaps || others || N == 1);
        const bool repeated = again && told && even && mine.count == known && out.count == known;
        const bool enough = least >= 0 && out.count >= least;
        const bool none = out.count == 0, fewer = none && (doubtful || number < kSure);
        if (enough && ((alone && even) || repeated) && !fewer) return !none || ranked;
        if (enough && again && others && same_apart(F, T, turning, mine, out, known)) return true;
        ++number;
      }
  }
  return out.count == 0 && ranked && least == 0 && !doubtful;
}

}  // namespace elimination
}  // namespace ikgen_runtime
