"""What solves a block of a map: a program compiled from the emitted header, or the NumPy module."""

from __future__ import annotations

import hashlib
import os
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ikgen.errors import VerificationError
from ikgen.kinematics.forward import file_jacobian
from ikgen.model.arrays import Array
from ikgen.model.dh import DHChain
from ikgen.processes.outside_program import run_program
from ikgen.processes.scratch_folder import ScratchFolder
from ikgen.verify.runners.python_module import PythonModule

__all__ = ["Block", "Compiled", "Engine", "Interpreted", "MapRows", "solve_block"]


@dataclass(frozen=True, slots=True)
class MapRows:
    """Per pose (n,): `count` of solutions inside the limits; of the best of them `sigma`, the smallest
    singular value, and `margin` to the limits (0 at one, 1 in the middle of all ranges); 0 without any."""

    count: NDArray[np.uint8]
    sigma: NDArray[np.float32]
    margin: NDArray[np.float32]


@dataclass(frozen=True, slots=True)
class Compiled:
    """The bytes of a program: it goes with the block to whatever worker solves it."""

    program: bytes


@dataclass(frozen=True, slots=True)
class Interpreted:
    """The text of the emitted Python module and what the singular values are of: `rows` of the Jacobian
    (first, how many), `moving` columns, `size` (m) that lengths are relative to."""

    text: str
    dh: DHChain
    rows: tuple[int, int]
    moving: tuple[int, ...]
    size: float


Engine = Compiled | Interpreted


@dataclass(frozen=True, slots=True)
class Block:
    """`positions` (k, 3), m, each with all `rotations` (n, 3, 3)."""

    engine: Engine
    positions: Array
    rotations: Array


def solve_block(block: Block) -> MapRows:
    """The rows of a block, (k * n,): rotations fastest."""
    if isinstance(block.engine, Compiled):
        return _by_program(block.engine, block)
    return _by_module(block.engine, block)


@cache
def _folder(digest: str) -> ScratchFolder:
    """One folder a process and content (`digest`), removed with the process."""
    return ScratchFolder("ikgen-")


def _file(name: str, content: bytes) -> Path:
    """The content as a file of this process' own, written once."""
    path = _folder(hashlib.sha256(content).hexdigest()).path / name
    if not path.is_file():
        path.write_bytes(content)
        path.chmod(0o700)
    return path


def _by_program(engine: Compiled, block: Block) -> MapRows:
    program = _file("program", engine.program)
    request, answer = program.with_name("request"), program.with_name("answer")
    turned = block.rotations.transpose(0, 2, 1)
    head = [len(block.positions), len(turned)]
    request.write_bytes(
        np.concatenate([head, block.positions.ravel(), turned.ravel()]).astype(float).tobytes()
    )
    done = run_program([os.fspath(program), os.fspath(request), os.fspath(answer)])
    if done.late or done.code:
        hint = "--portable compiles for any processor of its kind" if done.crashed else ""
        raise VerificationError(f"the program of the map {done.words}", hint=hint)
    n = len(block.positions) * len(turned)
    data = answer.read_bytes()
    values = np.frombuffer(data, dtype=np.float32, offset=n)
    return MapRows(np.frombuffer(data, dtype=np.uint8, count=n), values[:n], values[n:])


@cache
def _module(text: str) -> PythonModule:
    return PythonModule(_file("map_ik.py", text.encode()))


def _by_module(engine: Interpreted, block: Block) -> MapRows:
    k, n = len(block.positions), len(block.rotations)
    poses = np.tile(np.eye(4), (k * n, 1, 1))
    poses[:, :3, :3] = np.tile(block.rotations, (k, 1, 1))
    poses[:, :3, 3] = np.repeat(block.positions, n, axis=0)
    module = _module(engine.text)
    found = module.solve_batch(poses)
    assert found is not None
    index, q, _ = found.flat()
    lower, upper = module.constants.lower, module.constants.upper
    sigma, margin = np.zeros(k * n), np.zeros(k * n)
    np.maximum.at(sigma, index, _singular_values(engine, q))
    np.maximum.at(margin, index, _margins(q, lower, upper))
    count = np.minimum(found.count, 255).astype(np.uint8)
    return MapRows(count, sigma.astype(np.float32), margin.astype(np.float32))


def _singular_values(engine: Interpreted, q: Array) -> Array:
    """The smallest one (k,) at joint values (k, dof)."""
    if not len(q):
        return np.empty(0)
    scale = np.array([1.0 / engine.size] * 3 + [1.0] * 3)[:, None]
    first, rows = engine.rows
    J = (file_jacobian(engine.dh, q) * scale)[:, first : first + rows, list(engine.moving)]
    return np.asarray(np.linalg.svd(J, compute_uv=False)[:, -1])


def _margins(q: Array, lower: Array, upper: Array) -> Array:
    """How far (k,) from the nearest limit, as a share of half the range."""
    half = (upper - lower) / 2
    bounded = np.isfinite(half) & (half > 0)
    near = np.minimum(q - lower, upper - q)[:, bounded] / half[bounded]
    return np.asarray(np.clip(near.min(axis=1, initial=1.0), 0.0, 1.0))
