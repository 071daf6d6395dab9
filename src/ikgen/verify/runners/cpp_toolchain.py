"""Finds a C++ compiler as CMake would, and Eigen's headers."""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import sysconfig
from pathlib import Path

from ikgen.errors import MissingToolError, VerificationError

__all__ = ["compile_program", "find_compiler", "find_eigen"]

_COMPILERS = ("c++", "g++", "clang++")


def find_compiler() -> list[str]:
    """The compiler's command: `CXX` from the environment, else the first of c++, g++, clang++.

    Raises `MissingToolError` where there is none.
    """
    chosen = shlex.split(os.environ.get("CXX", ""))
    if chosen and shutil.which(chosen[0]):
        return chosen
    for name in _COMPILERS if not chosen else ():
        if path := shutil.which(name):
            return [path]
    what = f"CXX={chosen[0]} is not a program" if chosen else "no C++ compiler found"
    raise MissingToolError(
        what, hint="apt-get install g++, or set CXX to a compiler that knows C++17"
    )


def _eigen_candidates() -> list[Path]:
    variables = ("EIGEN3_INCLUDE_DIR", "Eigen3_DIR", "EIGEN3_ROOT")
    candidates = []
    for value in filter(None, (os.environ.get(name) for name in variables)):
        path = Path(value)  # an include directory, a prefix, or <prefix>/share/eigen3/cmake
        roots = [path, *list(path.parents)[:3]]
        candidates += [path, *(root / "include" / "eigen3" for root in roots)]
    for prefix in ("/usr", "/usr/local", "/opt/homebrew"):
        candidates.append(Path(prefix) / "include" / "eigen3")
    for scheme in ("purelib", "platlib"):
        site = Path(sysconfig.get_path(scheme))
        candidates.append(site / "cmeel.prefix" / "include" / "eigen3")
    return candidates


def find_eigen() -> Path:
    """The directory that holds `Eigen/Dense`.

    Looks at EIGEN3_INCLUDE_DIR, Eigen3_DIR and EIGEN3_ROOT, the system's prefixes, then the wheel
    cmeel-eigen. Raises `MissingToolError` where there is none.
    """
    for candidate in _eigen_candidates():
        if (candidate / "Eigen" / "Dense").is_file():
            return candidate
    raise MissingToolError(
        "Eigen's headers were not found",
        hint="apt-get install libeigen3-dev, or pip install cmeel-eigen, or set EIGEN3_INCLUDE_DIR",
    )


def compile_program(source: Path, output: Path, include: list[Path]) -> None:
    """Compile one C++17 file with light optimisation.

    Raises `MissingToolError` without compiler or Eigen, `VerificationError` with the compiler's
    first messages where the code does not compile.
    """
    includes = [f"-I{directory}" for directory in include]
    command = [*find_compiler(), "-std=c++17", "-O1", *includes, "-isystem", str(find_eigen())]
    done = subprocess.run(
        [*command, str(source), "-o", str(output)], capture_output=True, text=True, check=False
    )
    if done.returncode:
        lines = [line for line in done.stderr.splitlines() if "error" in line] or [done.stderr]
        raise VerificationError(
            "the emitted header does not compile: " + "\n".join(lines[:5]),
            hint=f"compiler: {command[0]}",
        )
