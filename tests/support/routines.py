"""The routines of the C++ runtime, compiled as programs that read numbers."""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

from ikgen.emit.cpp.header_bundle import bundle

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


def compiled_routine(name: str, main: str, folder: Path, eigen: bool = False) -> Path:
    """An executable of the runtime's `<name>.hpp` and `main`; skips without a compiler."""
    compiler = shutil.which("g++") or shutil.which("clang++")
    if compiler is None:
        pytest.skip("no C++ compiler on this machine")
    if eigen and not EIGEN.is_dir():
        pytest.skip("Eigen is not installed (set EIGEN3_INCLUDE_DIR)")
    routine = bundle([f"{name}.hpp"], ("cstdio", "vector", *(["Eigen/Core"] if eigen else [])))
    head = routine.includes + routine.body
    source, program = folder / f"{name}.cpp", folder / name
    source.write_text(head + main)
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
