"""What tests of all folders share: where CMake finds Eigen, and the compiler."""

from __future__ import annotations

import os

from tests.support.precompiled import compilers

from ikgen.errors import MissingToolError
from ikgen.verify.runners.cpp_toolchain import find_eigen

try:
    _PREFIX = [str(find_eigen().parents[1])]
except MissingToolError:
    _PREFIX = []
_GIVEN = [part for part in os.environ.get("CMAKE_PREFIX_PATH", "").split(os.pathsep) if part]
os.environ["CMAKE_PREFIX_PATH"] = os.pathsep.join([*_GIVEN, *_PREFIX])

if _COMPILERS := compilers():
    os.environ["PATH"] = f"{_COMPILERS}{os.pathsep}{os.environ['PATH']}"
