"""A compiled header by a counting allocator, without optimization and with all of it: nothing is allocated,
and the rows are the same."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pytest
from tests.support.cpp_modules import solver_module
from tests.support.solving import NO_COMPILER

from ikgen.emit.cpp.cpp_emitter import emit
from ikgen.verify.runners.cpp_toolchain import compile_program

pytestmark = [
    pytest.mark.usefixtures("solved_once"),
    pytest.mark.skipif(bool(NO_COMPILER), reason=NO_COMPILER),
]

DRIVER = r"""
#include <cstdio>
#include <cstdlib>
#include <random>
#include "kuka_kr6r900sixx_ik.hpp"
namespace ik = kuka_kr6r900sixx_ik;

extern "C" void* __libc_malloc(std::size_t);
extern "C" void* __libc_memalign(std::size_t, std::size_t);
static bool counting = false;
static int allocations = 0;
extern "C" void* malloc(std::size_t n) { allocations += counting; return __libc_malloc(n); }
extern "C" void* aligned_alloc(std::size_t a, std::size_t n) {
  allocations += counting;
  return __libc_memalign(a, n);
}
extern "C" int posix_memalign(void** p, std::size_t a, std::size_t n) {
  allocations += counting;
  *p = __libc_memalign(a, n);
  return *p ? 0 : 12;
}

int main() {
  counting = true;
  delete new int(3);
  std::free(std::malloc(8));
  counting = false;
  std::printf("%d\n", allocations);
  allocations = 0;
  constexpr int n = 200;
  static Eigen::Isometry3d poses[n];
  static ik::Solutions found[n], together[n];
  std::minstd_rand random(7);
  for (Eigen::Isometry3d& pose : poses) {
    ik::Joints q;
    for (int j = 0; j < ik::kDof; ++j)
      q[j] = ik::kLower[j] + (ik::kUpper[j] - ik::kLower[j]) * (random() % 1000001) * 1e-6;
    pose = ik::forward(q);
  }
  poses[n - 1].translation()[0] += 100.0;
  poses[n - 2].linear() *= 2.0;
  poses[n - 4].translation()[0] += 100.0;
  ik::Options options, near;
  ik::Joints seed = ik::Joints::Zero();
  near.seed = &seed;
  near.project = true;
  counting = true;
  for (int i = 0; i < n; ++i) found[i] = ik::solve(poses[i], i % 2 ? near : options);
  ik::solve_batch(poses, n, together, options);
  (void)ik::jacobian(seed);
  counting = false;
  std::printf("%d\n", allocations);
  for (int i = 0; i < n; ++i) {
    std::printf("%d %d %d %d\n", static_cast<int>(found[i].status), found[i].count,
                static_cast<int>(together[i].status), together[i].count);
    for (int k = 0; k < found[i].count; ++k)
      for (int j = 0; j < ik::kDof; ++j)
        std::printf("%.17g%c", found[i].q[k][j], j + 1 < ik::kDof ? ' ' : '\n');
  }
}
"""


def printed(folder: Path, *flags: str) -> list[list[float]]:
    program = folder / f"solve{len(flags)}"
    compile_program(folder / "solve.cpp", program, [folder], flags)
    done = subprocess.run([program], capture_output=True, text=True, check=True)
    return [[float(word) for word in line.split()] for line in done.stdout.splitlines()]


def test_nothing_is_allocated_and_rows_are_those_of_unoptimized_code(tmp_path: Path) -> None:
    for file, text in emit(solver_module("kuka_kr6r900sixx")).items():
        (tmp_path / file).write_text(text)
    (tmp_path / "solve.cpp").write_text(DRIVER)
    plain = printed(tmp_path, "-O0")
    fast = printed(tmp_path, "-O3", "-march=native")
    for heard, allocated, *_ in (plain, fast):
        assert heard == [2.0], "the allocator that counts is not the one that is called"
        assert allocated == [0.0]
    assert [len(line) for line in plain] == [len(line) for line in fast]
    statuses = [np.array([line for line in lines[2:] if len(line) == 4]) for lines in (plain, fast)]
    rows = [np.array([line for line in lines[2:] if len(line) == 6]) for lines in (plain, fast)]
    assert (statuses[0] == statuses[1]).all() and len({*statuses[0][:, 0]}) == 3
    off = np.abs(rows[0] - rows[1])
    assert len(off) > 500
    assert np.median(off) < 1e-14 and off.max() < 1e-7
