"""The binding of compiled packages over a solver written by hand: what it is asked, and what it answers."""

from __future__ import annotations

import importlib.util
import subprocess
import sysconfig
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from numpy.typing import NDArray
from tests.support.solving import NO_COMPILER

from ikgen.emit.nanobind import SOURCES
from ikgen.verify.runners.cpp_toolchain import find_compiler, find_eigen

Array = NDArray[np.float64]

CODE = r"""
#include <array>
#include <nanobind/nanobind.h>
#include <nanobind/stl/string.h>
#include "solver_binding.hpp"
namespace nb = nanobind;
using namespace nb::literals;
// Two joints, the second one held; rows tell what the solver was asked.
struct Hand {
  using Joints = Eigen::Matrix<double, 2, 1>;
  enum class Status { Ok, Unreachable, Limits };
  enum class Prefer { Near, Centre, Dexterous };
  struct Solutions {
    Status status = Status::Unreachable;
    int count = 0;
    std::array<Joints, 3> q;
    std::array<bool, 3> singular = {};
    std::array<std::array<double, 2>, 3> off = {};
    std::size_t size() const noexcept { return static_cast<std::size_t>(count); }
  };
  struct Options {
    bool limits = true, hold_seed = true, project = false;
    const Joints* seed = nullptr;
    std::array<double, 1> free = {0.25};
  };
  struct SearchOptions {
    const Joints* seed = nullptr;
    Prefer prefer = Prefer::Near;
    bool limits = true;
  };
  struct Path {
    Status status;
    int reached;
  };
  struct Interval {
    double low, high;
    int branch;
  };
  using SelfMotion = std::vector<Interval>;
  static constexpr int kDof = 2, kFree = 1, kMaxSolutions = 3;
  static constexpr const char* kNames[] = {"second"};
  static constexpr const char* const* kFreeNames = kNames;

  // As many rows as the pose's x, the first of what was asked.
  static Solutions solve(const Eigen::Isometry3d& pose, const Options& options) noexcept {
    Solutions out;
    out.count = static_cast<int>(pose(0, 3));
    out.status = out.count ? Status::Ok : Status::Limits;
    for (int k = 0; k < out.count; ++k) out.q[k] << pose(1, 3) + k, options.free[0];
    if (options.seed && out.count) out.q[out.count - 1] = *options.seed;
    out.singular[0] = options.limits;
    out.singular[1] = options.hold_seed;
    out.off[0] = {options.project ? 1.0 : 0.0, pose(0, 1)};
    return out;
  }
  using Poses = const Eigen::Isometry3d*;
  static void solve_batch(Poses poses, std::ptrdiff_t n, Solutions* out, const Options& options) noexcept {
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      out[i] = solve(poses[i], options);
      if (out[i].count > 1) out[i].q[1] << static_cast<double>(n), options.hold_seed ? 1.0 : 0.0;
    }
  }
  static Solutions search(const Eigen::Isometry3d& pose, const SearchOptions& options) noexcept {
    Solutions out;
    out.count = 1;
    out.q[0] << static_cast<double>(options.prefer) + pose(0, 3), options.seed ? (*options.seed)[1] : -1.0;
    out.singular[0] = options.limits;
    return out;
  }
  // Three poses far; flags beyond them are no answer.
  static Path follow(Poses poses, std::ptrdiff_t n, const Joints& start, Joints* out, bool limits,
                     bool* flags) {
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      out[i] << poses[i](0, 3), start[1];
      flags[i] = limits;
    }
    return {Status::Limits, n < 3 ? static_cast<int>(n) : 3};
  }
  static SelfMotion self_motion(const Eigen::Isometry3d& pose, bool limits) {
    return {{pose(0, 3), pose(1, 3), limits ? 1 : 0}, {5.0, 6.0, 7}};
  }
  static Eigen::Isometry3d forward(const Joints& q) {
    Eigen::Isometry3d out = Eigen::Isometry3d::Identity();
    out.matrix() << 1, 2, 3, q[0], 5, 6, 7, q[1], 9, 10, 11, 12, 0, 0, 0, 1;
    return out;
  }
  static Eigen::Matrix<double, 6, 2> jacobian(const Joints& q) {
    Eigen::Matrix<double, 6, 2> out;
    out << 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, q[0], q[1];
    return out;
  }
  static double arm_angle(const Joints& q) { return q[0] - q[1]; }
};
using Binding = native::SolverBinding<Hand>;
NB_MODULE(hand_binding, module) {
  nb::class_<Hand::Solutions>(module, "Found")
      .def_prop_ro("q", &Binding::rows_of)
      .def_prop_ro("singular", &Binding::flags_of)
      .def_prop_ro("off", &Binding::offs_of)
      .def_prop_ro("status", &Binding::status_of)
      .def("__len__", &Binding::count_of);
  const auto any = nb::arg().none();
  module.def("solve", &Binding::solve, any, any, any, nb::arg(), nb::arg());
  module.def("solve_batch", &Binding::solve_batch);
  module.def("search", &Binding::search);
  module.def("follow", &Binding::follow);
  module.def("self_motion", &Binding::self_motion);
  module.def("arm_angle", &Binding::arm_angle);
  module.def("forward", &Binding::forward, nb::arg().none());
  module.def("jacobian", &Binding::jacobian, nb::arg().none());
  module.def("rows_forward", &Binding::rows_forward);
  module.def("rows_jacobian", &Binding::rows_jacobian);
}
"""


