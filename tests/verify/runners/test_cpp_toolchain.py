"""Compilers that fail by themselves are not taken for a fault of the emitted code."""

from __future__ import annotations

import os
import sysconfig
from pathlib import Path

import pytest

from ikgen.errors import MissingToolError, VerificationError
from ikgen.processes.outside_program import Finished
from ikgen.verify.runners import cpp_toolchain
from ikgen.verify.runners.cpp_toolchain import compile_program, find_compiler, find_eigen

pytestmark = pytest.mark.skipif(os.name == "nt", reason="needs sh")

FAILING = {
    "crashes": ("kill -SEGV $$", "was ended by SIGSEGV"),
    "part-crashes": (
        "echo 'x.cpp:1:1: internal compiler error: Segmentation fault' >&2; exit 1",
        "internal compiler error",
    ),
    "no-room": (
        "echo 'x.cpp:1:1: fatal error: error writing to /tmp/c.s: No space left on device' >&2; exit 1",
        "No space left",
    ),
    "killed-part": (
        "echo 'g++: fatal error: Killed signal terminated program cc1plus' >&2; exit 1",
        "Killed signal",
    ),
    "refuses": ("echo 'error: unknown option -std=c++17' >&2; exit 1", "exit code 1"),
    "hangs": ("sleep 600", "takes more than 1 s"),
    "does-nothing": ("exit 0", "exit code 0"),
    "talks": ("yes 'a warning' | head -c 5000000 >&2; exit 7", "exit code 7: a warning"),
}


@pytest.mark.parametrize("kind", FAILING)
def test_a_compiler_that_fails(kind: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    does, told = FAILING[kind]
    compiler = tmp_path / "compiler"
    compiler.write_text(f"#!/bin/sh\n{does}\n")
    compiler.chmod(0o755)
    monkeypatch.setenv("CXX", str(compiler))
    monkeypatch.setenv("IKGEN_TOOL_SECONDS", "1" if kind == "hangs" else "60")
    with pytest.raises(MissingToolError, match=told) as caught:
        compile_program(tmp_path / "x.cpp", tmp_path / "x", [])
    assert "is not known" in caught.value.hint


def test_complaints_about_the_code_are_told_the_first_of_them(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    compiler = tmp_path / "compiler"
    lines = "".join(f"echo 'x.hpp:{k}:7: error: no {k}' >&2\n" for k in range(1, 8))
    compiler.write_text(f"#!/bin/sh\necho 'x.hpp:1:1: warning: a' >&2\n{lines}exit 1\n")
    compiler.chmod(0o755)
    monkeypatch.setenv("CXX", str(compiler))
    with pytest.raises(VerificationError, match="emitted header does not compile") as caught:
        compile_program(tmp_path / "x.cpp", tmp_path / "x", [])
    told = caught.value.message.split(": ", 1)[1].splitlines()
    assert told == [f"x.hpp:{k}:7: error: no {k}" for k in range(1, 6)]
    assert caught.value.hint == f"compiler: {compiler}"


@pytest.mark.parametrize("platform", ["linux", "darwin"])
def test_an_extension_may_lack_the_names_of_its_interpreter(
    platform: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    commands: list[list[str]] = []
    out = tmp_path / "x.so"
    out.touch()

    def run(command: list[str], **_: object) -> Finished:
        commands.append(command)
        return Finished(0, "")

    monkeypatch.setattr(cpp_toolchain, "run_program", run)
    monkeypatch.setattr(cpp_toolchain.sys, "platform", platform)
    cpp_toolchain.compile_extension([tmp_path / "a.cpp"], out, [tmp_path], "ONE=1")
    ((*options, name, output),) = commands
    assert (name, output) == ("-o", str(out)) and options[-1] == str(tmp_path / "a.cpp")
    wanted = {"-std=c++17", "-DNDEBUG", "-DONE=1", "-O3", "-shared", "-fPIC", f"-I{tmp_path}"}
    assert wanted <= set(options) and f"-I{sysconfig.get_path('include')}" in options
    assert ("dynamic_lookup" in options) == ("-undefined" in options) == (platform == "darwin")


def test_code_that_does_not_compile_in_another_language(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("LC_ALL", "de_DE.UTF-8")
    monkeypatch.setenv("LANGUAGE", "de")
    try:
        find_compiler()
    except MissingToolError as missing:
        pytest.skip(missing.message)
    (tmp_path / "x.cpp").write_text("int main() { return nothing; }\n")
    with pytest.raises(VerificationError, match="does not compile"):
        compile_program(tmp_path / "x.cpp", tmp_path / "x", [])


def test_a_variable_that_is_no_command(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("CXX", '"x')
    with pytest.raises(MissingToolError, match="CXX="):
        find_compiler()


@pytest.mark.parametrize(
    ("variable", "place"),
    [
        ("EIGEN3_INCLUDE_DIR", "prefix/include/eigen3"),
        ("EIGEN3_ROOT", "prefix"),
        ("Eigen3_DIR", "prefix/share/eigen3/cmake"),
        ("Eigen3_DIR", "prefix/share/eigen3"),
    ],
)
def test_eigen_where_a_variable_says(
    variable: str, place: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("EIGEN3_INCLUDE_DIR", "EIGEN3_ROOT", "Eigen3_DIR"):
        monkeypatch.delenv(name, raising=False)
    headers = tmp_path / "prefix" / "include" / "eigen3"
    (headers / "Eigen").mkdir(parents=True)
    (headers / "Eigen" / "Dense").touch()
    (tmp_path / place).mkdir(parents=True, exist_ok=True)
    monkeypatch.setenv(variable, str(tmp_path / place))
    assert find_eigen() == headers
    monkeypatch.setenv(variable, str(tmp_path / "prefix/a/b/c/d"))
    assert find_eigen() != headers


@pytest.mark.parametrize(
    ("version", "options", "lean"),
    [
        ("gcc version 12.2.0 (Debian 12.2.0-14)", ("-O1",), True),
        ("gcc version 12.2.0 (Debian 12.2.0-14)", ("-O3",), False),
        ("clang version 17.0.6", ("-O1",), False),
    ],
)
def test_only_gcc_gets_options_of_its_own(
    version: str,
    options: tuple[str, ...],
    lean: bool,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    compiler, got = tmp_path / "compiler", tmp_path / "got"
    compiler.write_text(
        f'#!/bin/sh\nif [ "$1" = -v ]; then echo "{version}" >&2; exit; fi\n'
        f'echo "$@" > {got}; touch {tmp_path / "x"}\n'
    )
    compiler.chmod(0o755)
    monkeypatch.setenv("CXX", str(compiler))
    compile_program(tmp_path / "x.cpp", tmp_path / "x", [], options)
    assert (" ".join(cpp_toolchain.LEAN) in got.read_text()) is lean
