"""What tests of all folders share: where CMake finds Eigen, the compiler, chains that are solved once."""

from __future__ import annotations

import gc
import os
import sys
from collections.abc import Iterator

import pytest
from hypothesis.internal.conjecture import providers
from tests.support.precompiled import compilers
from tests.support.solved import left_over, solved

from ikgen.derivation import unsolved
from ikgen.errors import MissingToolError
from ikgen.solver import solve
from ikgen.verify.runners.cpp_toolchain import find_eigen

try:
    _PREFIX = [str(find_eigen().parents[1])]
except MissingToolError:
    _PREFIX = []
_GIVEN = [part for part in os.environ.get("CMAKE_PREFIX_PATH", "").split(os.pathsep) if part]
os.environ["CMAKE_PREFIX_PATH"] = os.pathsep.join([*_GIVEN, *_PREFIX])

if _COMPILERS := compilers():
    os.environ["PATH"] = f"{_COMPILERS}{os.pathsep}{os.environ['PATH']}"


def pytest_collection_finish() -> None:
    """Modules and thousands of collected tests stay to the end: no garbage is to be looked for there, and
    seldom elsewhere."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(100_000, 30, 30)


if hasattr(providers, "is_local_module_file"):
    # Else the first example of each process waits till the numbers of all modules that are loaded have been
    # looked up for it: ten seconds where no run before has, in which other examples fail for being slow.
    providers.is_local_module_file = lambda path: False


@pytest.fixture(scope="module")
def solved_once() -> Iterator[None]:
    """For modules of tests of what comes after the solution of a chain: equal chains are solved once, but
    where it is traced which functions each test calls."""
    with pytest.MonkeyPatch.context() as patch:
        if sys.gettrace() is None:
            patch.setattr(solve, "solve_chain", solved)
            patch.setattr(unsolved, "leftover_text", left_over)
        yield
