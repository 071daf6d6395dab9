"""The C++ runner, with a hand-written planar arm that obeys the header's contract."""

from __future__ import annotations

import dataclasses
import os
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.support.fake_arms import tree_of
from tests.support.waiting_program import assert_ended, compiler_of, script_of, wait_until_started

from ikgen.errors import BadDescriptionError, MissingToolError, VerificationError
from ikgen.verify.oracle import PinocchioOracle
from ikgen.verify.runners import cpp_header, cpp_toolchain
from ikgen.verify.runners.cpp_header import CppHeader
from ikgen.verify.runners.runner import ArmConstants
from ikgen.verify.verification import verify

URDF = """<robot name="p"><link name="b"/><link name="l1"/><link name="l2"/><link name="tip"/>
<joint name="j1" type="continuous"><parent link="b"/><child link="l1"/><axis xyz="0 0 1"/></joint>
<joint name="j2" type="revolute"><parent link="l1"/><child link="l2"/><origin xyz="0.5 0 0"/>
  <axis xyz="0 0 1"/><limit lower="-1.5" upper="2.5" effort="1" velocity="1"/></joint>
<joint name="end" type="fixed"><parent link="l2"/><child link="tip"/><origin xyz="0.3 0 0"/></joint>
</robot>"""

HEADER = r"""
#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <utility>
namespace planar_ik {
inline constexpr int kDof = 2, kFree = 0, kMaxSolutions = 2;
using Joints = Eigen::Matrix<double, kDof, 1>;
enum class Status { Ok, Unreachable, Limits, Invalid, Singular };
struct Solutions {
  Status status = Status::Ok;
  int count = 0;
  std::array<Joints, kMaxSolutions> q;
  std::array<bool, kMaxSolutions> singular{};
};
struct Options {
  bool limits = true;
  const Joints* seed = nullptr;
  std::array<double, kFree> free{};
};
inline Eigen::Isometry3d forward(const Joints& q) noexcept {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.rotate(Eigen::AngleAxisd(q[0], Eigen::Vector3d::UnitZ()));
  T.translate(Eigen::Vector3d(0.5, 0, 0));
  T.rotate(Eigen::AngleAxisd(q[1], Eigen::Vector3d::UnitZ()));
  T.translate(Eigen::Vector3d(0.3, 0, 0));
  return T;
}
inline Eigen::Matrix<double, 6, kDof> jacobian(const Joints& q) noexcept {
  Eigen::Matrix<double, 6, kDof> J = Eigen::Matrix<double, 6, kDof>::Zero();
  const double c1 = std::cos(q[0]), s1 = std::sin(q[0]);
  const double c = 0.3 * std::cos(q[0] + q[1]), s = 0.3 * std::sin(q[0] + q[1]);
  J.col(0) << -0.5 * s1 - s, 0.5 * c1 + c, 0, 0, 0, 1;
  J.col(1) << -s, c, 0, 0, 0, 1;
  return J;
}
inline Solutions solve(const Eigen::Isometry3d& pose, const Options& options = {}) noexcept {
  Solutions out;
  const Eigen::Vector3d p = pose.translation();
  if (!p.allFinite()) { out.status = Status::Invalid; return out; }
  double c = (p.x() * p.x() + p.y() * p.y() - 0.34) / 0.3;
  if (std::abs(p.z()) > 1e-9 || std::abs(c) > 1 + 1e-9) {
    out.status = Status::Unreachable;
    return out;
  }
  c = std::fmin(1.0, std::fmax(-1.0, c));
  for (double sign : {1.0, -1.0}) {
    const double q2 = sign * std::acos(c);
    const double q1 = std::remainder(std::atan2(p.y(), p.x()) -
        std::atan2(0.3 * std::sin(q2), 0.5 + 0.3 * std::cos(q2)), 2 * 3.14159265358979323846);
    if (sign < 0 && std::abs(q2) < 1e-6) continue;
    if (options.limits && (q2 < -1.5 - 1e-9 || q2 > 2.5 + 1e-9)) continue;
    out.q[out.count++] = Joints(q1, q2);
  }
  if (!out.count) out.status = Status::Limits;
  if (options.seed && out.count == 2 &&
      (out.q[1] - *options.seed).norm() < (out.q[0] - *options.seed).norm())
    std::swap(out.q[0], out.q[1]);
  return out;
}
}
"""

MOTIONS = r"""
namespace planar_ik {
struct Path { Status status = Status::Ok; std::ptrdiff_t reached = 0; };
struct SearchOptions { const Joints* seed = nullptr; };
inline Solutions search(const Eigen::Isometry3d& pose, const SearchOptions& options) noexcept {
  Options near;
  near.seed = options.seed;
  return solve(pose, near);
}
inline Path follow(const Eigen::Isometry3d* poses, std::ptrdiff_t count, const Joints& start,
                   Joints* q, bool, bool* singular) noexcept {
  Path path;
  Joints last = start;
  for (; path.reached < count; ++path.reached) {
    Solutions all = solve(poses[path.reached]);
    const auto way = [&](const Joints& one) {
      const double turn = std::remainder(one[0] - last[0], 2 * 3.14159265358979323846);
      return std::abs(turn) + std::abs(one[1] - last[1]);
    };
    if (all.count == 2 && way(all.q[1]) < way(all.q[0])) std::swap(all.q[0], all.q[1]);
    q[path.reached] = last = all.q[0];
    singular[path.reached] = false;
  }
  return path;
}
}
"""

