"""Routines in C++, compiled as programs that read numbers."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest
from tests.support.solving import NO_COMPILER

from ikgen.emit.cpp.header_bundle import RUNTIME
from ikgen.verify.runners.cpp_toolchain import find_compiler, find_eigen

TEMPLATES = Path(__file__).resolve().parents[2] / "templates"
FLAGS = [
    "-std=c++17",
    "-O2",
    "-Wall",
    "-Wextra",
    "-Wpedantic",
    "-Wconversion",
    "-Wshadow",
    "-Werror",
]
EIGEN = Path(os.environ.get("EIGEN3_INCLUDE_DIR", "/usr/include/eigen3"))


def compiled_header(text: str, folder: Path, *flags: str) -> Path:
    """The program of a source that includes headers of the runtime; warnings are errors. Skips without a
    compiler."""
    if NO_COMPILER:
        pytest.skip(NO_COMPILER)
    source, program = folder / "main.cpp", folder / "main"
    source.write_text(text)
    includes = [f"-I{RUNTIME}", f"-I{Path(__file__).parent}", "-isystem", str(find_eigen())]
    command = [*find_compiler(), *FLAGS, *flags, *includes, str(source), "-o", str(program)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return program


def compiled_routine(name: str, main: str, folder: Path, eigen: bool = False) -> Path:
    """An executable of `templates/cpp/routines/<name>.hpp.jinja` and `main`; skips without a
    compiler."""
    compiler = shutil.which("g++") or shutil.which("clang++")
    if compiler is None:
        pytest.skip("no C++ compiler on this machine")
    if eigen and not EIGEN.is_dir():
        pytest.skip("Eigen is not installed (set EIGEN3_INCLUDE_DIR)")
    text = (TEMPLATES / "cpp" / "routines" / f"{name}.hpp.jinja").read_text()
    standard = ["algorithm", "array", "cmath", "complex", "cstddef", "cstdio", "utility", "vector"]
    head = "".join(f"#include <{h}>\n" for h in (["Eigen/Core"] if eigen else []) + standard)
    source, program = folder / f"{name}.cpp", folder / name
    source.write_text(head + text + main)
    include = ["-isystem", str(EIGEN)] if eigen else []
    done = subprocess.run(
        [compiler, *FLAGS, *include, str(source), "-o", str(program)],
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    return program


def feed(program: Path, numbers: list[float]) -> list[list[float]]:
    """The program's lines of numbers, given numbers on its standard input."""
    text = " ".join(f"{x:.17g}" for x in numbers)
    done = subprocess.run([str(program)], input=text, capture_output=True, text=True, check=True)
    return [[float(x) for x in line.split()] for line in done.stdout.splitlines()]
