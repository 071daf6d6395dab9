"""Intervals, searches and paths of an arm in both languages."""

from __future__ import annotations

import subprocess
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType

import numpy as np
from numpy.typing import NDArray
from tests.support.solving import import_text

from ikgen.derivation.derive import derive
from ikgen.emit.cpp.cpp_emitter import emit, emit_header
from ikgen.emit.python.python_emitter import emit_module
from ikgen.emit.solver_module import SolverModule
from ikgen.generation.emitted_runners import arm_constants
from ikgen.records.request import Request
from ikgen.verify.runners.cpp_header import CppHeader
from ikgen.verify.runners.cpp_toolchain import compile_program, find_eigen

__all__ = ["Both", "emitted_in_both", "header_of", "in_both"]

Array = NDArray[np.float64]

PROGRAM = r"""
#include "@_ik.hpp"
#include <algorithm>
#include <cstdio>
#include <memory>
#include <vector>
namespace ik = @_ik;
int main() {
  int mode, n;
  ik::Joints seed;
  while (std::scanf("%d %d", &mode, &n) == 2) {
    for (int j = 0; j < ik::kDof; ++j) std::scanf("%lf", &seed[j]);
    std::vector<Eigen::Isometry3d, Eigen::aligned_allocator<Eigen::Isometry3d>> poses(n);
    for (auto& T : poses)
      for (int i = 0; i < 16; ++i) std::scanf("%lf", &T.matrix()(i / 4, i % 4));
    std::vector<double> out;
#if INTERVALS
    if (mode == 0) {
      const auto found = ik::self_motion(poses[0]);
      out = {double(found.status), double(found.count)};
      for (const auto& one : found) out.insert(out.end(), {one.low, one.high, double(one.branch)});
    }
#endif
#if SEARCHES
    if (mode >= 1 && mode <= 3) {
      ik::SearchOptions options;
      options.seed = &seed;
      options.prefer = static_cast<ik::Prefer>(mode - 1);
      const ik::Solutions found = ik::search(poses[0], options);
      out = {double(found.status), double(found.count)};
      for (const auto& q : found) out.insert(out.end(), q.data(), q.data() + ik::kDof);
    }
#endif
#if PATHS
    if (mode == 4) {
      std::vector<ik::Joints, Eigen::aligned_allocator<ik::Joints>> q(n);
      const auto singular = std::make_unique<bool[]>(n);
      const ik::Path path = ik::follow(poses.data(), n, seed, q.data(), true, singular.get());
      const auto flags = std::count(&singular[0], &singular[0] + n, true);
      out = {double(path.status), double(path.reached), double(flags)};
      for (int i = 0; i < path.reached; ++i) out.insert(out.end(), q[i].data(), q[i].data() + ik::kDof);
    }
#endif
#if SOLUTIONS
    if (mode == 5) {
      ik::Options options;
      options.seed = &seed;
      const ik::Solutions found = ik::solve(poses[0], options);
      out = {double(found.status), double(found.count)};
      for (const auto& q : found) out.insert(out.end(), q.data(), q.data() + ik::kDof);
    }
#endif
    for (const double x : out) std::printf("%.17g ", x);
    std::printf("\n");
  }
}
"""

MODES = {"INTERVALS": "0", "SEARCHES": "123", "PATHS": "4", "SOLUTIONS": "5"}
"""What the program does in which mode."""
STATUS = ("OK", "UNREACHABLE", "LIMITS", "INVALID", "SINGULAR")


@dataclass(frozen=True)
class Both:
    """An arm in both languages."""

    arm: ModuleType
    program: Path

    def run(self, mode: int, seed: Array, poses: Array) -> tuple[str, Array]:
        """Status and numbers that the C++ program answers."""
        numbers = [mode, len(poses), *seed.tolist(), *poses.ravel().tolist()]
        text = subprocess.run(
            [self.program],
            input=" ".join(map(repr, numbers)),
            capture_output=True,
            text=True,
            check=True,
        ).stdout
        values = np.array(text.split(), dtype=float)
        return STATUS[int(values[0])], values[2:]

    def follow(self, start: Array, poses: Array) -> tuple[str, int, Array]:
        """Status, how many rows are singular, and the rows."""
        status, numbers = self.run(4, start, poses)
        return status, int(numbers[0]), numbers[1:].reshape(-1, self.arm.DOF)


def header_of(module: SolverModule, folder: Path) -> CppHeader:
    """The emitted header of an arm in a folder, compiled."""
    for name, text in emit(module).items():
        (folder / name).write_text(text)
    return CppHeader(folder / f"{module.name}_ik.hpp", arm_constants(module))


def emitted_in_both(request: Request, folder: Path) -> tuple[ModuleType, CppHeader]:
    """The emitted module of a request, loaded, and its header in a folder, compiled."""
    module = derive(request).module
    return import_text(emit_module(module), folder), header_of(module, folder)


def in_both(module: SolverModule, folder: Path, modes: str = "012345") -> Both:
    """The arm, its files and a program of its header in a folder, which knows what is asked in these modes:
    each takes a second to compile."""
    (folder / f"{module.name}_ik.hpp").write_text(emit_header(module))
    if len(module.held) != 1:
        modes = modes.replace("0", "")
    known = {name: int(bool(set(own) & set(modes))) for name, own in MODES.items()}
    source = folder / "main.cpp"
    defines = "".join(f"#define {name} {there}\n" for name, there in known.items())
    source.write_text(defines + PROGRAM.replace("@", module.name))
    compile_program(source, folder / "main", [folder, find_eigen()])
    return Both(import_text(emit_module(module), folder), folder / "main")