@pytest.fixture(scope="module")
def binding(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    """The compiled module; warnings of the binding itself are errors."""
    if NO_COMPILER:
        pytest.skip(NO_COMPILER)
    nanobind = pytest.importorskip("nanobind")
    folder = tmp_path_factory.mktemp("binding")
    (folder / "main.cpp").write_text(CODE)
    library = Path(nanobind.source_dir())
    headers = [library.parent / "include", library.parent / "ext/robin_map/include", find_eigen()]
    includes = [f"-isystem{path}" for path in (*headers, sysconfig.get_paths()["include"])]
    built = folder / f"hand_binding{sysconfig.get_config_var('EXT_SUFFIX')}"
    common = [*find_compiler(), "-std=c++17", "-fPIC", "-fvisibility=hidden", "-w", *includes]
    library_object = folder / "nanobind.o"
    compile_ = [*common, "-c", str(library / "nb_combined.cpp"), "-o", str(library_object)]
    strict = ["-Wall", "-Wextra", "-Wshadow", "-Werror"]
    own = [one for one in common if one != "-w"] + [*strict, f"-I{SOURCES}", "-shared"]
    for command in (
        compile_,
        [*own, str(folder / "main.cpp"), str(library_object), "-o", str(built)],
    ):
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr[:4000]
    spec = importlib.util.spec_from_file_location("hand_binding", built)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def pose(x: float, y: float) -> Array:
    T = np.eye(4)
    T[:2, 3], T[0, 1] = (x, y), 0.5
    return T


NONE = np.empty((0, 2))
NO_HELD = np.empty((0, 1))


def test_a_row_has_what_was_asked_for(binding: ModuleType) -> None:
    found = binding.solve(pose(3, 7), None, None, True, True)
    assert len(found) == 3 and found.status == 0
    assert found.q.tolist() == [[7.0, 0.25], [8.0, 0.25], [9.0, 0.25]]
    assert found.singular.tolist() == [True, True, False]
    assert found.off.tolist() == [[1.0, 0.5], [0.0, 0.0], [0.0, 0.0]]
    none = binding.solve(pose(0, 7), None, None, 1, [])
    assert len(none) == 0 and none.status == 2 and none.q.shape == (0, 2)


@pytest.mark.parametrize("held", [{"second": 0.75}, [0.75], (0.75,), np.array([0.75])])
def test_held_values_stand_against_the_seeds(binding: ModuleType, held: object) -> None:
    found = binding.solve(pose(2, 7), held, np.array([3.0, 4.0]), False, False)
    assert found.q.tolist() == [[7.0, 0.75], [3.0, 4.0]]
    assert found.singular.tolist() == [False, False]


def test_what_is_not_plain_is_left_to_python(binding: ModuleType) -> None:
    good = pose(1, 0)
    bad = (
        {"third": 1.0},
        {"second": 1},
        {"second": np.nan},
        [1.0, 2.0],
        {"second": 1.0, "third": 1.0},
    )
    for held in bad:
        assert binding.solve(good, held, None, True, False) is None
    for wrong in (good[:3], good.astype(np.float32), good.tolist(), None):
        assert binding.solve(wrong, None, None, True, False) is None
    for seed in ([1.0], [1, 2], [1.0, np.inf], np.ones(3), "ab", np.ones((1, 2))):
        assert binding.solve(good, None, seed, True, False) is None
        assert binding.forward(seed) is None and binding.jacobian(seed) is None
    with pytest.raises(ValueError, match="ambiguous"):
        binding.solve(good, None, None, np.ones(2), False)


def test_views_keep_what_was_found(binding: ModuleType) -> None:
    views = [binding.solve(pose(1, k), None, None, True, False).q for k in range(200)]
    assert [view[0, 0] for view in views] == list(range(200))


def test_strides_of_poses_and_rows_are_followed(binding: ModuleType) -> None:
    turned = np.asfortranarray(pose(1, 7))
    assert binding.solve(turned, None, np.array([3.0, 0.0, 4.0])[::2], True, False).q.tolist() == [
        [3.0, 4.0]
    ]
    assert binding.solve(turned[::-1][::-1], None, None, True, False).off.tolist() == [[0.0, 0.5]]


def test_batches_hold_the_same_or_each_its_own(binding: ModuleType) -> None:
    """Where each pose has its own it is solved alone: its second row then is no batch's."""
    poses = np.array([pose(k % 4, k) for k in range(130)])
    chunks = [64.0] * 64 + [64.0] * 64 + [2.0] * 2
    for held, seeds, kept in ((NO_HELD, NONE, 1.0), (np.array([[0.5]]), NONE, 0.0)):
        q, count, status = binding.solve_batch(poses, held, seeds, True)
        assert q.shape == (130, 3, 2) and count.dtype == status.dtype == np.int64
        np.testing.assert_array_equal(count, np.arange(130) % 4)
        np.testing.assert_array_equal(status, np.where(count == 0, 2, 0))
        for k, rows in enumerate(q):
            assert np.isnan(rows[count[k] :]).all() and not np.isnan(rows[: count[k]]).any()
            assert count[k] < 1 or rows[0].tolist() == [k, 0.5 if len(held) else 0.25]
            assert count[k] < 2 or rows[1].tolist() == [chunks[k], kept]
    each = np.arange(130.0)[:, None]
    q, count, _ = binding.solve_batch(poses, each, np.array([[3.0, 4.0]]), True)
    assert (q[count == 3, 0, 1] == each[count == 3, 0]).all()
    assert (q[count == 3, 2] == [3.0, 4.0]).all()
    q, count, _ = binding.solve_batch(poses, np.array([[0.5]]), np.hstack([each, -each]), False)
    assert (q[count == 2, 1, 1] == -each[count == 2, 0]).all()
    q, count, status = binding.solve_batch(poses[:0], NO_HELD, NONE, True)
    assert q.shape == (0, 3, 2) and len(count) == len(status) == 0


def test_searches_paths_and_intervals(binding: ModuleType) -> None:
    for place, word in enumerate(("near", "centre", "dexterous")):
        found = binding.search(pose(10, 0), np.array([[3.0, 4.0]]), word, bool(place))
        assert found.q.tolist() == [[10.0 + place, 4.0]] and found.singular[0] == bool(place)
    assert binding.search(pose(10, 0), NONE, "near", True).q.tolist() == [[10.0, -1.0]]
    poses = np.array([pose(k, 0) for k in range(5)])
    q, reached, status, flags = binding.follow(poses, np.array([0.0, 9.0]), True)
    assert (reached, status) == (3, 2) and flags.tolist() == [True] * 3 + [False] * 2
    np.testing.assert_array_equal(q[:3], [[0.0, 9.0], [1.0, 9.0], [2.0, 9.0]])
    assert q.shape == (5, 2) and np.isnan(q[3:]).all()
    with pytest.raises(TypeError):
        binding.follow(poses, np.zeros(3), True)
    assert binding.self_motion(pose(1, 2), True) == [(1.0, 2.0, 1), (5.0, 6.0, 7)]


def test_matrices_come_by_rows(binding: ModuleType) -> None:
    rows = np.array([[0.5, -0.5], [0.25, 8.0]])
    tips, slopes = binding.rows_forward(rows), binding.rows_jacobian(rows)
    assert tips.shape == (2, 4, 4) and slopes.shape == (2, 6, 2)
    for k, q in enumerate(rows):
        expected = [[1, 2, 3, q[0]], [5, 6, 7, q[1]], [9, 10, 11, 12], [0, 0, 0, 1]]
        np.testing.assert_array_equal(tips[k], expected)
        np.testing.assert_array_equal(binding.forward(q), expected)
        assert slopes[k].ravel().tolist() == [*map(float, range(1, 11)), *q]
        np.testing.assert_array_equal(binding.jacobian(q.tolist()), slopes[k])
    assert binding.arm_angle(rows).tolist() == [[[1.0]], [[-7.75]]]
    assert binding.rows_forward(NONE).shape == (0, 4, 4)
