// A solver's functions as Python calls them: plain arrays in, NumPy arrays out.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <memory>
#include <string_view>
#include <utility>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <Eigen/Geometry>

#include "array_arguments.hpp"

namespace native {

using Array = nb::ndarray<nb::numpy, double>;
using Flags = nb::ndarray<nb::numpy, bool>;
// Arguments that __init__.py has made plain arrays.
using Rows = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;
using Pose = nb::ndarray<const double, nb::shape<4, 4>, nb::c_contig, nb::device::cpu>;
using Poses = nb::ndarray<const double, nb::shape<-1, 4, 4>, nb::c_contig, nb::device::cpu>;
using Targets = std::vector<Eigen::Isometry3d, Eigen::aligned_allocator<Eigen::Isometry3d>>;

inline Eigen::Isometry3d pose_at(const double* entries) noexcept {
  Eigen::Isometry3d out;
  for (int r = 0; r < 4; ++r)
    for (int c = 0; c < 4; ++c) out.matrix().data()[4 * c + r] = entries[4 * r + c];
  return out;
}

inline Targets targets_of(const Poses& poses) {
  Targets out(poses.shape(0));
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = pose_at(poses.data() + 16 * i);
  return out;
}

// An array of numbers that it owns.
template <class T> nb::ndarray<nb::numpy, T> own(std::unique_ptr<T[]> data, std::initializer_list<std::size_t> shape) {
  T* numbers = data.get();
  const nb::capsule owner(numbers, [](void* p) noexcept { delete[] static_cast<T*>(p); });
  data.release();
  return nb::ndarray<nb::numpy, T>(numbers, shape, owner);
}

template <class T> std::unique_ptr<T[]> numbers(std::size_t count) { return std::unique_ptr<T[]>(new T[count + 1]); }

// A column-major matrix by rows.
template <class M> void by_rows(const M& m, std::size_t rows, std::size_t columns, double* out) noexcept {
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < columns; ++c) out[r * columns + c] = m.data()[c * rows + r];
}

