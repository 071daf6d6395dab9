"""Runs an emitted C++ header through a small driver program, thousands of poses per process."""

from __future__ import annotations

import dataclasses
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ikgen.errors import BadDescriptionError, VerificationError
from ikgen.verify.runners.cpp_toolchain import compile_program
from ikgen.verify.runners.runner import ArmConstants, Rows

__all__ = ["CppHeader"]

Array = NDArray[np.float64]

_STATUS = ("OK", "UNREACHABLE", "LIMITS", "INVALID")

# Everything is doubles: a head of (mode, N, has free, has seeds, limits), then N items.
_DRIVER = r"""
#include <cstdio>
#include <vector>
#include "@header@"
namespace ik = @namespace@;
using Numbers = std::vector<double>;

static void put(Numbers& out, const double* values, int n) {
  out.insert(out.end(), values, values + n);
}

static void solve(const double*& in, bool has_free, bool has_seed, bool limits, Numbers& out) {
  Eigen::Isometry3d pose;
  pose.matrix() = Eigen::Map<const Eigen::Matrix4d>(in);
  in += 16;
  ik::Options options;
  options.limits = limits;
  if (has_free) for (int i = 0; i < ik::kFree; ++i) options.free[i] = *in++;
  ik::Joints seed;
  if (has_seed) {
    seed = Eigen::Map<const ik::Joints>(in);
    in += ik::kDof;
    options.seed = &seed;
  }
  const ik::Solutions found = ik::solve(pose, options);
  double status = -1;
  switch (found.status) {
    case ik::Status::Ok: status = 0; break;
    case ik::Status::Unreachable: status = 1; break;
    case ik::Status::Limits: status = 2; break;
    case ik::Status::Invalid: status = 3; break;
  }
  out.push_back(status);
  out.push_back(found.count);
  for (int k = 0; k < ik::kMaxSolutions; ++k) {
    const bool row = k < found.count;
    for (int i = 0; i < ik::kDof; ++i) out.push_back(row ? found.q[k][i] : 0.0);
    out.push_back(row && found.singular[k] ? 1.0 : 0.0);
  }
}

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  Numbers input, out;
  std::FILE* file = std::fopen(argv[1], "rb");
  if (!file) return 2;
  std::fseek(file, 0, SEEK_END);
  input.resize(std::ftell(file) / sizeof(double));
  std::rewind(file);
  if (std::fread(input.data(), sizeof(double), input.size(), file) != input.size()) return 2;
  std::fclose(file);
  const int mode = input[0], n = input[1];
  const double* in = input.data() + 5;
  if (mode == 0) out = {double(ik::kDof), double(ik::kFree), double(ik::kMaxSolutions)};
  for (int i = 0; mode > 0 && i < n; ++i) {
    if (mode == 1) {
      solve(in, input[2] != 0, input[3] != 0, input[4] != 0, out);
      continue;
    }
    const ik::Joints q = Eigen::Map<const ik::Joints>(in);
    in += ik::kDof;
    if (mode == 2) {
      const Eigen::Matrix4d T = ik::forward(q).matrix();
      put(out, T.data(), 16);
    } else {
      const Eigen::Matrix<double, 6, ik::kDof> J = ik::jacobian(q);
      put(out, J.data(), 6 * ik::kDof);
    }
  }
  file = std::fopen(argv[2], "wb");
  if (!file || std::fwrite(out.data(), sizeof(double), out.size(), file) != out.size()) return 2;
  return std::fclose(file) == 0 ? 0 : 2;
}
"""
_INFO, _SOLVE, _FORWARD, _JACOBIAN = range(4)


