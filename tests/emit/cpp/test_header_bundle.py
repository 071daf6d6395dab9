"""The runtime's headers inside an emitted one: each once, in order, in the emitted namespace."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest
from tests.support.cpp_modules import robot_file, solver_module
from tests.support.pan_lift import pan_lift
from tests.support.routines import FLAGS
from tests.support.runtime_files import HEADERS
from tests.support.solving import NO_COMPILER

from ikgen.derivation.derive import derive
from ikgen.emit.cpp.cpp_emitter import emit_header
from ikgen.emit.cpp.cpp_policy import policy_lines
from ikgen.emit.cpp.header_bundle import bundle
from ikgen.program.policy import SolvePolicy
from ikgen.records.request import Request
from ikgen.verify.runners.cpp_toolchain import find_compiler, find_eigen

pytestmark = pytest.mark.usefixtures("solved_once")

needs_compiler = pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER)


def test_headers_come_behind_what_they_include_and_once() -> None:
    names = re.findall(
        r"^// --- ([\w ]+?) -+$", bundle(["arrays/lane_angle.hpp", "arrays/lanes.hpp"]).body, re.M
    )
    assert names == ["constants", "machine vectors", "lanes", "lane angle"]
    assert (
        bundle(["arrays/lanes.hpp"]).body
        in bundle(["arrays/lanes.hpp", "arrays/lane_angle.hpp"]).body
    )


def test_system_headers_are_merged() -> None:
    includes = bundle(
        ["arm/motion_chain.hpp", "arrays/lanes.hpp"], ["Eigen/Core", "cmath"]
    ).includes
    lines = includes.splitlines()
    assert lines.count("#include <cmath>") == 1 and lines.index("") < lines.index(
        "#include <Eigen/Core>"
    )
    chosen = ("#if defined(__AVX__)", "#elif defined(__SSE2__)", "#endif")
    assert tuple(line for line in lines if line in chosen) == chosen
    assert "#if defined(__AVX512F__)" in bundle(["arrays/lanes.hpp"]).body


def test_nothing_of_the_headers_own_frame_is_left() -> None:
    bundled = bundle(HEADERS)
    for word in ("ikgen_runtime", "#pragma", "#include", "\n\n\n"):
        assert word not in bundled.body
    assert bundled == bundle(HEADERS)


def test_a_header_that_the_runtime_has_not() -> None:
    with pytest.raises(OSError, match="no_such"):
        bundle(["no_such.hpp"])


def test_only_the_policy_that_is_read_is_written() -> None:
    lines = policy_lines(SolvePolicy(), "Policy::kTries + Policy::kArrived; MyPolicy::kDamping")
    assert lines == [
        "static constexpr int kTries = 16;",
        "static constexpr double kArrived = 5e-10;",
    ]
    assert policy_lines(SolvePolicy(), "Policy::kRefinement")[0].startswith(
        "static constexpr RefineStage kRefinement[] = {{3, 1e-12, 0.1}, "
    )


def test_an_emitted_header_takes_what_it_uses() -> None:
    plain, quartic = emit_header(pan_lift()), emit_header(solver_module("ArmRobo"))
    assert (
        "TrigRoots" not in plain
        and "struct Displacement" not in plain
        and "struct WholePose" not in plain
    )
    assert "TrigRoots" in quartic and "struct SelfMotionFinder" not in quartic


def test_of_a_header_only_what_one_arm_needs_is_taken() -> None:
    exact, rounded = emit_header(solver_module("ur5e")), emit_header(solver_module("doosan_m1013"))
    eliminated = emit_header(derive(Request(robot_file("KawasakiRS05L"))).module)
    for name in ("take_beside", "trace_broken", "unstopped", "hold_the_seed", "void regular"):
        assert name not in exact, name
    assert "void take_beside(" in rounded and "void trace_broken(" in rounded
    assert "void regular(" in eliminated and "void regular(" not in rounded
    for text in (exact, rounded, eliminated):
        assert not re.search(r"if constexpr \(!?A(rm)?::k(Newton|Rounded|Refined)", text)
        assert "\2" not in text


def compile_text(text: str, folder: Path, *flags: str) -> subprocess.CompletedProcess[str]:
    source = folder / "main.cpp"
    source.write_text(text)
    command = [*find_compiler(), *FLAGS, "-O0", *flags, "-fsyntax-only", f"-I{folder}", "-isystem"]
    return subprocess.run(
        [*command, str(find_eigen()), str(source)], capture_output=True, text=True
    )


@needs_compiler
def test_two_emitted_headers_in_one_source(tmp_path: Path) -> None:
    for module in (pan_lift(), solver_module("ur5e")):
        (tmp_path / f"{module.name}_ik.hpp").write_text(emit_header(module))
    text = '#include "pan_lift_ik.hpp"\n#include "ur5e_ik.hpp"\n'
    text += "int main() { return pan_lift_ik::kDof + ur5e_ik::solve({}).count; }\n"
    done = compile_text(text, tmp_path)
    assert done.returncode == 0, done.stderr


@needs_compiler
@pytest.mark.parametrize(
    "flag",
    [
        "-ffast-math",
        "-ffinite-math-only",
        pytest.param("-funsafe-math-optimizations", marks=pytest.mark.long),
    ],
)
def test_other_arithmetic_than_of_doubles_is_refused(flag: str, tmp_path: Path) -> None:
    (tmp_path / "pan_lift_ik.hpp").write_text(emit_header(pan_lift()))
    done = compile_text('#include "pan_lift_ik.hpp"\nint main() {}\n', tmp_path, flag)
    assert done.returncode != 0 and "pan_lift_ik.hpp needs IEEE arithmetic" in done.stderr


@needs_compiler
def test_an_older_standard_is_refused_without_more_words(tmp_path: Path) -> None:
    (tmp_path / "pan_lift_ik.hpp").write_text(emit_header(pan_lift()))
    text = '#include "pan_lift_ik.hpp"\nint main() {}\n'
    done = compile_text(text, tmp_path, "-std=c++14")
    assert done.returncode != 0 and "pan_lift_ik.hpp is C++17" in done.stderr
    assert done.stderr.count("error:") == 1
    assert compile_text(text, tmp_path, "-std=c++20").returncode == 0