// Arm: types, constants and functions of the solver's header; kFreeNames, null where nothing is held. Members that an arm has
// not are not to be named in the module.
template <class Arm> struct SolverBinding {
  using Joints = typename Arm::Joints;
  using Solutions = typename Arm::Solutions;
  using Options = typename Arm::Options;
  using Start = nb::ndarray<const double, nb::shape<Arm::kDof>, nb::c_contig, nb::device::cpu>;
  static constexpr std::size_t kDof = Arm::kDof, kFree = Arm::kFree, kMost = Arm::kMaxSolutions;
  static_assert(sizeof(Joints) == kDof * sizeof(double), "rows lie one behind the other");

  // None where an argument is not plain.
  static nb::object solve(nb::handle pose, nb::handle free, nb::handle seed, nb::handle limits, nb::handle project) {
    Eigen::Isometry3d target;
    Options options;
    Joints nearby;
    options.limits = truth(limits);
    options.project = truth(project);
    if (!read_pose(pose, target)) return nb::none();
    if (!seed.is_none()) {
      if (!read_row(seed, nearby.data(), kDof)) return nb::none();
      options.seed = &nearby;
    }
    if (!free.is_none() && !read_free(free, Arm::kFreeNames, options.free)) return nb::none();
    if constexpr (kFree > 0) options.hold_seed = free.is_none();
    return nb::cast(Arm::solve(target, options));
  }

  static nb::tuple solve_batch(const Poses& poses, const Rows& held, const Rows& seeds, bool limits) {
    const Targets targets = targets_of(poses);
    const std::size_t n = targets.size();
    Batch batch(n);
    {
      nb::gil_scoped_release unlocked;
      run_batch(targets, held, seeds, limits, batch);
    }
    return nb::make_tuple(own(std::move(batch.q), {n, kMost, kDof}), own(std::move(batch.count), {n}),
                          own(std::move(batch.status), {n}));
  }

  // The seed: a row, or none.
  static Solutions search(const Pose& pose, const Rows& seed, const char* prefer, bool limits) {
    using Prefer = typename Arm::Prefer;
    const std::string_view word = prefer;
    const Joints nearby = seed.shape(0) ? joints_at(seed.data()) : Joints();
    typename Arm::SearchOptions options;
    options.seed = seed.shape(0) ? &nearby : nullptr;
    options.prefer = word == "near" ? Prefer::Near : word == "centre" ? Prefer::Centre : Prefer::Dexterous;
    options.limits = limits;
    const Eigen::Isometry3d target = pose_at(pose.data());
    nb::gil_scoped_release unlocked;
    return Arm::search(target, options);
  }

  static nb::tuple follow(const Poses& poses, const Start& start, bool limits) {
    const Targets targets = targets_of(poses);
    const std::size_t n = targets.size();
    const Joints from = joints_at(start.data());
    std::vector<Joints> rows(n);
    auto flags = numbers<bool>(n);
    auto q = numbers<double>(n * kDof);
    std::fill_n(flags.get(), n, false);
    std::fill_n(q.get(), n * kDof, std::numeric_limits<double>::quiet_NaN());
    typename Arm::Path path;
    {
      nb::gil_scoped_release unlocked;
      path = Arm::follow(targets.data(), static_cast<std::ptrdiff_t>(n), from, rows.data(), limits, flags.get());
    }
    const auto reached = static_cast<std::size_t>(path.reached);
    std::fill(flags.get() + reached, flags.get() + n, false);
    for (std::size_t i = 0; i < reached; ++i) std::copy_n(rows[i].data(), kDof, q.get() + i * kDof);
    return nb::make_tuple(own(std::move(q), {n, kDof}), reached, static_cast<int>(path.status), own(std::move(flags), {n}));
  }

  static nb::list self_motion(const Pose& pose, bool limits) {
    const Eigen::Isometry3d target = pose_at(pose.data());
    typename Arm::SelfMotion found;
    {
      nb::gil_scoped_release unlocked;
      found = Arm::self_motion(target, limits);
    }
    nb::list out;
    for (const auto& one : found) out.append(nb::make_tuple(one.low, one.high, one.branch));
    return out;
  }

  // Of one row, if it is plain.
  static nb::object forward(nb::handle q) { return map_row(q, 4, 4, &write_tip); }
  static nb::object jacobian(nb::handle q) { return map_row(q, 6, kDof, &write_jacobian); }

  static Array rows_forward(const Rows& q) { return map_joints(q, 4, 4, &write_tip); }
  static Array rows_jacobian(const Rows& q) { return map_joints(q, 6, kDof, &write_jacobian); }
  static Array arm_angle(const Rows& q) {
    return map_joints(q, 1, 1, [](const Joints& at, double* out) { *out = Arm::arm_angle(at); });
  }

  // Views of what was found, which they keep alive.
  static Array rows_of(nb::handle self) {
    auto& found = nb::cast<Solutions&>(self);
    return Array(found.q.data()->data(), {found.size(), kDof}, self);
  }
  static Flags flags_of(nb::handle self) {
    auto& found = nb::cast<Solutions&>(self);
    return Flags(found.singular.data(), {found.size()}, self);
  }
  static Array offs_of(nb::handle self) {
    auto& found = nb::cast<Solutions&>(self);
    return Array(found.off.data()->data(), {found.size(), 2}, self);
  }
  static int status_of(const Solutions& found) { return static_cast<int>(found.status); }
  static int count_of(const Solutions& found) { return found.count; }

 private:
  struct Batch {
    std::unique_ptr<double[]> q;
    std::unique_ptr<std::int64_t[]> count, status;

    explicit Batch(std::size_t n)
        : q(numbers<double>(n * kMost * kDof)), count(numbers<std::int64_t>(n)), status(numbers<std::int64_t>(n)) {}

    void put(std::size_t i, const Solutions& found) const noexcept {
      double* row = q.get() + i * kMost * kDof;
      const std::size_t used = found.size() * kDof;
      if (used) std::copy_n(found.q.data()->data(), used, row);
      std::fill(row + used, row + kMost * kDof, std::numeric_limits<double>::quiet_NaN());
      count[i] = found.count;
      status[i] = static_cast<int>(found.status);
    }
  };

  static Joints joints_at(const double* values) noexcept {
    Joints out;
    std::copy_n(values, kDof, out.data());
    return out;
  }

  // Held values and seeds: none, one for all poses, or one each.
  static void run_batch(const Targets& poses, const Rows& held, const Rows& seeds, bool limits, const Batch& out) noexcept {
    constexpr std::size_t kChunk = 64;
    std::array<Solutions, kChunk> found;
    const std::size_t n = poses.size();
    const bool each = held.shape(0) > 1 || seeds.shape(0) > 1;
    Options options;
    Joints nearby;
    options.limits = limits;
    if constexpr (kFree > 0) options.hold_seed = !held.shape(0);
    if (seeds.shape(0)) options.seed = &nearby;
    for (std::size_t i = 0; i < n;) {
      if (seeds.shape(0)) nearby = joints_at(seeds.data() + (seeds.shape(0) > 1 ? i * kDof : 0));
      if (held.shape(0)) std::copy_n(held.data() + (held.shape(0) > 1 ? i * kFree : 0), kFree, options.free.data());
      const std::size_t part = each ? 1 : std::min(kChunk, n - i);
      if (each) {
        found.front() = Arm::solve(poses[i], options);
      } else {
        Arm::solve_batch(poses.data() + i, static_cast<std::ptrdiff_t>(part), found.data(), options);
      }
      for (std::size_t k = 0; k < part; ++k) out.put(i + k, found[k]);
      i += part;
    }
  }

  // `rows` x `columns` numbers of each of the rows of joint values.
  template <class F> static Array map_joints(const Rows& q, std::size_t rows, std::size_t columns, const F& f) {
    const std::size_t count = q.shape(0);
    auto out = numbers<double>(count * rows * columns);
    for (std::size_t i = 0; i < count; ++i) f(joints_at(q.data() + i * kDof), out.get() + i * rows * columns);
    return own(std::move(out), {count, rows, columns});
  }

  template <class F> static nb::object map_row(nb::handle q, std::size_t rows, std::size_t columns, const F& f) {
    Joints at;
    if (!read_row(q, at.data(), kDof)) return nb::none();
    auto out = numbers<double>(rows * columns);
    f(at, out.get());
    return nb::cast(own(std::move(out), {rows, columns}));
  }

  static void write_tip(const Joints& q, double* out) noexcept { by_rows(Arm::forward(q).matrix(), 4, 4, out); }
  static void write_jacobian(const Joints& q, double* out) noexcept { by_rows(Arm::jacobian(q), 6, kDof, out); }
};

}  // namespace native
