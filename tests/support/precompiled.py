"""Eigen's headers precompiled for g++: they are most of what it reads in every test that compiles."""

from __future__ import annotations

import hashlib
import os
import subprocess
from collections.abc import Sequence
from functools import cache
from pathlib import Path

from ikgen.errors import MissingToolError
from ikgen.verify.runners.cpp_toolchain import find_compiler, find_eigen

__all__ = ["with_eigen"]

FOLDER = Path(__file__).parents[2] / "build" / "precompiled"
HEADERS = "#include <Eigen/Core>\n#include <Eigen/Geometry>\n"
OPTIMISED = (("-O1",), ("-O2",))
"""The options, beside those for warnings, that headers are precompiled for."""


def with_eigen(options: Sequence[str]) -> tuple[str, ...]:
    """Options of a C++17 compilation, with Eigen precompiled where that is done for them."""
    kept = tuple(one for one in options if not one.startswith(("-W", "-std=")))
    if kept not in OPTIMISED or "CXX" in os.environ:
        return tuple(options)
    header = _precompiled(kept)
    return tuple(options) if header is None else (*options, "-include", str(header))


@cache
def _precompiled(options: tuple[str, ...]) -> Path | None:
    """The header that stands for Eigen's with these options; None for another compiler than g++."""
    try:
        compiler, eigen = find_compiler(), find_eigen()
    except MissingToolError:
        return None
    version = subprocess.run([*compiler, "--version"], capture_output=True, text=True).stdout
    if "Free Software Foundation" not in version:
        return None
    key = "\n".join([version, str(eigen), *options, HEADERS])
    header = FOLDER / hashlib.sha256(key.encode()).hexdigest()[:16] / "eigen.hpp"
    made = header.with_name(f"{header.name}.gch")
    if not made.is_file():
        header.parent.mkdir(parents=True, exist_ok=True)
        header.write_text(HEADERS)
        mine = header.with_name(f"{os.getpid()}.gch")  # of several processes each has its own
        command = [*compiler, "-std=c++17", *options, "-isystem", str(eigen)]
        subprocess.run([*command, "-x", "c++-header", str(header), "-o", str(mine)], check=True)
        mine.replace(made)
    return header