INTERVALS = r"""
namespace planar_ik {
struct Interval { double low, high; int branch; };
struct SelfMotion {
  int count = 2;
  std::array<Interval, 3> intervals;
  const Interval* begin() const noexcept { return intervals.data(); }
  const Interval* end() const noexcept { return intervals.data() + count; }
};
inline SelfMotion self_motion(const Eigen::Isometry3d& pose) noexcept {
  return {2, {{{-1.0, pose.translation().x(), 0}, {2.0, 2.5, 1}, {}}}};
}
}
"""


def oracle() -> PinocchioOracle:
    """The planar arm's oracle."""
    return PinocchioOracle(tree_of(URDF), "b", "tip", ["j1", "j2"])


def constants() -> ArmConstants:
    """The planar arm's constants, task position."""
    lower, upper = np.array([-np.inf, -1.5]), np.array([np.inf, 2.5])
    return ArmConstants(("j1", "j2"), lower, upper, "b", "tip", 0, "position")


def header(folder: Path, text: str = HEADER) -> CppHeader:
    """The header compiled."""
    path = folder / "planar_ik.hpp"
    path.write_text(text)
    try:
        made = CppHeader(path, constants())
    except MissingToolError as error:
        pytest.skip(f"{error.message}; {error.hint}")
    assert made.constants.dof == 2  # waits for the compiler
    return made


@pytest.fixture(scope="module")
def planar(tmp_path_factory: pytest.TempPathFactory) -> CppHeader:
    """The header as it is."""
    return header(tmp_path_factory.mktemp("planar"))


def test_right_header_passes(planar: CppHeader) -> None:
    assert planar.constants.max_solutions == 2
    report = verify(planar, oracle(), samples=500)
    assert report.passed, report.worst_case
    assert report.label == "cpp"
    assert report.check("unreachable poses").count == 36
    assert report.check("solve_batch").count == 0


@pytest.mark.parametrize(
    ("right", "wrong", "check"),
    [
        ("", "", ""),
        pytest.param(
            "path.reached < count", "path.reached + 1 < count", "paths", marks=pytest.mark.long
        ),
        pytest.param("= false;", "= true;", "paths", marks=pytest.mark.long),
        ("return solve(pose, near);", "return {};", "search"),
    ],
)
def test_paths_and_searches_of_headers_are_checked(
    tmp_path: Path, right: str, wrong: str, check: str
) -> None:
    report = verify(header(tmp_path, HEADER + MOTIONS.replace(right, wrong)), oracle(), samples=50)
    assert report.check("paths").count == 15 and report.check("search").count == 3
    assert {one.name for one in report.checks if one.failures} == ({check} if check else set())


def test_intervals_of_headers_are_told(tmp_path: Path) -> None:
    runner = header(tmp_path, HEADER + INTERVALS)
    assert runner.has_self_motion and not runner.moves
    pose = np.eye(4)
    pose[0, 3] = 0.25
    assert runner.self_motion(pose).tolist() == [[-1.0, 0.25], [2.0, 2.5]]


def test_header_tells_its_defaults(planar: CppHeader, tmp_path: Path) -> None:
    assert planar.constants.free_defaults is None
    text = HEADER.replace("kFree = 0", "kFree = 1").replace("free{};", "free = {2.75};")
    (tmp_path / "planar_ik.hpp").write_text(text)
    held = dataclasses.replace(constants(), free_joints=("j2",))
    runner = CppHeader(tmp_path / "planar_ik.hpp", held)
    assert runner.constants.free_defaults == (2.75,)
    report = verify(runner, oracle(), samples=20)  # the limit is 2.5
    assert "defaults of free joints" in report.check("constants").detail


CONSTANTS = """
inline constexpr const char* kBaseLink = "b";
inline constexpr const char* kTipLink = "tip";
inline constexpr std::array<const char*, kDof> kJointNames = {"j1", "j2"};
inline constexpr std::array<double, kDof> kLower = {-1.0 / 0.0, -1.5};
inline constexpr std::array<double, kDof> kUpper = {1.0 / 0.0, 2.5};
"""


def long(right: str, wrong: str, detail: str) -> Any:
    """A case that takes two seconds of compiling for one more constant."""
    return pytest.param(right, wrong, detail, marks=pytest.mark.long)


