"""One pose and all its solutions, by the module that is emitted."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ikgen.emit.derivation import Derivation
from ikgen.emit.python.python_emitter import emit_module
from ikgen.kinematics.forward import dh_forward, file_jacobian
from ikgen.kinematics.joint_box import joint_box
from ikgen.lowering.held_angle import held_values
from ikgen.model.arrays import Array
from ikgen.model.dh import DHChain
from ikgen.processes.scratch_folder import ScratchFolder
from ikgen.report.skeleton_bones import skeleton
from ikgen.verify.runners.python_module import PythonModule

__all__ = ["WorkedExample", "shown_configuration", "solver_of", "worked_example"]


_TRIED, _SEED, _WIDEST = 40, 7, 2.6
"""Configurations to choose from; half the range (rad, m) of a joint without limits."""


@dataclass(frozen=True, slots=True)
class WorkedExample:
    """`q` (dof,) made the `pose` (4, 4); `rows` (k, dof) are all its solutions, `names` (k) what the module
    tells them apart by, `inside` (k,) those inside the limits, `off` the largest entry (m, or of the
    rotation) by which a row's pose is another one in what the task reads of a whole pose, None for smaller
    tasks. Values of joints in rad and m."""

    q: Array
    pose: Array
    rows: Array
    names: tuple[str, ...]
    inside: NDArray[np.bool_]
    off: float | None


def worked_example(derivation: Derivation, runner: PythonModule) -> WorkedExample:
    """The configuration that the description proposes, or one with many solutions inside the limits."""
    dh = derivation.reading.dh
    given = derivation.reading.source.example
    q = np.array(given) if given else _chosen(dh, runner)
    pose = runner.forward(q[None])[0]
    held = held_values(dh, q, pose)
    rows, _, _ = runner.solve(pose, free=held, limits=False)
    inside, _, _ = runner.solve(pose, free=held, limits=True)
    rows = rows[np.lexsort(np.round(rows, 6).T[::-1])] if len(rows) else rows
    places = [_place(row, inside) for row in rows]
    rows = np.array([r if i is None else inside[i] for r, i in zip(rows, places, strict=True)])
    flags = np.array([i is not None for i in places], dtype=bool)
    off = float(np.abs(runner.forward(rows) - pose).max()) if derivation.task.whole_pose else None
    names = runner.branch_names(rows)
    return WorkedExample(q, pose, rows, names, flags, off if len(rows) else None)


def solver_of(derivation: Derivation) -> PythonModule | None:
    """The emitted Python module, with values of joints; None of a table whose lengths have no numbers."""
    if derivation.reading.dh.symbols:
        return None
    with ScratchFolder("ikgen-") as folder:
        path = folder / f"{derivation.module.name}_ik.py"
        path.write_text(emit_module(derivation.module.on_joints), encoding="utf-8")
        return PythonModule(path)


def _place(row: Array, rows: Array) -> int | None:
    """Which of the others a row is, whole turns aside."""
    apart = np.abs(np.exp(1j * rows) - np.exp(1j * row)).max(axis=1, initial=0.0)
    return int(apart.argmin()) if len(rows) and apart.min() < 1e-6 else None


def _drawn(dh: DHChain) -> Array:
    """Configurations inside the limits, always the same ones."""
    low, high = joint_box(dh, _WIDEST, _WIDEST)
    draws = np.random.default_rng(_SEED).uniform(0.12, 0.88, (_TRIED, dh.dof))
    return np.asarray(np.round(low + draws * (high - low), 3))


def shown_configuration(dh: DHChain) -> Array:
    """A configuration (dof,) to draw the arm at: above the floor and far from singular ones."""
    rows = _drawn(dh)
    return np.asarray(rows[int(np.argmax([_standing(dh, q) for q in rows]))])


def _standing(dh: DHChain, q: Array) -> float:
    arm = skeleton(dh, q)
    scales = np.array([1 / arm.size] * 3 + [1.0] * 3)[:, None]
    sigma = float(np.linalg.svd(file_jacobian(dh, q) * scales, compute_uv=False)[-1])
    below = float(min(arm.points[:, 2].min() / arm.size, 0.0))
    height = float(dh_forward(dh, q)[2, 3]) / arm.size
    return round(sigma + 3.0 * below + 0.3 * min(height, 0.5), 6)


def _chosen(dh: DHChain, runner: PythonModule) -> Array:
    """The configuration of the drawn ones whose pose has the most solutions inside the limits."""
    rows = _drawn(dh)
    poses = runner.forward(rows)
    counts = runner.solve_many(poses, free=held_values(dh, rows, poses)).count
    scores = [(int(n), _standing(dh, q)) for n, q in zip(counts, rows, strict=True)]
    return np.asarray(rows[scores.index(max(scores))])
