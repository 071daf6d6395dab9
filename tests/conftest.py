"""CMake finds Eigen where this environment has it, as a package of its own or the system's; what tests of
this process compile takes it precompiled."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from tests.support.precompiled import with_eigen

from ikgen.errors import MissingToolError
from ikgen.verify.runners import cpp_toolchain

try:
    _PREFIX = [str(cpp_toolchain.find_eigen().parents[1])]
except MissingToolError:
    _PREFIX = []
_GIVEN = [part for part in os.environ.get("CMAKE_PREFIX_PATH", "").split(os.pathsep) if part]
os.environ["CMAKE_PREFIX_PATH"] = os.pathsep.join([*_GIVEN, *_PREFIX])

_compile = cpp_toolchain.compile_program


def _compile_program(
    source: Path, output: Path, include: list[Path], flags: Sequence[str] = ("-O1",)
) -> None:
    _compile(source, output, include, with_eigen(flags))


cpp_toolchain.compile_program = _compile_program  # before any module imports it
