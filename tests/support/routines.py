"""The routines of the C++ runtime, compiled as programs that read numbers."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest
from tests.support.solving import NO_COMPILER

from ikgen.emit.cpp.header_bundle import RUNTIME
from ikgen.verify.runners.cpp_toolchain import find_compiler, find_eigen

FLAGS = [
    "-std=c++17",
    "-O1",
    "-Wall",
    "-Wextra",
    "-Wpedantic",
    "-Wconversion",
    "-Wshadow",
    "-Werror",
]

MACHINES: dict[str, tuple[str, ...]] = {"portable": (), "native": ("-march=native",)}
"""Sets of instructions, as options of the compiler."""


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


def feed(program: Path, numbers: list[float]) -> list[list[float]]:
    """The program's lines of numbers, given numbers on its standard input."""
    text = " ".join(f"{x:.17g}" for x in numbers)
    done = subprocess.run([str(program)], input=text, capture_output=True, text=True, check=True)
    return [[float(x) for x in line.split()] for line in done.stdout.splitlines()]