@pytest.mark.parametrize(
    ("right", "wrong", "detail"),
    [
        long("2.5}", "2.5}", ""),
        long("-1.5}", "-1.5001}", "lower limits: j2 has -1.5001, not -1.5"),
        long("2.5}", "2.4999}", "upper limits: j2 has 2.4999, not 2.5"),
        long('"b"', '"c"', "links"),
        ('{"j1", "j2"}', '{"j1", "j\u00fc"}', "joint names"),
    ],
)
def test_constants_of_a_header_are_checked(
    tmp_path: Path, right: str, wrong: str, detail: str
) -> None:
    told = CONSTANTS.replace(right, wrong)
    text = HEADER.replace("using Joints", f"{told}using Joints", 1).replace("1.0 / 0.0", "HUGE_VAL")
    check = verify(header(tmp_path, text), oracle(), samples=4).check("constants")
    assert (check.passed, check.detail) == (not detail, detail)


def test_wrong_header_is_caught(tmp_path: Path) -> None:
    text = HEADER.replace("for (double sign : {1.0, -1.0})", "for (double sign : {1.0})")
    failed = {check.name for check in verify(header(tmp_path, text), oracle(), samples=60).failed}
    assert {"completeness", "exhaustive search"} <= failed


def test_header_that_cannot_be_used(planar: CppHeader, tmp_path: Path) -> None:
    others = dataclasses.replace(constants(), joint_names=("j1", "j2", "j3"))
    other = CppHeader(planar.path, others)
    with pytest.raises(BadDescriptionError, match="2 joints"):
        _ = other.constants
    with pytest.raises(BadDescriptionError, match="no such"):
        CppHeader(tmp_path / "absent_ik.hpp", constants())
    with pytest.raises(VerificationError, match="does not compile"):
        header(tmp_path, HEADER.replace("int count = 0;", "int count = zero;"))


@pytest.mark.skipif(os.name == "nt", reason="needs sh")
@pytest.mark.parametrize("how", ["closed", "dropped"])
def test_nothing_of_a_header_that_is_still_compiled_is_left(
    how: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    scratch, number = tmp_path / "scratch", tmp_path / "number"
    scratch.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(scratch))
    monkeypatch.setenv("CXX", compiler_of(tmp_path, script_of(number)))
    (tmp_path / "planar_ik.hpp").write_text(HEADER)
    runner = CppHeader(tmp_path / "planar_ik.hpp", constants())
    wait_until_started(number)
    assert len(list(scratch.iterdir())) == 1
    if how == "closed":
        runner.close()
    else:
        del runner
    assert not list(scratch.iterdir())
    assert_ended(number)


@pytest.mark.skipif(os.name == "nt", reason="needs sh")
def test_a_compiler_s_words_are_told_at_each_use(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CXX", compiler_of(tmp_path, "echo 'x.hpp:1:7: error: no x' >&2; exit 1"))
    (tmp_path / "planar_ik.hpp").write_text(HEADER)
    runner = CppHeader(tmp_path / "planar_ik.hpp", constants())
    for _ in range(2):
        with pytest.raises(VerificationError, match=r"does not compile: x\.hpp:1:7: error"):
            runner.forward(np.zeros((1, 2)))


def test_missing_tools_say_how_to_get_them(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CXX", "no-such-compiler -m64")
    with pytest.raises(MissingToolError) as caught:
        cpp_toolchain.find_compiler()
    assert "apt-get install g++" in caught.value.hint
    monkeypatch.setattr(cpp_toolchain, "_eigen_candidates", lambda: [tmp_path])
    with pytest.raises(MissingToolError) as caught:
        cpp_toolchain.find_eigen()
    assert "cmeel-eigen" in caught.value.hint


def test_eigen_directory_from_the_environment(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    headers = tmp_path / "include" / "eigen3"
    (headers / "Eigen").mkdir(parents=True)
    (headers / "Eigen" / "Dense").touch()
    monkeypatch.setenv("Eigen3_DIR", str(tmp_path / "share" / "eigen3" / "cmake"))
    assert cpp_toolchain.find_eigen() == headers


def test_a_driver_is_compiled_beside_the_header(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    told: dict[str, object] = {}

    class Compilation:
        def __init__(self, source: Path, program: Path, include: list[Path], flags: object) -> None:
            told.update(text=source.read_text(), source=source, program=program, include=include)
            told.update(flags=flags)

        def finish(self) -> None: ...

        def end(self) -> None: ...

    monkeypatch.setattr(cpp_header, "Compilation", Compilation)
    monkeypatch.setattr(
        cpp_header.ProgramRunner, "__init__", lambda self, *a, **k: told.update(given=a, named=k)
    )
    path = tmp_path / "made_ik.hpp"
    all_of_it = "void solve_batch( Path follow( SelfMotion self_motion("
    for body, known in (("nothing", False), (all_of_it, True)):
        path.write_text(body)
        runner = cpp_header.CppHeader(path, None)  # type: ignore[arg-type]
        assert told["include"] == [tmp_path.resolve()] and runner.path == path.resolve()
        assert told["source"].name == "driver.cpp" and told["program"].name == "driver"
        assert told["given"] == ("cpp", told["program"], None)
        assert told["named"].pop("made").__name__ == "finish"
        knows = dict.fromkeys(("batch", "motions", "intervals"), known)
        assert told["named"] == {**knows, "source": str(path)}
        assert told["flags"] == ("-O1",)
        assert '#include "made_ik.hpp"' in told["text"]
