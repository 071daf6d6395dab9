"""Finds a C++ compiler as CMake would, and Eigen's headers."""

from __future__ import annotations

import errno
import os
import re
import shlex
import shutil
import sys
import sysconfig
from collections.abc import Sequence
from functools import cache
from pathlib import Path

from ikgen.errors import MissingToolError, VerificationError
from ikgen.processes.outside_program import (
    SECONDS_VARIABLE,
    Finished,
    RunningProgram,
    run_program,
)

__all__ = [
    "FULL",
    "LEAN",
    "LIGHT",
    "Compilation",
    "compile_extension",
    "compile_program",
    "find_compiler",
    "find_eigen",
    "is_gcc",
]

LIGHT = ("-O1",)
"""Options of a light optimisation."""

FULL = ("-O3",)
"""Options of all of it, for what is compiled once and called often."""

_ROOM = ("--param", "ggc-min-heapsize=600000")
"""kB that GCC fills before it collects what it needs no more, which takes a tenth of its time (420 MB in
place of 370 for a header of seven joints); Clang knows the option, and does nothing with it."""

LEAN = (
    "-fno-tree-loop-optimize", "-fno-tree-ccp", "-fno-tree-ch", "-fno-tree-pta", "-fira-region=one",
    "--param", "max-combine-insns=2",
)  # fmt: skip
"""Options of GCC alone: what of its light optimisation takes a sixth of the time to compile, and brings
little to a program that runs for a second. They change no result."""

_COMPLAINT = re.compile(r":\d+:\d+: .*\berror: ")
_COMPILERS = ("c++", "g++", "clang++")


def find_compiler() -> list[str]:
    """The compiler's command: `CXX` from the environment, else the first of c++, g++, clang++.

    Raises `MissingToolError` where there is none.
    """
    asked = os.environ.get("CXX", "")
    try:
        chosen = shlex.split(asked)
    except ValueError as error:
        raise MissingToolError(
            f"CXX={asked} is no command: {error}", hint="quote as in a shell, or unset CXX"
        ) from None
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


class Compilation:
    """One C++17 file that is being compiled while this process goes on. Raises `MissingToolError` without
    compiler or Eigen."""

    def __init__(
        self, source: Path, output: Path, include: Sequence[Path], flags: Sequence[str]
    ) -> None:
        self._output = output
        self._command = _command([source], output, include, flags)
        self._compiler = RunningProgram(self._command, environment=_environment(output))
        self._done: Finished | None = None

    def finish(self) -> None:
        """Wait until the program is there. Raises as `compile_program` does."""
        if self._done is None:
            self._done = self._compiler.finished()
        _check(self._command, self._output, self._done)

    def end(self) -> None:
        """End the compiler, if it has not ended yet."""
        self._compiler.end()


def compile_program(
    source: Path, output: Path, include: Sequence[Path], flags: Sequence[str] = LIGHT
) -> None:
    """Compile one C++17 file, by default with light optimisation.

    Raises `MissingToolError` without compiler or Eigen, and where the compiler itself fails: crashes,
    takes too long, finds no room; `VerificationError` with its first messages where the code does not
    compile.
    """
    Compilation(source, output, include, flags).finish()


def compile_extension(
    sources: Sequence[Path], output: Path, include: Sequence[Path], *defines: str
) -> None:
    """Compile C++17 files into a module of the running Python, with full optimisation. Raises as
    `compile_program`."""
    options = [f"-D{one}" for one in ("NDEBUG", *defines)]
    options += [*FULL, "-shared", "-fPIC", "-fvisibility=hidden", "-fno-strict-aliasing"]
    if sys.platform == "darwin":
        options += ["-undefined", "dynamic_lookup"]
    places = [*include, Path(sysconfig.get_path("include"))]
    command = _command(sources, output, places, options)
    _check(command, output, run_program(command, environment=_environment(output)))


def _command(
    sources: Sequence[Path], output: Path, include: Sequence[Path], options: Sequence[str]
) -> list[str]:
    includes = [f"-I{directory}" for directory in include]
    compiler = find_compiler()
    lean = LEAN if set(LIGHT) <= set(options) and is_gcc(tuple(compiler)) else ()
    command = [*compiler, "-std=c++17", *_ROOM, *options, *lean, *includes]
    return [*command, "-isystem", str(find_eigen()), *map(str, sources), "-o", str(output)]


@cache
def is_gcc(compiler: tuple[str, ...]) -> bool:
    """Whether a compiler is GCC's, as it tells; raises `MissingToolError` where that takes too long."""
    told = run_program([*compiler, "-v"], environment={**os.environ, "LC_ALL": "C"})
    if told.late:
        raise _compiler_failed(compiler[0], told)
    return "gcc version " in told.printed


def _environment(output: Path) -> dict[str, str]:
    """That in which compilers speak English, by which their complaints are known, and put files of their
    own beside the output: what one that is ended leaves goes with that folder."""
    return {**os.environ, "LC_ALL": "C", "TMPDIR": str(output.parent)}


def _check(command: Sequence[str], output: Path, done: Finished) -> None:
    """Raise what came of a compiler that made nothing."""
    wrong = _complaints(done.printed)
    if wrong and done.code and not (done.late or done.crashed):
        raise VerificationError(
            "the emitted header does not compile: " + "\n".join(wrong[:5]),
            hint=f"compiler: {command[0]}",
        )
    if done.late or done.code or not output.is_file():
        raise _compiler_failed(command[0], done)


def _complaints(printed: str) -> list[str]:
    """What a compiler has against the code: errors with a place in it. It gives one too where it crashes
    or finds no room, whose fault the code is not."""
    lines = [line for line in printed.splitlines() if _COMPLAINT.search(line)]
    own = ("internal compiler error", os.strerror(errno.ENOSPC), os.strerror(errno.EDQUOT))
    return [] if any(text in line for line in lines for text in own) else lines


def _compiler_failed(compiler: str, done: Finished) -> MissingToolError:
    said = next((line.strip() for line in done.printed.splitlines() if line.strip()), "")
    more = (
        f"limit: {SECONDS_VARIABLE}" if done.late else "try it by hand, or set CXX to another one"
    )
    return MissingToolError(
        f"the compiler {compiler} {done.words}" + (f": {said[:300]}" if said else ""),
        hint=f"whether the emitted header is right is not known; {more}",
    )