class CppHeader:
    """A `Runner` over an emitted `<name>_ik.hpp`, compiled at construction into a temporary folder.

    `constants` are those of the arm (the header has no names or limits); its number of solutions is
    read from the header. Raises `BadDescriptionError` for a missing file or other joint counts,
    `MissingToolError` without compiler or Eigen, `VerificationError` if it does not compile.
    """

    label = "cpp"
    dynamic_shapes = False

    def __init__(self, path: Path | str, constants: ArmConstants) -> None:
        self.path = Path(path).resolve()
        if not self.path.is_file():
            raise BadDescriptionError("no such C++ header", file=str(path))
        self._directory = tempfile.TemporaryDirectory(prefix="ikgen-verify-")
        work = Path(self._directory.name)
        source, self._program = work / "driver.cpp", work / "driver"
        text = _DRIVER.replace("@header@", self.path.name)
        source.write_text(text.replace("@namespace@", self.path.stem), encoding="utf-8")
        compile_program(source, self._program, [self.path.parent])
        dof, free, most = (int(x) for x in self._run(_INFO, 0, []))
        if (dof, free) != (constants.dof, len(constants.free_joints)):
            raise BadDescriptionError(
                f"has {dof} joints, {free} of them free, instead of {constants.dof} and "
                f"{len(constants.free_joints)}", file=str(path),
            )  # fmt: skip
        self._constants = dataclasses.replace(constants, max_solutions=most)

    @property
    def constants(self) -> ArmConstants:
        """The arm's constants, with the header's number of solutions."""
        return self._constants

    def _run(self, mode: int, n: int, columns: list[Array], flags: tuple[bool, ...] = ()) -> Array:
        """One process: N items made of the columns (N, k), and what it answered."""
        head = np.array([mode, n, *flags, *[0] * (3 - len(flags))], dtype=float)
        body = np.hstack(columns).ravel() if columns else np.empty(0)
        work = Path(self._directory.name)
        request, answer = work / "request", work / "answer"
        request.write_bytes(np.concatenate([head, body]).tobytes())
        command = [str(self._program), str(request), str(answer)]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            raise VerificationError(
                f"the emitted header's driver ended with {done.returncode}: {done.stderr[:500]}"
            )
        return np.fromfile(answer)

    def solve(
        self,
        pose: Array,
        free: Array | None = None,
        seed: Array | None = None,
        limits: bool = True,
    ) -> tuple[Array, str, NDArray[np.bool_]]:
        """Rows (k, dof), status and singular flags (k,) for one pose (4, 4)."""
        frees = None if free is None else np.asarray(free, dtype=float)[None]
        seeds = None if seed is None else np.asarray(seed, dtype=float)[None]
        rows = self.solve_many(np.asarray(pose)[None], free=frees, seeds=seeds, limits=limits)
        k = rows.count[0]
        return rows.q[0, :k], rows.status[0], rows.singular[0, :k]

    def solve_many(
        self,
        poses: Array,
        *,
        free: Array | None = None,
        seeds: Array | None = None,
        limits: bool = True,
    ) -> Rows:
        """`solve` for each of the poses (N, 4, 4) with free values (N, f) and seeds (N, dof)."""
        n, dof, most = len(poses), self._constants.dof, self._constants.max_solutions
        columns = [poses.transpose(0, 2, 1).reshape(n, 16)]  # Eigen stores columns first
        columns += [extra for extra in (free, seeds) if extra is not None]
        flags = (free is not None, seeds is not None, limits)
        out = self._run(_SOLVE, n, columns, flags).reshape(n, 2 + most * (dof + 1))
        table = out[:, 2:].reshape(n, most, dof + 1)
        count = np.clip(out[:, 1].astype(np.int64), 0, most)
        q = np.where((np.arange(most) < count[:, None])[:, :, None], table[:, :, :dof], np.nan)
        status = tuple(_STATUS[int(s)] if s >= 0 else "UNKNOWN" for s in out[:, 0])
        return Rows(q, count, status, table[:, :, dof] != 0)

    def solve_batch(self, poses: Array, limits: bool = True) -> Rows | None:
        """None: the header has no batch function."""
        return None

    def forward(self, q: Array) -> Array:
        """Poses (N, 4, 4) for q (N, dof)."""
        return np.asarray(self._run(_FORWARD, len(q), [q]).reshape(-1, 4, 4).transpose(0, 2, 1))

    def jacobian(self, q: Array) -> Array:
        """Jacobians (N, 6, dof) for q (N, dof)."""
        dof = self._constants.dof
        return np.asarray(self._run(_JACOBIAN, len(q), [q]).reshape(-1, dof, 6).transpose(0, 2, 1))
