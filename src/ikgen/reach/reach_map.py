"""A reachability map: how many solutions every pose of a grid has, and how good the best one is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ikgen.emit.derivation import Derivation
from ikgen.emit.python.python_emitter import emit_module
from ikgen.errors import MissingToolError, UsageError
from ikgen.processes.executors import Workers, run_pieces
from ikgen.reach.compiled_engine import compiled_engine
from ikgen.reach.engine import Block, Engine, Interpreted, solve_block
from ikgen.reach.grid import Grid

__all__ = ["ReachMap", "engine_of", "interpreted_engine", "reach_map"]

_POSES = 60000
"""Poses of a block, about."""


@dataclass(frozen=True, slots=True)
class ReachMap:
    """`count`, `sigma`, `margin` (nx, ny, nz, rotations) over a `grid`, as in `MapRows`. `size` (m) is
    what the linear rows of the Jacobian were taken relative to."""

    robot: str
    base: str
    tip: str
    task: str
    grid: Grid
    size: float
    count: NDArray[np.uint8]
    sigma: NDArray[np.float32]
    margin: NDArray[np.float32]

    @property
    def solved(self) -> float:
        """Share of the poses with a solution inside the limits."""
        return float((self.count > 0).mean())

    @property
    def by_position(self) -> NDArray[np.float64]:
        """(nx, ny, nz): share of the rotations that have a solution."""
        return np.asarray((self.count > 0).mean(axis=3))


def engine_of(
    derivation: Derivation, *, portable: bool, warn: Callable[[str], None]
) -> tuple[Engine, float]:
    """The compiled engine, or where there is no compiler the NumPy one, with a warning; and the length
    (m) that singular values are relative to. Raises `UsageError` for an arm without numbers."""
    if derivation.reading.dh.symbols:
        raise UsageError("a table without numbers reaches nothing", hint="give [parameters] values")
    rows, moving, size = _measure(derivation)
    try:
        return compiled_engine(
            derivation.module.on_joints, rows, moving, size, portable=portable
        ), size
    except MissingToolError as error:
        warn(f"slower, by NumPy: {error.message}; {error.hint}")
    return interpreted_engine(derivation), size


def interpreted_engine(derivation: Derivation) -> Interpreted:
    """The NumPy engine of an arm with numbers."""
    module = derivation.module.on_joints
    return Interpreted(emit_module(module), module.dh, *_measure(derivation))


def _measure(derivation: Derivation) -> tuple[tuple[int, int], tuple[int, ...], float]:
    """What singular values are of: rows of the Jacobian (first, how many), columns, and the length (m)
    that they are relative to."""
    task, dh = derivation.task, derivation.module.dh
    rows = (3, 3) if not task.position else (0, 6) if task.orientation else (0, 3)
    moving = tuple(j for j in range(dh.dof) if j not in derivation.module.free_indices)
    size = float(sum(np.linalg.norm(F[:3, 3]) for F in dh.file_frames)) or 1.0
    return rows, moving, size


def reach_map(
    derivation: Derivation,
    grid: Grid,
    engine: Engine,
    size: float,
    workers: Workers | None,
    done: Callable[[int, int], None] = lambda ready, total: None,
) -> ReachMap:
    """Solve the whole grid; the same arrays whatever the workers are (None: this process)."""
    positions = grid.positions
    each = max(1, _POSES // len(grid.rotations))
    pieces = [
        Block(engine, positions[i : i + each], grid.rotations)
        for i in range(0, len(positions), each)
    ]
    found = run_pieces(workers, solve_block, pieces, done)
    count, sigma, margin = (
        np.concatenate([getattr(rows, name) for rows in found]).reshape(grid.shape)
        for name in ("count", "sigma", "margin")
    )
    dh = derivation.reading.dh
    ends = (dh.robot, dh.base_link, dh.tip_link, derivation.task.name)
    return ReachMap(*ends, grid, size, count, sigma, margin)
